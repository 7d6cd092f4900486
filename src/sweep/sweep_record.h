#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sweep/row_layout.h"
#include "sweep/sweep_folder.h"

/// The JSON files of a sweep's folder.
namespace ist {

/// A part's record, which stands beside it.
struct PartRecord {
  std::string sweep;  ///< the sweep's hash
  std::uint64_t part = 0, rows = 0;
  std::string checksum;  ///< XXH3-128 of the part's file
  double seconds = 0;    ///< that making it took
};

[[nodiscard]] std::string json_of(const PartRecord& record);

/// Reads a part's record. Throws kFileUnreadable; kInputInvalid for another content.
[[nodiscard]] PartRecord read_part_record(const std::filesystem::path& file);

/// Returns the content of sweep.json: the sweep's hash, the version of this library and of the
/// columns, the rows and the columns.
[[nodiscard]] std::string json_of(const SweepIdentity& identity, const RowLayout& layout);

/// Throws kInputInvalid if a folder's sweep.json belongs to another sweep, another version or
/// another layout of rows.
void require_same_sweep(const std::filesystem::path& file, const SweepIdentity& identity);

/// Returns the content of manifest.json: the content of sweep.json, and the checksums of rows.npy
/// and of all parts in order.
[[nodiscard]] std::string manifest_of(const SweepIdentity& identity, const RowLayout& layout,
                                      const std::vector<std::string>& parts,
                                      const std::string& npy);

/// Returns the checksum of rows.npy in the text of a manifest.json, or an empty text if the text is
/// no manifest.
[[nodiscard]] std::string table_checksum_in(const std::string& manifest);

}  // namespace ist
