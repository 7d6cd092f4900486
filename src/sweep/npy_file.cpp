#include "sweep/npy_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string_view>

#include "ist/base/checksum.h"
#include "ist/base/throw_error.h"

namespace ist {
namespace {

constexpr std::string_view kMagic("\x93NUMPY", 6);
constexpr std::size_t kMostHeader = 1 << 16;  // bytes
constexpr std::size_t kAlignment = 64;

const char* npy_type(ColumnType type) {
  switch (type) {
    case ColumnType::kUint64:
      return "<u8";
    case ColumnType::kInt32:
      return "<i4";
    default:
      return "<f8";
  }
}

[[noreturn]] void fail(const InputFile& file, std::string_view wrong, std::string_view remedy) {
  throw_error(ErrorCode::kInputInvalid, "{}: {}: {}", file.path().string(), wrong, remedy);
}

constexpr std::string_view kSave = "write it by numpy.save()";

// The text after `key` and a colon, without the spaces before it; empty where the key is missing.
std::string_view after(std::string_view header, std::string_view key) {
  const std::size_t at = header.find(key);
  if (at == std::string_view::npos) return {};
  std::string_view rest = header.substr(at + key.size());
  const std::size_t colon = rest.find_first_not_of(' ');
  if (colon == std::string_view::npos || rest[colon] != ':') return {};
  rest.remove_prefix(colon + 1);
  const std::size_t value = rest.find_first_not_of(' ');
  return value == std::string_view::npos ? std::string_view() : rest.substr(value);
}

// Reads "(2, 3)" or "(2,)".
std::optional<std::vector<std::uint64_t>> shape_of(std::string_view text) {
  if (text.empty() || text.front() != '(') return std::nullopt;
  const std::size_t end = text.find(')');
  if (end == std::string_view::npos) return std::nullopt;
  text = text.substr(1, end - 1);
  std::vector<std::uint64_t> shape;
  while (true) {
    const std::size_t begin = text.find_first_not_of(", ");
    if (begin == std::string_view::npos) return shape;
    text.remove_prefix(begin);
    std::uint64_t length = 0;
    const auto [next, error] = std::from_chars(text.data(), text.data() + text.size(), length);
    if (error != std::errc()) return std::nullopt;
    shape.push_back(length);
    text.remove_prefix(static_cast<std::size_t>(next - text.data()));
  }
}

}  // namespace

NpyPoses::NpyPoses(const std::filesystem::path& file)
    : file_(file), written_at_(file_.written_at()), hash_(hash_of_file(file_)) {
  const NpyDoubles array = read_npy_header(file_);
  if (array.shape.size() != 3 || array.shape[1] != 4 || array.shape[2] != 4) {
    throw_error(ErrorCode::kInputInvalid, "{}: its shape is ({}): write poses of shape (N, 4, 4)",
                file.string(), fmt::format("{}", fmt::join(array.shape, ", ")));
  }
  count_ = array.shape[0];
  offset_ = array.offset;
}

void NpyPoses::read(std::uint64_t first, std::span<Eigen::Isometry3d> poses) const {
  using Numbers = std::array<double, 16>;
  constexpr std::size_t kAtOnce = 1024;  // poses
  std::vector<Numbers> block(std::min(kAtOnce, poses.size()));
  for (std::size_t done = 0; done < poses.size(); done += block.size()) {
    block.resize(std::min(kAtOnce, poses.size() - done));
    file_.read_at(offset_ + (first + done) * sizeof(Numbers), block.data(),
                  block.size() * sizeof(Numbers));
    for (std::size_t i = 0; i < block.size(); ++i) {
      for (int entry = 0; entry < 16; ++entry) {
        poses[done + i].matrix()(entry / 4, entry % 4) = block[i][static_cast<std::size_t>(entry)];
      }
    }
  }
}

std::string NpyPoses::identity() const { return fmt::format("file {} count {}", hash_, count_); }

void NpyPoses::require_unchanged() const {
  if (file_.written_at() == written_at_) return;
  throw_error(ErrorCode::kInputInvalid,
              "{}: the file was written since the sweep was "
              "opened: begin anew, with a folder of its own",
              file_.path().string());
}

std::string npy_header(const RowLayout& layout, std::uint64_t rows) {
  std::string types;
  for (const Column& column : layout.columns) {
    types += fmt::format("{}('{}', '{}')", types.empty() ? "" : ", ", column.name,
                         npy_type(column.type));
  }
  std::string text =
      fmt::format("{{'descr': [{}], 'fortran_order': False, 'shape': ({},), }}", types, rows);
  const std::size_t before = kMagic.size() + 4;  // the version, and the length of the text
  const std::size_t bytes = (before + text.size() + kAlignment) / kAlignment * kAlignment - before;
  text.resize(bytes - 1, ' ');
  text += '\n';
  std::string header(kMagic);
  header += {'\x01', '\x00', static_cast<char>(bytes & 0xFF), static_cast<char>(bytes >> 8)};
  return header + text;
}

NpyDoubles read_npy_header(InputFile& file) {
  std::array<unsigned char, 12> begin{};
  const std::size_t got = file.read(begin.data(), 10);
  if (got < 10 || std::string_view(reinterpret_cast<const char*>(begin.data()), 6) != kMagic) {
    fail(file, "it is no .npy file", kSave);
  }
  std::size_t bytes = begin[8] + 256u * begin[9], offset = 10;
  if (begin[6] != 1) {  // versions 2 and 3 have two more bytes of length
    if (file.read(begin.data() + 10, 2) < 2) fail(file, "its header is cut off", kSave);
    bytes += 65536u * begin[10] + 16777216u * begin[11];
    offset = 12;
  }
  if (bytes > kMostHeader) fail(file, "its header is too long", kSave);
  std::string header(bytes, ' ');
  if (file.read(header.data(), bytes) < bytes) fail(file, "its header is cut off", kSave);
  const std::string_view type = after(header, "'descr'"), order = after(header, "'fortran_order'");
  if (!type.starts_with("'<f8'")) {
    fail(file, fmt::format("its numbers have the type {}", type.substr(0, type.find(','))),
         "write float64 of little-endian order: array.astype('<f8')");
  }
  if (!order.starts_with("False")) {
    fail(file, "its numbers are in Fortran's order", "write numpy.ascontiguousarray(array)");
  }
  const auto shape = shape_of(after(header, "'shape'"));
  if (!shape) fail(file, "its header has no shape", kSave);
  NpyDoubles array{*shape, offset + bytes};
  std::uint64_t numbers = 1;
  bool fits = true;
  for (const std::uint64_t length : array.shape) {
    fits = fits && !__builtin_mul_overflow(numbers, length, &numbers);
  }
  if (!fits || file.size() < array.offset || (file.size() - array.offset) / 8 != numbers ||
      (file.size() - array.offset) % 8 != 0) {
    fail(file, fmt::format("it has {} bytes, which are not those of its shape", file.size()),
         "it is cut off or damaged: write it anew");
  }
  return array;
}

}  // namespace ist
