#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

namespace ist {

/// The edit distance of two words: the least number of letters to insert, delete, change or swap
/// with the next one. Cost: the product of their lengths. Source: F. J. Damerau, A technique for
/// computer detection and correction of spelling errors, Comm. ACM 7(3), 1964.
[[nodiscard]] inline std::size_t edits(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<std::size_t> cost((a.size() + 1) * width);
  const auto at = [&](std::size_t i, std::size_t j) -> std::size_t& { return cost[i * width + j]; };
  for (std::size_t i = 0; i <= a.size(); ++i) at(i, 0) = i;
  for (std::size_t j = 0; j <= b.size(); ++j) at(0, j) = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = at(i - 1, j - 1) + (a[i - 1] == b[j - 1] ? 0 : 1);
      at(i, j) = std::min({changed, at(i - 1, j) + 1, at(i, j - 1) + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
      }
    }
  }
  return cost.back();
}

/// Whether a word may be a misspelling of a known one: one edit, or up to a third of its letters.
[[nodiscard]] inline bool looks_like(std::string_view word, std::string_view known) {
  const std::size_t most = known.size() < 6 ? 1 : known.size() / 3;
  return edits(word, known) <= most;
}

}  // namespace ist
