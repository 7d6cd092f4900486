// In place of step_vector.cpp where a build has scalar kernels alone.

#include "simd/dispatch.h"

namespace ist::simd {

std::vector<Kernels> supported_kernels() { return {}; }

}  // namespace ist::simd
