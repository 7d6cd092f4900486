#pragma once

#include <nlohmann/json_fwd.hpp>

#include "answers/formats/csv_writer.h"
#include "answers/occlusion/bite.h"
#include "ist/base/files.h"

namespace ist::answers {

/// Returns a bite as one object of schema 1, without the distances of single vertices. An unknown
/// value is null. docs/occlusion.md lists the keys.
[[nodiscard]] nlohmann::ordered_json json_of(const Bite& bite);

/// Writes that object, indented. Throws kFileUnwritable.
void write_bite_json(const Bite& bite, OutputFile& file);

/// Writes a table. The column `kind` is total, band, side, tooth, pair, region or note. The file
/// begins with the byte order mark of UTF-8, so that Excel reads µ. Columns name
/// their units; docs/occlusion.md lists them. Throws kFileUnwritable.
void write_bite_csv(const Bite& bite, DecimalSign sign, OutputFile& file);

}  // namespace ist::answers
