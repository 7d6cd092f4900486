#include "cli/pages/command_view.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>
#include <string_view>

namespace ist::cli {
namespace {

// The text between two words, such as the choices in TEXT:{lps,ras}; empty where they are not.
std::string between(const std::string& text, std::string_view open, std::string_view close) {
  const std::size_t begin = text.find(open);
  if (begin == text.npos) return {};
  const std::size_t end = text.find(close, begin);
  return text.substr(begin + open.size(), end - begin - open.size());
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

// CLI11 names C++ types: FLOAT:FLOAT in [1 - 10].
std::string value_name(const std::string& type) {
  std::string name = type.substr(0, type.find(':'));
  if (name == "FLOAT" || name == "INT" || name == "UINT") return "number";
  std::transform(name.begin(), name.end(), name.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return name;
}

OptionView option_view(const CLI::Option& option) {
  OptionView view;
  view.is_argument = option.get_positional();
  if (view.is_argument) view.spellings = {option.get_name()};
  for (const std::string& name : option.get_snames()) view.spellings.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) view.spellings.push_back("--" + name);
  view.description = option.get_description();
  view.required = option.get_required();
  for (const CLI::Option* other : option.get_excludes()) {
    view.excluded.push_back(other->get_name());
  }
  std::sort(view.excluded.begin(), view.excluded.end());  // CLI11 keeps them by address
  if (option.get_items_expected_max() == 0) return view;
  const std::string type = option.get_type_name();
  view.value = value_name(type);
  view.choices = split(between(type, "{", "}"));
  view.range = between(type, " in [", "]");
  if (const std::size_t dash = view.range.find(" - "); dash != view.range.npos) {
    view.range.replace(dash, 3, " to ");
  }
  const std::string words = option.get_default_str();  // of a list [simd]
  view.default_value = words.starts_with('[') ? between(words, "[", "]") : words;
  return view;
}

// A footer is lines of notes, paragraphs apart, and "Examples: ist …" with more of them indented.
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
  view.description = command.get_description();
  for (const std::string& title : command.get_groups()) {
    OptionGroup group{title, {}};
    for (const CLI::Option* option : command.get_options()) {
      if (option->get_group() != title) continue;
      OptionView each = option_view(*option);
      (each.is_argument ? view.arguments : group.options).push_back(std::move(each));
    }
    view.groups.push_back(std::move(group));
  }
  if (const CLI::App* parent = command.get_parent(); parent != nullptr) {
    const std::string footer = command.get_footer();
    add_footer(footer.substr(0, footer.size() - parent->get_footer().size()), view);
  }
  return view;
}

}  // namespace ist::cli
