#pragma once

#include <compare>
#include <cstdint>
#include <optional>

namespace ist {

/// A pair of leaves whose spheres touch, by their indices in the two trees. The surfaces in them
/// are no farther apart than the answer's resolution.
struct Contact {
  std::uint32_t fixed, moving;

  friend auto operator<=>(const Contact&, const Contact&) = default;
};
static_assert(sizeof(Contact) == 8);

/// The distance between two surfaces is in [lower, upper], mesh units. Both ends are finite: a
/// distance that no double holds counts as the largest one.
struct GapInterval {
  double lower, upper;
};

enum class QueryStatus : std::uint8_t {
  kDone,
  kInvalidPose,  ///< not a rigid motion (project_to_rigid); nothing was searched
  kNoTriangles,  ///< triangles were asked for, and a tree was built without; nothing was searched
};

/// What a query found.
struct QueryResult {
  QueryStatus status = QueryStatus::kDone;
  bool complete = true;        ///< searched down to the leaves, to the end
  bool truncated = false;      ///< the span was too short: it holds the first contacts
  int level = 0;               ///< down to which it searched: steps that are left, 0 at the leaves
  std::uint64_t contacts = 0;  ///< all that there are, in the span or not
  std::uint64_t sphere_tests = 0;  ///< pairs of spheres tested
  /// Where it is known: what the tests that were made tell of the distance between the surfaces.
  std::optional<GapInterval> gap;
  /// Leaf spheres in a contact are no farther apart, mesh units: what the reach of a sphere test
  /// was grown by, and what the test may err by on top.
  double pad = 0;
};

/// A pair of triangles that have a point in common, by their indices in the two meshes.
struct TrianglePair {
  std::uint32_t fixed, moving;

  friend auto operator<=>(const TrianglePair&, const TrianglePair&) = default;
};

/// What an exact query found.
struct ExactResult {
  QueryStatus status = QueryStatus::kDone;
  bool truncated = false;            ///< the span was too short: it holds the first pairs
  std::uint64_t triangle_pairs = 0;  ///< all that there are, in the span or not
  std::uint64_t sphere_tests = 0;
};

/// What a query for the distance found.
struct GapResult {
  QueryStatus status = QueryStatus::kDone;
  GapInterval gap{};
  std::uint64_t sphere_tests = 0;
};

/// Whether two bodies touch.
enum class Touch : std::uint8_t {
  kNo,
  kPossible,  ///< leaves touch, and there are no triangles to ask
  kYes,
  kInvalidPose,
};

}  // namespace ist
