#include "cli/terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <system_error>

namespace ist::cli {

using namespace answers;

namespace {

bool has_colours() {
  const char* refused = std::getenv("NO_COLOR");
  const char* kind = std::getenv("TERM");
  return isatty(STDOUT_FILENO) != 0 && (refused == nullptr || *refused == '\0') &&
         (kind == nullptr || std::string_view(kind) != "dumb");
}

std::string& stored_command_word() {
  static std::string word = "ist";
  return word;
}

NamedSources read(const NamedFiles& files) {
  NamedSources sources;
  for (const auto& [name, file] : files) sources.emplace_back(name, source_of(file));
  return sources;
}

}  // namespace

std::string painted(std::string_view text, TextColour colour) {
  static const bool colours = has_colours();
  if (!colours) return std::string(text);
  const char* code = colour == TextColour::kRed ? "31" : colour == TextColour::kYellow ? "33" : "1";
  return fmt::format("\033[{}m{}\033[0m", code, text);
}

std::string quoted(const std::string& text) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

void set_command_word(const char* started) { stored_command_word() = quoted(started); }

const std::string& command_word() { return stored_command_word(); }

void print_json(const nlohmann::ordered_json& line) { fmt::print("{}\n", json_text(line)); }

void print_header(const std::string& subcommand, const NamedFiles& files) {
  print_json(header_line(subcommand, read(files)));
}

void print_header(const std::string& subcommand, const NamedFiles& files, const Bodies& bodies,
                  const std::optional<TakenUnit>& unit) {
  print_json(header_line(subcommand, read(files), bodies, unit));
}

void flush_stdout() {
  if (std::fflush(stdout) != 0) fail_stdout();
}

void fail_stdout() {
  throw std::system_error(errno, std::generic_category(), "cannot write to stdout");
}

}  // namespace ist::cli
