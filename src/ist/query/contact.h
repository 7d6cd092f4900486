#pragma once

#include <cstdint>

namespace ist {

/// A pair of leaves whose spheres touch, by their indices in the two trees. The surfaces in them
/// are no farther apart than the answer's resolution.
struct Contact {
  std::uint32_t fixed, moving;

  friend bool operator==(const Contact&, const Contact&) = default;
};
static_assert(sizeof(Contact) == 8);

enum class QueryStatus : std::uint8_t {
  kDone,
  kInvalidPose,  ///< not a rigid motion (project_to_rigid); nothing was searched
};

/// What a query found.
struct QueryResult {
  QueryStatus status = QueryStatus::kDone;
  bool complete = true;            ///< searched down to the leaves
  bool truncated = false;          ///< the span was too short: it holds the first contacts
  int level = 0;                   ///< down to which it searched
  std::uint64_t contacts = 0;      ///< all that there are, in the span or not
  std::uint64_t sphere_tests = 0;  ///< pairs of spheres tested
  /// Leaf spheres in a contact are no farther apart, mesh units: what the reach of a sphere test
  /// was grown by, and what the test may err by on top.
  double pad = 0;
};

}  // namespace ist
