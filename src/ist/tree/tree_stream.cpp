#include "ist/tree/tree_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "ist/base/cancellation.h"
#include "ist/base/throw_error.h"
#include "ist/tree/sphere_tree.h"

namespace ist {
namespace {

static_assert(std::endian::native == std::endian::little,
              "arrays are written in their memory layout");

constexpr std::uint32_t kByteOrder = 0x01020304;

struct Preamble {
  std::array<unsigned char, 8> magic = kTreeFileMagic;
  std::uint32_t version = kTreeFileVersion;
  std::uint32_t byte_order = kByteOrder;
  std::uint64_t bytes = 0;
  std::uint64_t checksum = 0;
};
static_assert(sizeof(Preamble) == 32 && std::is_trivially_copyable_v<Preamble>);

}  // namespace

TreeWriter::TreeWriter(const std::filesystem::path& file) : file_(file) {
  const Preamble later;
  store(&later, sizeof(later));
}

TreeWriter::TreeWriter(std::vector<std::byte>& memory) : memory_(&memory) {
  memory.clear();
  const Preamble later;
  store(&later, sizeof(later));
}

void TreeWriter::store(const void* data, std::size_t count) {
  if (file_) return file_->write(data, count);
  cancellation_point();
  const auto* begin = static_cast<const std::byte*>(data);
  memory_->insert(memory_->end(), begin, begin + count);
}

void TreeWriter::bytes(const void* data, std::size_t count) {
  store(data, count);
  checksum_.add(data, count);
  bytes_ += count;
}

std::uint64_t TreeWriter::commit() {
  Preamble preamble;
  preamble.bytes = sizeof(preamble) + bytes_;
  preamble.checksum = checksum_.value();
  if (file_) {
    file_->write_at(0, &preamble, sizeof(preamble));
    file_->commit();
  } else {
    std::memcpy(memory_->data(), &preamble, sizeof(preamble));
  }
  return preamble.bytes;
}

TreeReader::TreeReader(const std::filesystem::path& file)
    : file_(std::in_place, file), name_(file.string()), size_(file_->size()), left_(size_) {
  read_preamble();
}

TreeReader::TreeReader(std::span<const std::byte> memory, std::string name)
    : memory_(memory), name_(std::move(name)), size_(memory.size()), left_(size_) {
  read_preamble();
}

std::size_t TreeReader::take(void* data, std::size_t count) {
  if (file_) return file_->read(data, count);
  cancellation_point();
  count = std::min(count, memory_.size());
  if (count > 0) std::memcpy(data, memory_.data(), count);
  memory_ = memory_.subspan(count);
  return count;
}

void TreeReader::read_preamble() {
  Preamble preamble;
  const std::size_t got = take(&preamble, sizeof(preamble));
  if (got < sizeof(kTreeFileMagic) || preamble.magic != kTreeFileMagic) {
    fail(ErrorCode::kNotATree, "it is not a tree file: make one with ist build");
  }
  if (got < sizeof(preamble)) truncated();
  if (preamble.byte_order != kByteOrder) {
    fail(ErrorCode::kNotATree,
         "it was written in another byte order: build it again on this machine");
  }
  if (preamble.version != kTreeFileVersion) {
    fail(ErrorCode::kTreeVersion,
         fmt::format("it is of version {}, and this program reads version {}: build it again from "
                     "the mesh",
                     preamble.version, kTreeFileVersion));
  }
  if (preamble.bytes != size_) {
    fail(ErrorCode::kTreeTruncated,
         fmt::format("it has {} bytes and should have {}: copy or build it again", size_,
                     preamble.bytes));
  }
  expected_ = preamble.checksum;
  left_ -= sizeof(preamble);
}

void TreeReader::verify_checksum() const {
  if (left_ != 0) corrupt("it has more bytes than its sections");
  if (checksum_.value() != expected_) corrupt("its checksum does not match its content");
}

void TreeReader::bytes(void* data, std::uint64_t count) {
  if (count > left_ || take(data, count) != count) truncated();
  checksum_.add(data, count);
  left_ -= count;
}

void TreeReader::truncated() const {
  fail(ErrorCode::kTreeTruncated, "it ends before its content does: copy or build it again");
}

void TreeReader::corrupt(const char* what) const {
  fail(ErrorCode::kTreeCorrupt, fmt::format("{}: build it again", what));
}

void TreeReader::fail(ErrorCode code, const std::string& what) const {
  throw_error(code, "{}: {}", name_, what);
}

}  // namespace ist
