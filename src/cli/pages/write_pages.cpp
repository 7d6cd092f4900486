// write_pages MAN_FOLDER COMPLETION_FILE
// Writes the manual pages of the command and its completion for bash, at build time, by the
// command's own description of its options.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/app.h"
#include "cli/commit.h"
#include "cli/pages/bash_completion.h"
#include "cli/pages/man_page.h"
#include "ist/base/files.h"

namespace ist::cli {
namespace {

void write(const std::filesystem::path& path, const std::string& text) {
  OutputFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

void write_pages(const std::filesystem::path& man, const std::filesystem::path& completion) {
  const PageEdition edition{IST_DATE, "ist " IST_VERSION};
  const std::unique_ptr<CLI::App> app = make_app();
  const CommandView command = command_view(*app);
  std::vector<CommandView> subcommands;
  for (const CLI::App* each : app->get_subcommands({})) subcommands.push_back(command_view(*each));
  write(man / "ist.1", man_page(command, subcommands, edition));
  for (const CommandView& each : subcommands) {
    write(man / ("ist-" + each.name + ".1"), man_page(each, edition));
  }
  write(completion, bash_completion(command, subcommands, edition.version));
}

}  // namespace
}  // namespace ist::cli

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: write_pages MAN_FOLDER COMPLETION_FILE\n");
    return 2;
  }
  ist::cli::write_pages(argv[1], argv[2]);
}
