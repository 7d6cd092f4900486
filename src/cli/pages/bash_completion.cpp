#include "cli/pages/bash_completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

namespace ist::cli {
namespace {

// Patterns of `case` by what stands in their branch.
using Branches = std::map<std::string, std::vector<std::string>>;

// Bash completes files itself if the function finds nothing.
constexpr const char* kFiles = "return";
// Nobody can complete a number.
constexpr const char* kNothing = "compopt +o default\n      return";

std::string choose(const std::vector<std::string>& choices) {
  return fmt::format("choices='{}'", fmt::join(choices, " "));
}

bool is_of_files(const OptionView& option) {
  return option.value == "FILE" || option.value == "FOLDER";
}

Branches values_of(const std::vector<CommandView>& subcommands) {
  Branches branches;
  for (const CommandView& each : subcommands) {
    for (const OptionView& option : each.options) {
      if (option.value.empty()) continue;
      std::vector<std::string>& patterns = branches[!option.choices.empty() ? choose(option.choices)
                                                    : is_of_files(option)   ? kFiles
                                                                            : kNothing];
      for (const std::string& spelling : option.spellings) {
        patterns.push_back(each.name + ":" + spelling);
      }
    }
  }
  return branches;
}

std::vector<std::string> spellings_of(const CommandView& command) {
  std::vector<std::string> spellings;
  for (const OptionView& option : command.options) {
    spellings.insert(spellings.end(), option.spellings.begin(), option.spellings.end());
  }
  return spellings;
}

std::string branch(const std::vector<std::string>& patterns, const std::string& body) {
  return fmt::format("    {})\n      {}\n      ;;\n", fmt::join(patterns, " | "), body);
}

constexpr const char* kBegin = R"(
_ist() {
  local word=${COMP_WORDS[COMP_CWORD]} option=${COMP_WORDS[COMP_CWORD - 1]} subcommand= choices=
  # Bash takes --unit=mm for three words.
  if [[ $word == = ]]; then
    word=
  elif [[ $option == = ]]; then
    option=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  ((COMP_CWORD == 1)) || subcommand=${COMP_WORDS[1]}
  case $subcommand:$option in
)";
constexpr const char* kEnd = R"(    *)
      return
      ;;
  esac
  compopt +o default
  mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$word")
}
complete -o default -F _ist ist
)";

}  // namespace

std::string bash_completion(const CommandView& command, const std::vector<CommandView>& subcommands,
                            const std::string& version) {
  std::string script = fmt::format("# Completes the words of {} in bash.\n", version) + kBegin;
  std::vector<std::string> names;
  for (const CommandView& each : subcommands) names.push_back(each.name);
  std::vector<std::string> first = names;
  first.insert(first.end(), {"help", "version"});
  for (const std::string& spelling : spellings_of(command)) first.push_back(spelling);
  script += branch({":*"}, choose(first)) + branch({"help:help"}, choose(names));
  for (const auto& [body, patterns] : values_of(subcommands)) script += branch(patterns, body);
  for (const CommandView& each : subcommands) {
    const std::string options = choose(spellings_of(each));
    script += branch({each.name + ":*"},
                     each.takes_files ? "[[ $word == -* ]] || return\n      " + options : options);
  }
  return script + kEnd;
}

}  // namespace ist::cli
