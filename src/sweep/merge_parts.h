#pragma once

#include <cstdint>
#include <vector>

#include "ist/base/progress.h"
#include "sweep/row_layout.h"
#include "sweep/sweep_folder.h"

namespace ist {

enum class MergeOutcome : std::uint8_t {
  kIncomplete,  ///< a part is missing or given up
  kMerged,      ///< by this call
  kWasThere,    ///< the table was whole already
  kBusy,        ///< another process is merging
};

struct MergeResult {
  MergeOutcome outcome = MergeOutcome::kIncomplete;
  std::uint64_t rows = 0;              ///< of the table that is there now, 0 if none
  std::vector<std::uint64_t> missing,  ///< parts that nobody has made yet
      given_up;                        ///< parts that are not tried again
};

/// How a merge finds that the table is whole already.
enum class TableCheck : std::uint8_t {
  kSize,      ///< by its manifest and its size
  kChecksum,  ///< by its checksum too: reads the table
};

/// Merges the parts of a folder into rows.npy. Writes the checksums of all parts and of rows.npy
/// to manifest.json. Writes both files, or none. Writes nothing if a part is missing or given up,
/// if the table is whole already, and if another process is merging.
///
/// @param proceed called after each 65536 rows. If it returns false, the merge throws kCancelled
///        and leaves no file
///
/// Throws kInputInvalid if a part is damaged or belongs to another sweep, and if the user may not
/// write to the folder; UnwritableFile.
/// Memory: 10 MB, and 400 bytes a part.
MergeResult merge_parts(const SweepFolder& folder, const RowLayout& layout, TableCheck check,
                        const Proceed& proceed = {});

/// Throws kPartBusy: another process is merging the parts.
[[noreturn]] void fail_merging(const SweepFolder& folder);

}  // namespace ist
