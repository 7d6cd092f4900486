#pragma once

#include <cstdint>
#include <vector>

#include "ist/base/progress.h"
#include "sweep/row_layout.h"
#include "sweep/sweep_folder.h"

namespace ist {

struct MergeResult {
  std::uint64_t rows = 0;              ///< of the table
  std::vector<std::uint64_t> missing,  ///< parts that nobody has made yet
      given_up;                        ///< parts that are not tried again
  [[nodiscard]] bool whole() const noexcept { return missing.empty() && given_up.empty(); }
};

/// Merges the parts of a folder into rows.npy. Writes the checksums of all parts and of rows.npy
/// to manifest.json. Writes both files, or none. Writes nothing if a part is missing or given up.
///
/// @param proceed called after each 65536 rows. If it returns false, the merge throws kCancelled
///        and leaves no file
///
/// Throws kInputInvalid if a part is damaged or belongs to another sweep, and if the user may not
/// write to the folder; UnwritableFile.
/// Memory: 10 MB, and 200 bytes a part.
MergeResult merge_parts(const SweepFolder& folder, const RowLayout& layout,
                        const Proceed& proceed = {});

}  // namespace ist
