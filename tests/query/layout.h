#pragma once

#include <array>
#include <cstddef>

#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/query.h"
#include "ist/query/reference/reference_query.h"
#include "ist/query/world/world.h"

namespace ist::test {

template <class... Types>
consteval std::array<std::size_t, 2 * sizeof...(Types)> layout_of() {
  return {sizeof(Types)..., alignof(Types)...};
}

/// Sizes and alignments of what consumers have in their memory, as the code that calls it sees
/// them.
consteval auto public_layout() {
  return layout_of<SphereTree, TriangleMesh, ReferenceQuery, Query, QueryOptions, ContactManifold,
                   Contact, ContactSums, ManifoldOptions, LeafPair, IntersectionResult, QueryResult,
                   TrianglePairsResult, NearPair, NearPairsResult, DistanceResult, World,
                   WorldOptions, WorldQuestion, WorldPair, WorldAnswer, WorldDistance>();
}

/// As code compiled for AVX-512 does.
extern const decltype(public_layout()) kWideLayout;

}  // namespace ist::test
