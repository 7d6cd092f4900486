#pragma once

#include <algorithm>
#include <cstdlib>

namespace ist::bench {

/// Whether IST_QUICK is set: results that show that everything runs, not what it costs.
[[nodiscard]] inline bool quick() { return std::getenv("IST_QUICK") != nullptr; }

/// How often something is measured: a thirtieth as often where that is quick(), but three times.
[[nodiscard]] inline int rounds(int full) { return quick() ? std::max(3, full / 30) : full; }

}  // namespace ist::bench
