// In place of cluster_vector.cpp where Highway has no vectors of doubles: WebAssembly's.

#include "simd/triangles/cluster_step.h"

namespace ist::simd {

ClusterKernels cluster_kernels(std::int64_t) { return kScalarClusterKernels; }

}  // namespace ist::simd
