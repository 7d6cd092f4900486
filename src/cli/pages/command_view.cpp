#include <CLI/CLI.hpp>
#include <sstream>

#include "cli/pages/bash_completion.h"

namespace ist::cli {
namespace {

// Returns the words in TEXT:{lps,ras}; none if the type has no braces.
std::vector<std::string> choices_of(const std::string& type) {
  std::vector<std::string> choices;
  const std::size_t open = type.find('{');
  if (open == type.npos) return choices;
  std::istringstream stream(type.substr(open + 1, type.find('}', open) - open - 1));
  for (std::string each; std::getline(stream, each, ',');) choices.push_back(each);
  return choices;
}

OptionView option_view(const CLI::Option& option) {
  OptionView view;
  for (const std::string& name : option.get_snames()) view.spellings.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) view.spellings.push_back("--" + name);
  if (option.get_items_expected_max() == 0) return view;
  const std::string type = option.get_type_name();
  view.value = type.substr(0, type.find(':'));
  view.choices = choices_of(type);
  return view;
}

// Splits a footer into paragraphs of notes and examples. The first example stands behind
// "Example: " or "Examples: ", and each other one in an indented line.
void add_footer(const std::string& footer, CommandView& view) {
  std::istringstream stream(footer);
  bool begins = true;
  for (std::string line; std::getline(stream, line);) {
    const std::size_t example = line.find("ist ");
    const std::string before = line.substr(0, example);
    if (example != line.npos && (before == "Example: " || before == "Examples: " ||
                                 (!before.empty() && before.find_first_not_of(' ') == line.npos))) {
      view.examples.push_back(line.substr(example));
    } else if (line.empty()) {
      begins = true;
    } else {
      if (begins) view.notes.emplace_back();
      view.notes.back() += (begins ? "" : " ") + line;
      begins = false;
    }
  }
}

}  // namespace

CommandView command_view(const CLI::App& command) {
  CommandView view;
  view.name = command.get_name();
  for (const std::string& title : command.get_groups()) {
    for (const CLI::Option* option : command.get_options()) {
      if (option->get_group() != title) continue;
      if (option->get_positional()) {
        view.takes_files = true;
      } else {
        view.options.push_back(option_view(*option));
      }
    }
  }
  if (const CLI::App* parent = command.get_parent(); parent != nullptr) {
    const std::string footer = command.get_footer();
    add_footer(footer.substr(0, footer.size() - parent->get_footer().size()), view);
  }
  return view;
}

}  // namespace ist::cli
