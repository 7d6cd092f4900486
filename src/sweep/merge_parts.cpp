#include "sweep/merge_parts.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <span>
#include <string>

#include "ist/base/checksum.h"
#include "ist/base/error.h"
#include "ist/base/files.h"
#include "sweep/npy_file.h"
#include "sweep/sweep_record.h"

namespace ist {
namespace {

constexpr std::uint64_t kMergedAtOnce = 1 << 16;

// Writes rows.npy and its checksum.
class Table {
 public:
  Table(const SweepFolder& folder, const RowLayout& layout) : npy_(folder.path() / "rows.npy") {
    const std::string header = npy_header(layout, folder.identity().rows);
    add(std::as_bytes(std::span(header)));
  }

  void add(std::span<const std::byte> bytes) {
    npy_.write(bytes.data(), bytes.size());
    hash_.add(bytes.data(), bytes.size());
  }

  // Writes the manifest, and gives both files their names.
  void commit(const SweepFolder& folder, const RowLayout& layout,
              const std::vector<std::string>& checksums) {
    OutputFile manifest(folder.path() / "manifest.json");
    const std::string text = manifest_of(folder.identity(), layout, checksums, hash_.text());
    manifest.write(text.data(), text.size());
    const std::array<OutputFile*, 2> files = {&npy_, &manifest};
    OutputFile::commit_all(files);
  }

 private:
  OutputFile npy_;
  Checksum hash_;
};

// Reads the rows of a part into the table. Compares the part's header, row numbers and checksum.
void merge_part(const SweepFolder& folder, const RowLayout& layout, std::uint64_t part,
                const std::string& checksum, Table& table,
                const std::function<void(std::uint64_t rows)>& proceed) {
  const std::uint64_t rows = folder.identity().rows_of(part);
  const std::string header = npy_header(layout, rows);
  InputFile file(folder.part_file(part));
  Checksum hash;
  std::string begin(header.size(), ' ');
  if (file.read(begin.data(), begin.size()) < begin.size() || begin != header) {
    fail_damaged(folder, part);
  }
  hash.add(begin.data(), begin.size());
  std::vector<std::byte> block;
  std::uint64_t index = part * folder.identity().rows_per_part;
  for (std::uint64_t done = 0; done < rows;) {
    const std::uint64_t count = std::min(kMergedAtOnce, rows - done);
    block.resize(count * layout.bytes);
    if (file.read(block.data(), block.size()) < block.size()) fail_damaged(folder, part);
    hash.add(block.data(), block.size());
    for (std::size_t row = 0; row < count; ++row, ++index) {
      if (std::memcmp(block.data() + row * layout.bytes, &index, sizeof(index)) != 0) {
        fail_damaged(folder, part);
      }
    }
    table.add(block);
    done += count;
    proceed(part * folder.identity().rows_per_part + done);
  }
  if (hash.text() != checksum) fail_damaged(folder, part);
}

}  // namespace

MergeResult merge_parts(const SweepFolder& folder, const RowLayout& layout,
                        const Proceed& proceed) {
  MergeResult result;
  std::vector<std::string> checksums;
  const std::uint64_t parts = folder.identity().parts(), all = folder.identity().rows;
  for (std::uint64_t part = 0; part < parts; ++part) {
    const PartStatus status = folder.look(part);
    if (status.state == PartState::kMissing) result.missing.push_back(part);
    if (status.state == PartState::kGivenUp) result.given_up.push_back(part);
    if (status.state == PartState::kDamaged) fail_damaged(folder, part);
    checksums.push_back(status.checksum);
  }
  if (!result.whole()) return result;
  folder.require_writable();
  const auto go_on = [&](std::uint64_t rows) {
    if (!proceed || proceed(static_cast<double>(rows) / static_cast<double>(all))) return;
    throw Error(ErrorCode::kCancelled, "the merge was ended by its caller");
  };
  Table table(folder, layout);
  for (std::uint64_t part = 0; part < parts; ++part) {
    merge_part(folder, layout, part, checksums[part], table, go_on);
  }
  table.commit(folder, layout, checksums);
  result.rows = all;
  return result;
}

}  // namespace ist
