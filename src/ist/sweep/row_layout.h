#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "ist/measure/pose_rows.h"
#include "ist/measure/row_numbers.h"
#include "ist/sweep/columns.h"

namespace ist {

/// Returns the columns of the answers to these questions: `index`, `status`, `complete`, then those
/// of each question.
[[nodiscard]] RowLayout layout_of(const RowQuestions& questions);

/// Writes a row of that layout.
void write_row(const RowQuestions& questions, std::uint64_t index, const RowNumbers& numbers,
               std::span<std::byte> row);

}  // namespace ist
