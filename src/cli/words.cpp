#include "cli/words.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <limits>
#include <optional>
#include <string_view>

#include "cli/refusals.h"
#include "ist/scene/spelling.h"

namespace ist::cli {
namespace {

std::string with_nearest(const std::string& why, const std::string& word,
                         const std::vector<std::string>& known) {
  const std::string* nearest = nullptr;
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  for (const std::string& each : known) {
    const std::size_t changes = edits(word, each);
    if (!looks_like(word, each) || changes >= fewest) continue;
    fewest = changes;
    nearest = &each;
  }
  return nearest == nullptr ? why : why + "; did you mean " + *nearest + "?";
}

// The words of the version before.
std::string renamed(const std::string& word, const std::string& why) {
  if (word == "close") return "no such subcommand; it is called approach";
  if (word == "--gap") return "no such option; it is called --distance";
  return why;
}

std::vector<std::string> subcommands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* each : app.get_subcommands({})) names.push_back(each->get_name());
  return names;
}

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

}  // namespace

std::vector<std::string> words_of(int argc, char** argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words.empty()) return words;
  if (words.front() == "version") words.front() = "--version";
  if (words.front() != "help") return words;
  words.erase(words.begin());
  if (!words.empty() && (words.front() == "help" || words.front() == "version")) words.clear();
  words.resize(std::min<std::size_t>(words.size(), 1));
  words.emplace_back("--help");
  return words;
}

void refuse_wrong_words(const CLI::App& app, const std::vector<std::string>& words) {
  if (words.empty()) return;
  const std::vector<std::string> subcommands = subcommands_of(app);
  const std::string& first = words.front();
  const bool is_option = first.starts_with('-');
  if (!is_option && std::find(subcommands.begin(), subcommands.end(), first) == subcommands.end()) {
    throw CLI::ValidationError(
        first, renamed(first, with_nearest("no such subcommand", first, subcommands)));
  }
  const CLI::App& command = is_option ? app : *app.get_subcommand(first);
  const std::vector<std::string> options = options_of(command);
  for (const std::string& word : words) {
    if (word == "--") return;
    if (!word.starts_with("--")) continue;
    const std::string name = word.substr(0, word.find('='));
    if (std::find(options.begin(), options.end(), name) != options.end()) {
      if (name == word || command.get_option(name)->get_items_expected_max() > 0) continue;
      throw CLI::ValidationError(name, "takes no value; give it alone");
    }
    throw CLI::ValidationError(name, renamed(name, with_nearest("no such option", name, options)));
  }
}

std::string subcommand_among(const CLI::App& app, int argc, char** argv) {
  const std::vector<std::string> known = subcommands_of(app);
  if (argc < 2 || std::find(known.begin(), known.end(), argv[1]) == known.end()) return {};
  return std::string(argv[1]) + " ";
}

}  // namespace ist::cli
