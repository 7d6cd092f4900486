#pragma once

#include <cstddef>
#include <string_view>

namespace ist {

/// The edit distance of two words: the least number of letters to insert, delete, change or swap
/// with the next one. Cost: the product of their lengths. Source: F. J. Damerau, A technique for
/// computer detection and correction of spelling errors, Comm. ACM 7(3), 1964.
[[nodiscard]] std::size_t edits(std::string_view a, std::string_view b);

/// Whether a word may be a misspelling of a known one: one edit, or up to a third of its letters.
[[nodiscard]] inline bool looks_like(std::string_view word, std::string_view known) {
  const std::size_t most = known.size() < 6 ? 1 : known.size() / 3;
  return edits(word, known) <= most;
}

}  // namespace ist
