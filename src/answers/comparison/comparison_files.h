#pragma once

#include <nlohmann/json_fwd.hpp>

#include "answers/comparison/bite_comparison.h"
#include "answers/formats/csv_writer.h"
#include "ist/base/files.h"

namespace ist::answers {

/// Returns a comparison as one object of schema 1: lengths in mesh units, angles in degrees. An
/// unknown value is null. docs/compare.md lists the keys.
[[nodiscard]] nlohmann::ordered_json json_of(const BiteComparison& comparison);

/// Writes that object, indented. Throws kFileUnwritable.
void write_comparison_json(const BiteComparison& comparison, OutputFile& file);

/// Writes a table in millimetres and micrometres, with the byte order mark of UTF-8. The column
/// `kind` is motion, total, band, side, tooth, contact or note. docs/compare.md lists the columns.
/// Throws kFileUnwritable.
void write_comparison_csv(const BiteComparison& comparison, DecimalSign sign, OutputFile& file);

}  // namespace ist::answers
