#pragma once

#include <string>
#include <vector>

#include "peers/peer.h"

namespace ist::bench {

/// All that this program was built with. The first one is IST.
[[nodiscard]] std::vector<Library> libraries();

/// Names of those that it was built without, with a comma between them.
[[nodiscard]] std::string missing_libraries();

/// What compiles others than IST for this processor, as a compiler takes it; empty where it has
/// nothing for that.
[[nodiscard]] std::string library_flags();

}  // namespace ist::bench
