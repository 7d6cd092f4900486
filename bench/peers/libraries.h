#pragma once

#include <string>
#include <vector>

#include "peers/peer.h"

namespace ist::bench {

/// All that this program was built with. The first one is IST.
[[nodiscard]] std::vector<Library> libraries();

/// Names of those that it was built without, with a comma between them.
[[nodiscard]] std::string missing_libraries();

/// The compiler's option that compiles others than IST for this processor; empty where it has
/// none.
[[nodiscard]] std::string library_flags();

}  // namespace ist::bench
