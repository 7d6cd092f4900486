#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "answers/json_parts.h"

namespace ist::cli {

enum class TextColour { kRed, kYellow, kBold };

/// Returns a text in a colour if stdout is a terminal and NO_COLOR of the environment is not set
/// (no-color.org), else the text alone.
[[nodiscard]] std::string painted(std::string_view text, TextColour colour);

/// Returns a text as a shell reads it, quoted if necessary.
[[nodiscard]] std::string quoted(const std::string& text);

/// Sets the word by which the user started the command, argv[0].
void set_command_word(const char* started);
/// Returns this word as a shell reads it, for lines that the user may copy; `ist` if it is not set.
[[nodiscard]] const std::string& command_word();

/// Prints JSON as a line of stdout.
void print_json(const nlohmann::ordered_json& line);

/// The files that a command reads, by their roles: `fixed`, `mesh`, `tree` and so on.
using NamedFiles = std::vector<std::pair<std::string, std::filesystem::path>>;

/// Prints header_line(). Reads the files for their hashes.
void print_header(const std::string& subcommand, const NamedFiles& files);
void print_header(const std::string& subcommand, const NamedFiles& files,
                  const answers::Bodies& bodies,
                  const std::optional<answers::TakenUnit>& unit = {});

/// Flushes stdout. Throws std::system_error if that fails.
void flush_stdout();

/// Throws std::system_error of the write to stdout that just failed.
[[noreturn]] void fail_stdout();

}  // namespace ist::cli
