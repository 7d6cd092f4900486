#pragma once

#include <Eigen/Core>
#include <chrono>
#include <compare>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "ist/base/api.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

namespace detail {
/// Returns the time that budgets compare their deadlines with.
[[nodiscard]] IST_API std::chrono::steady_clock::time_point budget_now() noexcept;
}  // namespace detail

/// The limits of one query. They mean the same for every verb that takes them.
///
/// A search never makes more tests than allowed, except for the root test, which it always makes.
/// If there is a deadline, it reads the clock at least every 500 tests, every 512 leaf pairs, and
/// every 2,048 kept pairs, some 3 ns each. It ends at the first look after the deadline.
///
/// A search that ended early returns its findings so far: for bounds the level and an interval of
/// the distance, for triangles the pairs or the interval. If only tests are limited, the answer is
/// the same on every machine and in every run. If a deadline ended a search, a limit of as many
/// tests ends it at the same place. An answer from kept pairs is an exception: if a deadline ended
/// it, the answer holds no leaf pairs, and any of the near pairs.
struct Budget {
  /// The clock that deadlines are times of.
  using Clock = std::chrono::steady_clock;

  /// The most pairs of bounds to test. A pair of triangle clusters counts as 16 more if its
  /// triangles are compared.
  std::uint64_t tests = std::numeric_limits<std::uint64_t>::max();
  /// The time at which the search ends; time_point::max(): never.
  Clock::time_point deadline = Clock::time_point::max();

  /// Whether tests are limited.
  [[nodiscard]] bool has_tests() const noexcept {
    return tests != std::numeric_limits<std::uint64_t>::max();
  }
  /// Whether time is limited.
  [[nodiscard]] bool has_deadline() const noexcept { return deadline != Clock::time_point::max(); }
  /// Whether anything is limited.
  [[nodiscard]] bool is_limited() const noexcept { return has_tests() || has_deadline(); }
  /// Returns whether the deadline has passed. Reads the clock only if there is a deadline.
  [[nodiscard]] bool is_past() const noexcept {
    return has_deadline() && detail::budget_now() >= deadline;
  }
  /// Returns this budget with a limit of at most `most` tests.
  [[nodiscard]] Budget within(std::uint64_t most) const noexcept {
    return {most < tests ? most : tests, deadline};
  }
};

/// The distance between two surfaces lies in [lower, upper], mesh units. Both ends are finite: a
/// distance that no double holds counts as the largest double.
struct DistanceInterval {
  double lower,  ///< the distance is no less
      upper;     ///< and no more
};

/// Whether a verb answered, or why not.
enum class QueryStatus : std::uint8_t {
  kDone,              ///< the result holds an answer
  kInvalidPose,       ///< the pose is no rigid motion; nothing was searched
  kNoTriangles,       ///< the question needs triangles, and a tree was built without them
  kManifoldMismatch,  ///< the manifold was made for other trees or another policy
  kBusy,              ///< another thread is using the query; nothing was searched or changed
  kNotPrepared,       ///< of a World: nothing was reserved for this question before
  kNoSuchBody,        ///< of a World: no body has this number
  kMarginInvalid,     ///< the margin is negative, infinite or no number
  kNoSuchTriangle,    ///< a mesh has fewer triangles than the index asks for
  kNoVoxels,          ///< the question needs voxels, and a tree was built without them
};
/// Returns the status' name, such as "invalid-pose", for logs and tests.
[[nodiscard]] IST_API const char* to_string(QueryStatus status) noexcept;

/// How a query found its answer. The answer does not depend on it.
enum class Found : std::uint8_t {
  kFresh,  ///< by a search at this pose
  kKept,   ///< among the pairs that were kept from earlier poses
  kClear,  ///< without a look: by the bounds of the roots, or a clearance found at an earlier pose
};

/// The answer of Query::leaf_pairs and Query::contacts.
struct QueryResult {
  QueryStatus status = QueryStatus::kDone;  ///< other than kDone: nothing was found
  bool complete = true;                     ///< the search went down to the leaves, to the end
  bool truncated = false;                   ///< the span was too short and holds the first pairs
  int level = 0;                            ///< steps above the leaves at which the search ended
  std::uint64_t leaf_pairs = 0;             ///< all pairs that were found, in the span or not
  std::uint64_t sphere_tests = 0;           ///< pairs of bounds that were tested
  /// The distance between the surfaces, as far as the tests tell it. Absent after an error, and
  /// where leaf_pairs() without a budget found the bounds of the roots to overlap, and no
  /// clearance.
  std::optional<DistanceInterval> distance = std::nullopt;
  /// The surfaces in a leaf pair are no farther apart than this, mesh units: 2 (rA + rB) + pad,
  /// with rA and rB the radii of the largest leaves.
  double resolution = 0;
  /// The bounds of a leaf pair are no farther apart than this, mesh units: the margin asked for,
  /// and the rounding error that the tests allow for.
  double pad = 0;
  Found found = Found::kFresh;  ///< the way to the answer, which does not change it
  /// How far the rotation of the given pose was from orthonormal (rotation_error). The answer holds
  /// for the nearest rotation.
  double rotation_error = 0;
};

/// A pair of triangles that have a point in common, by their indices in the two meshes.
struct TrianglePair {
  std::uint32_t fixed,  ///< triangle of the fixed mesh
      moving;           ///< triangle of the moving mesh

  /// Orders pairs by fixed and then by moving triangle.
  friend auto operator<=>(const TrianglePair&, const TrianglePair&) = default;
};

