#pragma once

#include <cstddef>

#include "ist/query/query.h"
#include "ist/query/triangles/swept_nodes.h"
#include "ist/query/triangles/swept_visitor.h"

namespace ist {

/// The answer of swept_pairs().
struct SweptPairsResult {
  QueryStatus status = QueryStatus::kDone;  ///< other than kDone: nothing was searched
  bool complete = true;                     ///< the deadline did not end the search
  /// The list has room for all pairs, and the bodies are not so far apart that float cannot tell
  /// their parts from each other. Else ask for a shorter part.
  bool fits = true;
};

/// Lists all pairs of triangles that may meet on a part of a motion, and some that do not. The list
/// has the same pairs on every instruction set, in any order.
///
/// @param query of two trees with triangles
/// @param part  of the motion of the moving body
/// @param most  more pairs, of clusters or of triangles, end the search
/// @param until its deadline ends the search
/// @param out   takes the pairs; its memory grows
///
/// Cost: as Query::intersects(), and 0.2 µs a pair.
[[nodiscard]] SweptPairsResult swept_pairs(Query& query, const ScrewPart& part, std::size_t most,
                                           const Budget& until, SweptList& out);

}  // namespace ist
