#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace ist {

/// An entry of a zip archive, as the directory at the archive's end describes it: any numbers.
struct ZipEntry {
  std::uint64_t flags = 0, method = 0, checksum = 0;
  std::uint64_t packed = 0, unpacked = 0;  ///< sizes, bytes
  std::uint64_t offset = 0;                ///< of the entry in the archive, bytes
};

/// Returns the entry with a name, in any case; nothing where the archive does not hold it. Sizes
/// and offsets of 64 bits (ZIP64) are read too: some programs write them for any size. `file` is
/// named in errors. Errors: kMeshTruncated without a directory; kNotAMesh.
[[nodiscard]] std::optional<ZipEntry> find_zip_entry(std::string_view archive,
                                                     std::string_view name, std::string_view file);

/// Returns the number in some bytes of a record. Precondition: they lie within it.
[[nodiscard]] std::uint64_t zip_number(std::string_view record, std::size_t at, std::size_t bytes);

}  // namespace ist
