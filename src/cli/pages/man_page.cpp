#include "cli/pages/man_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/app.h"
#include "cli/exit_code.h"
#include "cli/pages/roff.h"

namespace ist::cli {
namespace {

std::string capitals(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  });
  return name;
}

// Pages name what they are of in small letters, and without a full stop.
std::string in_a_line(std::string description) {
  if (!description.empty() && description.front() >= 'A' && description.front() <= 'Z') {
    description.front() = static_cast<char>(description.front() - 'A' + 'a');
  }
  return description;
}

std::string reference(const std::string& page) { return bold(page) + "(1)"; }

std::string heading(const OptionView& option) {
  std::string text;
  for (const std::string& spelling : option.spellings) {
    text += (text.empty() ? "" : ", ") + (option.is_argument ? italic(spelling) : bold(spelling));
  }
  if (option.is_argument || option.value.empty()) return text;
  if (option.choices.empty()) return text + " " + italic(option.value);
  std::string choices;
  for (const std::string& choice : option.choices) {
    choices += (choices.empty() ? " " : "|") + bold(choice);
  }
  return text + choices;
}

std::string sentences(const OptionView& option) {
  std::string text = option.description;
  if (!text.empty() && text.back() != '.') text += '.';
  if (option.required && !option.is_argument) text += " Required.";
  if (!option.range.empty()) text += fmt::format(" From {}.", option.range);
  if (!option.default_value.empty()) text += fmt::format(" Default: {}.", option.default_value);
  if (!option.excluded.empty()) {
    text += fmt::format(" Does not go with {}.", fmt::join(option.excluded, ", "));
  }
  return text;
}

void add_entries(Roff& page, const std::vector<OptionView>& options) {
  for (const OptionView& option : options) {
    page.entry(heading(option));
    page.fill(sentences(option));
  }
}

void add_options(Roff& page, const CommandView& command) {
  page.section("OPTIONS");
  add_entries(page, command.arguments);
  for (const OptionGroup& group : command.groups) {
    if (group.title != "Options") page.subsection(group.title);
    add_entries(page, group.options);
  }
}

void add_exit_status(Roff& page) {
  page.section("EXIT STATUS");
  for (const ExitMeaning& exit : kExitMeanings) {
    page.entry(bold(std::to_string(exit.code)));
    page.fill(exit.meaning);
  }
}

constexpr const char* kDocuments =
    "Documents, example programs and scenes are installed beside the command, in ../share/doc/ist.";

}  // namespace

std::string man_page(const CommandView& command, const std::vector<CommandView>& subcommands,
                     const PageEdition& edition) {
  Roff page(capitals(command.name), edition.date, edition.version);
  page.section("NAME");
  page.fill(command.name + " - where two rigid triangle meshes touch");
  page.section("SYNOPSIS");
  page.line(bold(command.name) + " " + italic("subcommand") + " [" + italic("options") + "]");
  page.section("DESCRIPTION");
  page.fill(command.description);
  page.paragraph(kPurpose);
  page.subsection("Subcommands");
  for (const CommandView& each : subcommands) {
    page.entry(bold(command.name + " " + each.name));
    page.fill(each.description + ".");
  }
  page.entry(bold(command.name + " help") + " [" + italic("subcommand") + "]");
  page.fill("Print the same as --help of the subcommand.");
  add_options(page, command);
  page.section("EXAMPLES");
  for (const CommandView& each : subcommands) {
    if (!each.examples.empty()) page.literal(each.examples.front());
  }
  add_exit_status(page);
  page.section("SEE ALSO");
  std::string references;
  for (const CommandView& each : subcommands) {
    references += (references.empty() ? "" : ",\n") + reference(command.name + "-" + each.name);
  }
  page.line(references);
  page.paragraph(kDocuments);
  return page.text();
}

std::string man_page(const CommandView& subcommand, const PageEdition& edition) {
  const std::string name = "ist-" + subcommand.name;
  Roff page(capitals(name), edition.date, edition.version);
  page.section("NAME");
  page.fill(name + " - " + in_a_line(subcommand.description));
  page.section("SYNOPSIS");
  std::string synopsis = bold("ist " + subcommand.name) + " [" + italic("options") + "]";
  for (const OptionView& argument : subcommand.arguments) {
    const std::string word = italic(argument.spellings.front());
    synopsis += argument.required ? " " + word : " [" + word + "]";
  }
  page.line(synopsis);
  page.section("DESCRIPTION");
  page.fill(subcommand.description + ".");
  bool says_purpose = false;
  for (const std::string& note : subcommand.notes) {
    page.paragraph(note);
    says_purpose = says_purpose || note.starts_with("Research software");
  }
  if (!says_purpose) page.paragraph(kPurpose);
  add_options(page, subcommand);
  page.section("EXAMPLES");
  for (const std::string& example : subcommand.examples) page.literal(example);
  add_exit_status(page);
  page.section("SEE ALSO");
  page.line(reference("ist"));
  page.paragraph(kDocuments);
  return page.text();
}

}  // namespace ist::cli
