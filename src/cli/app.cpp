#include "cli/app.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "answers/version.h"
#include "cli/commands/commands.h"
#include "cli/exit_code.h"

namespace ist::cli {

using namespace answers;

namespace {

std::string exit_codes() {
  constexpr std::size_t kLine = 84;  // characters
  std::string text = "Exit codes:";
  std::size_t begin = 0;  // of the last line
  for (const ExitMeaning& exit : kExitMeanings) {
    const std::string item = fmt::format("{} {}", exit.code, exit.meaning);
    const bool breaks = text.size() - begin + item.size() + 2 > kLine;
    if (breaks) begin = text.size() + 1;
    text += (breaks ? '\n' : ' ') + item + ',';
  }
  text.back() = '.';
  return text;
}

}  // namespace

std::unique_ptr<CLI::App> make_app() {
  auto app = std::make_unique<CLI::App>(
      "Finds where two rigid triangle meshes touch, how deep and how far apart they are.\n"
      "Try 'ist demo' first: it needs no files.\n"
      "Lengths are in the unit of the mesh files, millimetres by habit.",
      "ist");
  app->require_subcommand(1);
  app->set_version_flag("-V,--version", version_lines());
  app->failure_message(CLI::FailureMessage::simple);
  app->footer(exit_codes() + "\n" + kPurpose);
  add_demo(*app);
  add_build(*app);
  add_info(*app);
  add_export(*app);
  add_collide(*app);
  add_approach(*app);
  add_occlusion(*app);
  add_settle(*app);
  add_compare(*app);
  add_run(*app);
  add_view(*app);
  add_sweep(*app);
  add_advise(*app);
  add_bench(*app);
  add_table(*app);
  return app;
}

}  // namespace ist::cli
