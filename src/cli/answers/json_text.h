#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

namespace ist::cli {

/// Returns JSON as text: on one line, or indented. A name of a file may have bytes that are not
/// UTF-8; U+FFFD replaces each of them.
inline std::string json_text(const nlohmann::ordered_json& json, int indent = -1) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// Prints JSON as a line of stdout.
inline void print_json(const nlohmann::ordered_json& line) { fmt::print("{}\n", json_text(line)); }

}  // namespace ist::cli
