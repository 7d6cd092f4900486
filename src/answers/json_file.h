#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace ist::answers {

/// Reads a file of JSON. Throws kFileUnreadable, and kInputInvalid with the file, the line of the
/// first error, and `remedy`, which says what to give.
[[nodiscard]] nlohmann::ordered_json read_json(const std::filesystem::path& file,
                                               const std::string& remedy);

}  // namespace ist::answers
