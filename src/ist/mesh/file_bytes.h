#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace ist {

/// The whole content of a regular file. Errors: kFileUnreadable.
[[nodiscard]] std::string read_file(const std::filesystem::path& file);

/// Puts a file in place whole or not at all: writes it under another name in the same folder, then
/// renames it over any file of that name. Leaves nothing behind on failure.
/// Errors: kFileUnwritable.
void write_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace ist
