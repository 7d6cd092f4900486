#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace ist::test {

/// A target does with any bytes what a user could, and checks what is guaranteed of any input. It
/// returns what they came to, in a word: the name of the ist::Error, or what was found. All that it
/// throws is a finding.
///
/// Each stands in a file TARGET_target.cpp, which says how it reads the bytes.
[[nodiscard]] std::string fuzz_import(std::string_view bytes);
[[nodiscard]] std::string fuzz_labels(std::string_view bytes);
[[nodiscard]] std::string fuzz_mesh(std::string_view bytes);
[[nodiscard]] std::string fuzz_poses(std::string_view bytes);
[[nodiscard]] std::string fuzz_query(std::string_view bytes);
[[nodiscard]] std::string fuzz_scene(std::string_view bytes);
[[nodiscard]] std::string fuzz_tree(std::string_view bytes);
[[nodiscard]] std::string fuzz_vectors(std::string_view bytes);

/// A guarantee that does not hold.
class Finding : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

inline void require(bool holds, const char* otherwise) {
  if (!holds) throw Finding(otherwise);
}

}  // namespace ist::test
