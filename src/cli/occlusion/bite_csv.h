#pragma once

#include "cli/formats/csv_writer.h"
#include "cli/occlusion/bite.h"
#include "ist/base/files.h"

namespace ist::cli {

/// Writes a table. The column `kind` tells what a row is of: total, band, side, tooth, pair, region
/// or note. The file begins with the byte order mark of UTF-8, by which Excel reads µ. Columns name
/// their units; docs/occlusion.md lists them. Throws kFileUnwritable.
void write_bite_csv(const Bite& bite, DecimalSign sign, OutputFile& file);

}  // namespace ist::cli
