#pragma once

#include "answers/formats/csv_writer.h"
#include "answers/occlusion/bite.h"
#include "ist/base/files.h"

namespace ist::answers {

/// Writes a table. The column `kind` is total, band, side, tooth, pair, region or note. The file
/// begins with the byte order mark of UTF-8, so that Excel reads µ. Columns name
/// their units; docs/occlusion.md lists them. Throws kFileUnwritable.
void write_bite_csv(const Bite& bite, DecimalSign sign, OutputFile& file);

}  // namespace ist::answers