/// The answer of Query::triangle_pairs.
struct TrianglePairsResult {
  QueryStatus status = QueryStatus::kDone;  ///< other than kDone: nothing was searched
  bool complete = true;                     ///< the search came to its end: these are all pairs
  bool truncated = false;                   ///< the span was too short and holds the first pairs
  std::uint64_t triangle_pairs = 0;  ///< pairs that intersect and were found, in the span or not
  std::uint64_t sphere_tests = 0;    ///< as Budget::tests counts them
  double rotation_error = 0;         ///< as QueryResult has it
};

/// A part of a triangle.
enum class TrianglePart : std::uint8_t {
  kCorner0,  ///< the first corner
  kCorner1,
  kCorner2,
  kEdge0,  ///< the edge from the first corner to the second
  kEdge1,
  kEdge2,  ///< the edge from the last corner to the first
  kFace,   ///< the inside
};

/// Closest points of two triangles, or of parts of them. Points are in fixed coordinates, lengths
/// in mesh units.
struct IST_API NearPair {
  TrianglePair triangles = {};       ///< by their indices in the meshes
  double distance = 0;               ///< 0 if the triangles intersect, and only then
  Eigen::Vector3d fixed_point = {},  ///< on the fixed triangle
      moving_point = {};             ///< on the moving one; a common point if they intersect
  TrianglePart fixed_part = TrianglePart::kFace,  ///< the smallest part that holds the point
      moving_part = TrianglePart::kFace;          ///< likewise

  /// Returns the unit vector from the fixed point to the moving one; 0 if the triangles intersect,
  /// or if the points are the same. Both points are rounded, so the vector errs by their rounding
  /// over the distance.
  [[nodiscard]] Eigen::Vector3d direction() const noexcept;
};

/// The answer of Query::near_pairs.
struct NearPairsResult {
  QueryStatus status = QueryStatus::kDone;  ///< other than kDone: nothing was searched
  bool complete = true;                     ///< the search came to its end: these are all pairs
  bool truncated = false;                   ///< the span was too short and holds the nearest pairs
  std::uint64_t near_pairs = 0;             ///< pairs that were found, in the span or not
  double pad = 0;  ///< no pair is farther apart than the margin and this, mesh units
  std::uint64_t sphere_tests = 0;  ///< as Budget::tests counts them
  Found found = Found::kFresh;     ///< the way to the answer, which does not change it
  double rotation_error = 0;       ///< as QueryResult has it
};

/// The answer of Query::distance.
struct DistanceResult {
  QueryStatus status = QueryStatus::kDone;  ///< other than kDone: there is no answer
  bool complete = false;                    ///< the interval is no wider than the tolerance
  /// The distance of the surfaces; [0, infinity] without an answer.
  DistanceInterval distance{0, std::numeric_limits<double>::infinity()};
  /// The width that rounding or voxels allow here. If no budget ends the search, the interval is no
  /// wider than the tolerance or this. It is the rounding of a distance of triangles, of those
  /// found so far if a budget ended the search. Without triangles it is twice the resolution; the
  /// interval may be narrower, and then reaches a smaller tolerance.
  double narrowest = 0;
  /// The nearest triangles that were found. Their distance lies in the interval. Empty without
  /// triangles, for bodies so far apart that the roots' interval stays, and if a budget ended the
  /// search before it measured a pair.
  std::optional<NearPair> nearest = std::nullopt;
  std::uint64_t sphere_tests = 0;  ///< as Budget::tests counts them
  double rotation_error = 0;       ///< as QueryResult has it
};

/// Whether two bodies intersect. The numbers are the IST_ANSWER_... of C.
enum class Answer : std::uint8_t {
  kUnknown,  ///< there is no answer: after an error, or after a budget that ended the search
  kNo,       ///< the surfaces are apart; one body may lie inside the other (Query::inside)
  kNear,     ///< bounds of leaves overlap, and there are no triangles to decide by
  kYes,      ///< triangles have a point in common, exactly
};

/// Returns "unknown", "no", "near" or "yes".
[[nodiscard]] IST_API const char* to_string(Answer answer) noexcept;

/// The answer of Query::intersects.
struct IntersectionResult {
  QueryStatus status = QueryStatus::kDone;  ///< other than kDone: the answer is kUnknown
  Answer answer = Answer::kUnknown;         ///< exact where both trees have triangles
  bool complete = false;                    ///< no budget ended the search, and no error
  double resolution = 0;                    ///< with kNear: the surfaces are no farther apart
  std::uint64_t sphere_tests = 0;           ///< as Budget::tests counts them
  double rotation_error = 0;                ///< as QueryResult has it
};

/// The one of two bodies that lies inside the other.
enum class Inside : std::uint8_t {
  kNone,    ///< neither: their surfaces intersect, or a component lies outside
  kFixed,   ///< the fixed body
  kMoving,  ///< the moving body
};
/// Returns "none", "fixed" or "moving".
[[nodiscard]] IST_API const char* to_string(Inside inside) noexcept;

/// The answer of Query::inside.
struct InsideResult {
  QueryStatus status = QueryStatus::kDone;  ///< other than kDone: there is no answer
  Inside inside = Inside::kNone;            ///< the body inside
  double rotation_error = 0;                ///< as QueryResult has it
};

/// Takes leaf pairs in order, many at a time, while a query finds them.
class IST_API LeafPairStream {
 public:
  /// @return whether more pairs are wanted
  virtual bool take(std::span<const LeafPair> pairs) noexcept = 0;

 protected:
  ~LeafPairStream() = default;
};

}  // namespace ist
