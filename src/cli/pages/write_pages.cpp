// write_pages HELP_FOLDER COMPLETION_FILE
// Writes the help of the command and of each subcommand, as help2man reads it, to HELP_FOLDER:
// ist.txt, ist-collide.txt and others. Writes the completion for bash. Runs at build time.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "answers/commit.h"
#include "cli/app.h"
#include "cli/exit_code.h"
#include "cli/pages/bash_completion.h"
#include "ist/base/files.h"

namespace ist::cli {
namespace {

constexpr const char* kDocuments =
    "Documents, example programs and scenes are installed beside the command, in ../share/doc/ist.";

// The help of CLI11 in the form that help2man reads: "-o, --output FILE", two spaces, a text. A
// line *Name* begins a section, and a command stands behind "$ ". Notes come first, since help2man
// puts all text before the options into the description.
class ManualHelp : public CLI::Formatter {
 public:
  ManualHelp() { column_width(29); }

  std::string make_option_name(const CLI::Option* option, bool is_positional) const override {
    return CLI::detail::find_and_replace(Formatter::make_option_name(option, is_positional), ",",
                                         ", ");
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    const std::string text = Formatter::make_option_opts(option);
    std::vector<std::string> excluded;
    for (const CLI::Option* other : option->get_excludes()) excluded.push_back(other->get_name());
    if (excluded.empty()) return text;
    std::sort(excluded.begin(), excluded.end());  // CLI11 keeps them by address
    return fmt::format("{} Excludes: {}", text.substr(0, text.find(" Excludes: ")),
                       fmt::join(excluded, " "));
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    return " " + Formatter::make_option_desc(option);  // CLI11 leaves one space after a long name
  }

  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override {
    const CommandView view = command_view(*app);
    std::vector<std::string> examples = view.examples;
    std::string see = "ist(1)";
    if (app->get_parent() == nullptr) {
      see.clear();
      for (const CLI::App* each : app->get_subcommands({})) {
        examples.push_back(command_view(*each).examples.front());
        see += fmt::format("{}ist-{}(1)", see.empty() ? "" : ", ", each->get_name());
      }
    }
    std::string text = make_description(app);
    for (const std::string& note : view.notes) text += "\n" + note + "\n";
    text += fmt::format("\n{}\n\n{}{}{}{}\n*Exit status*\n", kPurpose, make_usage(app, name),
                        make_positionals(app), make_subcommands(app, mode), make_groups(app, mode));
    for (const ExitMeaning& exit : kExitMeanings) {
      text += fmt::format("  {:<5}{}\n", exit.code, exit.meaning);
    }
    text += "\nExamples:\n\n";
    for (const std::string& example : examples) text += "  $ " + example + "\n";
    return text + fmt::format("\n*See also*\n{}\n\n{}\n", see, kDocuments);
  }
};

void write(const std::filesystem::path& path, const std::string& text) {
  OutputFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

void write_pages(const std::filesystem::path& help, const std::filesystem::path& completion) {
  const std::unique_ptr<CLI::App> app = make_app();
  const ManualHelp manual;
  std::vector<CommandView> subcommands;
  write(help / "ist.txt", manual.make_help(app.get(), "ist", CLI::AppFormatMode::Normal));
  for (const CLI::App* each : app->get_subcommands({})) {
    const std::string& name = each->get_name();
    write(help / ("ist-" + name + ".txt"),
          manual.make_help(each, "ist " + name, CLI::AppFormatMode::Normal));
    subcommands.push_back(command_view(*each));
  }
  write(completion, bash_completion(command_view(*app), subcommands, "ist " IST_VERSION));
}

}  // namespace
}  // namespace ist::cli

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: write_pages HELP_FOLDER COMPLETION_FILE\n");
    return 2;
  }
  ist::cli::write_pages(argv[1], argv[2]);
}
