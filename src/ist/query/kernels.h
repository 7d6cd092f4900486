#pragma once

#include <span>
#include <string_view>

#include "ist/query/search_step.h"

namespace ist {

/// All instruction sets that a query can use on this processor, best first; the last is `scalar`.
[[nodiscard]] std::span<const Kernels> all_kernels();

/// Those of one name, or the best where the name is empty: then the environment's IST_TARGET names
/// one, if it is set. Throws kTargetMissing, saying which there are, for a name that is none.
[[nodiscard]] const Kernels& find_kernels(std::string_view target);

}  // namespace ist
