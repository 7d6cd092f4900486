#pragma once

#include <string>

namespace ist::answers {

/// Returns "ist 1.2.3, commit 01234567".
[[nodiscard]] std::string version_words();

/// Returns name and version, commit, compiler, instruction sets of this processor, and the version
/// of tree files: a line each.
[[nodiscard]] std::string version_lines();

}  // namespace ist::answers
