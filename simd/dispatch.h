#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "simd/contact_step.h"
#include "simd/pair_cache_step.h"
#include "simd/step.h"
#include "simd/triangles/cluster_step.h"

namespace ist {

/// The kernels of a query, for one instruction set.
struct Kernels {
  const char* target;  ///< `scalar`, `avx3`, …
  AdvanceFunction advance;
  WriteLeafPairsFunction write_leaf_pairs;
  AdvanceContactsFunction advance_contacts;
  AddContactsFunction add_contacts;
  AdvanceCacheFunction advance_cache;
  TurnCacheFunction turn_cache;
  SelectCacheFunction select_cache;
  AddCacheFunction add_cache;
  ClusterKernels clusters;
};

/// The scalar kernels, which every processor runs; but for those of clusters,
/// kScalarClusterKernels, so that both exist before anything runs.
extern const Kernels kScalarKernels;

/// Returns the kernels of every instruction set that this build and this processor have, best
/// first; the last is `scalar`.
[[nodiscard]] std::span<const Kernels> all_kernels();

/// Returns the kernels of an instruction set by its name. An empty name takes the environment's
/// IST_TARGET, or the best where that is not set. Throws kTargetMissing, listing the names, for an
/// unknown one.
[[nodiscard]] const Kernels& select_kernels(std::string_view target);

namespace simd {

/// Returns the vector twins of kScalarKernels for each instruction set that this build and this
/// processor have, best first: avx3, avx2, sse4, ssse3 on x86-64; neon on ARM64;
/// simd128 in WebAssembly.
[[nodiscard]] std::vector<Kernels> supported_kernels();

}  // namespace simd
}  // namespace ist
