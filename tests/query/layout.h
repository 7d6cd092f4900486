#pragma once

#include <array>
#include <cstddef>

#include "ist/query/collision_query.h"
#include "ist/query/reference.h"

namespace ist::test {

template <class... Types>
consteval std::array<std::size_t, 2 * sizeof...(Types)> layout_of() {
  return {sizeof(Types)..., alignof(Types)...};
}

/// Sizes and alignments of what consumers have in their memory, as the code that calls it sees
/// them.
consteval auto public_layout() {
  return layout_of<SphereTree, TriangleMesh, ReferenceQuery, CollisionQuery, CollisionOptions,
                   ContactPoints, ContactPoint, ContactSums, ContactRates, ExactSearch,
                   TrianglePairs, Search, SearchPlan, QueryResult, ExactResult, GapResult,
                   RelativePose>();
}

/// As code compiled for AVX-512 does.
extern const decltype(public_layout()) kWideLayout;

}  // namespace ist::test
