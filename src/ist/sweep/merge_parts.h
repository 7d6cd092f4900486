#pragma once

#include <cstdint>
#include <vector>

#include "ist/base/progress.h"
#include "ist/sweep/columns.h"
#include "ist/sweep/sweep_folder.h"

namespace ist {

struct MergeResult {
  std::uint64_t rows = 0;              ///< of the table
  std::vector<std::uint64_t> missing,  ///< parts that nobody has made yet
      given_up;                        ///< parts that are not tried again
  [[nodiscard]] bool whole() const noexcept { return missing.empty() && given_up.empty(); }
};

/// Merges the parts of a folder into rows.npy and rows.parquet, with the checksums of all parts and
/// of rows.npy in manifest.json: all three or none. Where a part lacks nothing is written.
///
/// @param proceed asked at each block of 64 KiB rows; false throws kCancelled, and leaves no file
///
/// Throws kInputInvalid for a part of another sweep, for one that is damaged, and for a folder that
/// the user may not write to; UnwritableFile.
/// Memory: 40 MB, 200 bytes a part, and for each 131072 rows 60 bytes a column.
MergeResult merge_parts(const SweepFolder& folder, const RowLayout& layout,
                        const Proceed& proceed = {});

}  // namespace ist
