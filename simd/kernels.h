#pragma once

#include <vector>

#include "ist/query/search_step.h"

namespace ist::simd {

/// The vector twins of kScalarKernels for each instruction set that this build and this processor
/// have, best first: avx3, avx2, sse4, ssse3.
[[nodiscard]] std::vector<Kernels> supported_kernels();

}  // namespace ist::simd
