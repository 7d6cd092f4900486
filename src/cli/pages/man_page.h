#pragma once

#include <string>
#include <vector>

#include "cli/pages/command_view.h"

namespace ist::cli {

/// The end of a page's title line.
struct PageEdition {
  std::string date;     ///< as 2005-03-18
  std::string version;  ///< as ist 1.2.3
};

/// Returns ist(1), which names all subcommands and shows an example of each.
[[nodiscard]] std::string man_page(const CommandView& command,
                                   const std::vector<CommandView>& subcommands,
                                   const PageEdition& edition);

/// Returns the page of a subcommand, such as ist-collide(1).
[[nodiscard]] std::string man_page(const CommandView& subcommand, const PageEdition& edition);

}  // namespace ist::cli
