#include "ist/mesh/format/threemf/zip_directory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "ist/base/printable.h"
#include "ist/mesh/format/text_reader.h"

namespace ist {
namespace {

// Sizes of the archive's records without their names, and the places in them, are those of
// PKWARE's APPNOTE.TXT.
constexpr std::size_t kEnd = 22, kEntry = 46, kLocator = 20, kWideEnd = 56;
constexpr std::uint64_t kIsWide = 0xFFFFFFFF;  // the number itself stands elsewhere, in 64 bits

// Returns where the directory begins, told by the record at `end` or by a wide one before it.
std::optional<std::uint64_t> directory_begin(std::string_view archive, std::size_t end) {
  const std::uint64_t begin = zip_number(archive, end + 16, 4);
  if (begin != kIsWide) return begin;
  if (end < kLocator) return {};
  const std::size_t locator = end - kLocator;
  if (archive.substr(locator, 4) != "PK\6\7") return {};
  const std::uint64_t wide = zip_number(archive, locator + 8, 8);
  if (wide > locator || locator - wide < kWideEnd || archive.substr(wide, 4) != "PK\6\6") return {};
  return zip_number(archive, wide + 48, 8);
}

// Takes the numbers that do not stand in the entry itself from its extra field for them, which
// holds those alone. Returns false where one is missing.
bool read_wide_numbers(ZipEntry& entry, std::string_view extra) {
  constexpr std::uint64_t kWideNumbers = 1;
  std::string_view numbers;
  while (extra.size() >= 4 && numbers.empty()) {
    const std::size_t size = zip_number(extra, 2, 2);
    if (zip_number(extra, 0, 2) == kWideNumbers) numbers = extra.substr(4, size);
    extra.remove_prefix(std::min(4 + size, extra.size()));
  }
  for (std::uint64_t* number : {&entry.unpacked, &entry.packed, &entry.offset}) {
    if (*number != kIsWide) continue;
    if (numbers.size() < 8) return false;
    *number = zip_number(numbers, 0, 8);
    numbers.remove_prefix(8);
  }
  return true;
}

}  // namespace

std::uint64_t zip_number(std::string_view record, std::size_t at, std::size_t bytes) {
  std::uint64_t value = 0;
  std::memcpy(&value, record.data() + at, bytes);
  return value;
}

std::optional<ZipEntry> find_zip_entry(std::string_view archive, std::string_view name,
                                       std::string_view file) {
  const std::size_t end = archive.rfind("PK\5\6");
  std::optional<std::uint64_t> begin;
  if (end != archive.npos && archive.size() - end >= kEnd) begin = directory_begin(archive, end);
  if (!begin)
    fail_mesh(ErrorCode::kMeshTruncated, file, fmt::format("byte {}", archive.size()),
              "the directory at the end of the archive is missing; copy or export it again");
  std::uint64_t at = *begin;
  while (at < end && end - at >= kEntry && archive.substr(at, 4) == "PK\1\2") {
    const std::string_view record = archive.substr(at, end - at);
    const std::size_t length = zip_number(record, 28, 2), extra = zip_number(record, 30, 2);
    if (same_word(record.substr(kEntry, length), name)) {
      ZipEntry entry{zip_number(record, 8, 2),  zip_number(record, 10, 2),
                     zip_number(record, 16, 4), zip_number(record, 20, 4),
                     zip_number(record, 24, 4), zip_number(record, 42, 4)};
      const std::size_t behind = std::min(kEntry + length, record.size());
      if (!read_wide_numbers(entry, record.substr(behind, extra)))
        fail_mesh(ErrorCode::kNotAMesh, file, printable(name),
                  "its size in 64 bits is missing; copy or export it again");
      return entry;
    }
    at += kEntry + length + extra + zip_number(record, 32, 2);
  }
  return {};
}

}  // namespace ist
