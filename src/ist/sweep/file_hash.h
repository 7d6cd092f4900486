#pragma once

#include <filesystem>
#include <string>

#include "ist/base/files.h"

namespace ist {

/// Returns the XXH3-128 of a file's content, 32 hexadecimal digits. Throws kFileUnreadable. Has
/// cancellation points.
[[nodiscard]] std::string hash_of_file(const InputFile& file);
[[nodiscard]] std::string hash_of_file(const std::filesystem::path& file);

}  // namespace ist
