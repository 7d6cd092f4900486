#pragma once

#include <Eigen/Geometry>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ist/base/api.h"
#include "ist/base/pose.h"
#include "ist/mesh/mesh.h"
#include "ist/query/manifold.h"
#include "ist/query/results.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

namespace detail {
struct Access;
struct QueryState;
}  // namespace detail

/// The options of a Query: its bounds, its speed and its memory.
struct QueryOptions {
  /// How bounds are read; by default the tightest policy that both trees have. kPolicyMissing if a
  /// tree lacks voxels.
  std::optional<SpherePolicy> policy = std::nullopt;
  /// The instruction set: `avx3`, `avx2`, `sse4`, `ssse3` or `scalar`; by default the environment's
  /// IST_TARGET, or the best one. The answer does not depend on it.
  std::string target = {};
  /// The most pairs of nodes in memory for each level and worker, 12 bytes each; none without
  /// voxels. The answer does not depend on it. With the default, a level stays in a core's own
  /// cache. A quarter of it takes a tenth more time for closed jaws; four times as many gain
  /// nothing.
  std::size_t frontier_pairs = 1 << 16;
  /// 1: the calling thread does all work. 2: a resident thread helps if it can.
  int workers = 1;
  /// With two workers: the time from the beginning of one query to the beginning of the next; 0 if
  /// queries follow each other at once.
  std::chrono::nanoseconds period = std::chrono::milliseconds(1);
  /// The most leaf pairs to keep from one pose to the next, 224 bytes each, and the memory of one
  /// more search. 0: none are kept, and every query searches. The pairs may be of half as many
  /// different fixed leaves. Three times the leaf pairs that overlap is room enough.
  ///
  /// For a body that moves by less than some 0.1 voxel from query to query: leaf_pairs() and
  /// contacts() then keep the pairs that are nearly near enough, and test them again. They search
  /// only after the motion has used this up, or if the pairs do not fit. The answers are the same,
  /// bit by bit, but for `sphere_tests`, `distance` and `found`. With a budget of tests every query
  /// searches. A query that a stream or a deadline ended makes nothing for the next one.
  std::size_t front_pairs = 0;
  /// The most near pairs to keep from one pose to the next, 390 bytes each, and the memory of one
  /// more search of triangles. 0: none are kept, and every near_pairs() searches.
  ///
  /// For a body that moves by less than some half of the margin from query to query. The answers
  /// are the same, bit by bit, but for `sphere_tests` and `found`. With a budget of tests every
  /// query searches. 2,048 is a good number, or three times the pairs that are near if these are
  /// more.
  std::size_t near_pairs = 0;
};

/// Asks two rigid bodies: are they near each other, do they intersect, how far apart are they, and
/// how do they push each other? It descends two bounding volume hierarchies in vectors: spheres
/// breadth first, clusters of triangles depth first.
///
/// `pose` maps moving mesh coordinates to fixed mesh coordinates. A pose that is no rigid motion
/// gives kInvalidPose. Lengths are in mesh units.
///
/// For one pair of trees and one pose every answer is the same, bit by bit: on every instruction
/// set, with one worker or two, and for all options of memory. A query keeps some of its earlier
/// questions. Only `sphere_tests`, the ends and the nearest triangles of distance(), and the
/// numbers that `front_pairs` and `near_pairs` name depend on them. A budget of tests ignores them.
///
/// The constructor reserves all memory and makes the first call of the kernels. A verb allocates
/// nothing, locks nothing and makes no system call; inside() may do so.
///
/// A query shares the content of both trees, so they may be temporaries. Any number of threads may
/// share a tree. One query belongs to one thread at a time: a verb gives kBusy if another thread is
/// in the query.
class IST_API Query {
 public:
  /// Throws kPolicyMissing, kTargetMissing, kMemoryLimit; kVoxelsMissing if one tree lacks voxels
  /// and the other no triangles; kArgumentInvalid for a number of workers other than 1 or 2, and
  /// for trees in different frames of a patient or different units; std::bad_alloc.
  Query(const SphereTree& fixed, const SphereTree& moving, const QueryOptions& options = {});
  ~Query();
  Query(Query&&) noexcept;             ///< the other may then only be assigned or destroyed
  Query& operator=(Query&&) noexcept;  ///< as the constructor

  /// Tests whether the bodies intersect, and ends at the first certain answer. It is exact if both
  /// trees have triangles, else kNo or kNear. It is kUnknown if the status is not kDone.
  ///
  /// @param pose   maps moving mesh coordinates to fixed mesh coordinates
  /// @param budget ends the search early: the answer is then kUnknown
  ///
  /// Cost: 2 to 70 µs for jaws, 0.3 µs if the triangles that met last still meet.
  [[nodiscard]] IntersectionResult intersects(const Eigen::Isometry3d& pose,
                                              const Budget& budget = {}) noexcept;

  /// Finds all pairs of leaves whose bounds overlap. kNoVoxels if a tree lacks voxels.
  ///
  /// @param pose   maps moving mesh coordinates to fixed mesh coordinates
  /// @param out    takes the pairs, sorted by fixed and then by moving leaf; if it is too short,
  /// the
  ///               first of them. Elements behind the last pair may be overwritten
  /// @param budget ends the search early: the result then holds the first pairs, but none of pairs
  ///               that were kept, and the distance as far as it is known. With a budget the
  ///               distance always has bounds
  ///
  /// Cost: 1 to 3 ns a test of two bounds, 20 to 40 ns a pair of nodes.
  [[nodiscard]] QueryResult leaf_pairs(const Eigen::Isometry3d& pose, std::span<LeafPair> out,
                                       const Budget& budget = {}) noexcept;

  /// Streams every leaf pair to `stream`, in the same order, instead of storing them. If take()
  /// returns false the search stops and the result is incomplete; its counts then depend on memory
  /// and workers.
  [[nodiscard]] QueryResult leaf_pairs(const Eigen::Isometry3d& pose,
                                       LeafPairStream& stream) noexcept;

  /// Reduces all leaf pairs to contacts, and to sums for forces. kNoVoxels if a tree lacks voxels.
  /// The distance is between the roots'
  /// bounds. With pairs it is no more than the resolution. If a budget ended the search, it is no
  /// more than the distance of its pairs. Inside a clearance that was kept, it is the rest of it.
  ///
  /// @param pose     maps moving mesh coordinates to fixed mesh coordinates
  /// @param manifold made for the same trees and policy, else kManifoldMismatch; emptied if the
  ///                 status is not kDone
  /// @param budget   ends the search early: then neither result nor manifold is complete, and there
  ///                 are no contacts; make no force of the sums. Contacts are made after the last
  ///                 look at the clock, in 15 ns a fixed leaf
  ///
  /// Cost: as leaf_pairs(), and 3 to 5 ns a leaf pair, with points 10 to 15; on the scalar target
  /// 50.
  [[nodiscard]] QueryResult contacts(const Eigen::Isometry3d& pose, ContactManifold& manifold,
                                     const Budget& budget = {}) noexcept;

  /// Bounds the distance between the surfaces by an interval no wider than the larger one of
  /// `tolerance` and `narrowest`. A tolerance that is NaN or negative counts as 0.
  ///
  /// @param pose      maps moving mesh coordinates to fixed mesh coordinates
  /// @param tolerance mesh units
  /// @param budget    ends the search early: the interval is then wider
  ///
  /// The interval always holds the true distance; `complete` says whether the tolerance was
  /// reached. It is 0 if triangle_pairs() finds any. Bodies may be so far apart that float cannot
  /// tell their parts from each other: they keep the interval of their roots. The search begins
  /// with the triangles that were nearest last. So earlier questions may change the ends, unless
  /// the tolerance is 0. docs/guarantees.md gives the rounding of each bound, and how fast the
  /// distance can change with the pose.
  ///
  /// Cost: 0.02 to 0.35 ms for two jaws that touch or are millimetres apart, up to 60 ms if they
  /// are a kilometre apart; without triangles 0.1 to 0.7 ms.
  [[nodiscard]] DistanceResult distance(const Eigen::Isometry3d& pose, double tolerance,
                                        const Budget& budget = {}) noexcept;

  /// Returns whether both trees have triangles.
  [[nodiscard]] bool has_triangles() const noexcept;

  /// Finds all pairs of triangles that have a point in common, exactly. A moved vertex is rounded
  /// to double first. kNoTriangles if has_triangles() is false.
  ///
  /// @param pose   maps moving mesh coordinates to fixed mesh coordinates
  /// @param out    takes the pairs, sorted by fixed and then by moving triangle; if it is too
  ///               short, the first of them
  /// @param budget ends the search early: the result then holds the pairs found so far
  ///
  /// Cost: 0.1 to 0.2 µs a pair that meets, of jaws that are closed. It does not depend on the
  /// voxels.
  [[nodiscard]] TrianglePairsResult triangle_pairs(const Eigen::Isometry3d& pose,
                                                   std::span<TrianglePair> out,
                                                   const Budget& budget = {}) noexcept;

  /// Finds all pairs of triangles that are no farther apart than a margin, with their closest
  /// points. Triangles that intersect are among them. A pair that is listed is no farther apart
  /// than the margin and the result's `pad`. kNoTriangles if has_triangles() is false,
  /// kMarginInvalid for a margin that is negative, infinite or NaN.
  ///
  /// @param pose   maps moving mesh coordinates to fixed mesh coordinates
  /// @param margin mesh units
  /// @param out    takes the pairs, sorted by distance, then by fixed and by moving triangle; if it
  /// is
  ///               too short, the nearest of them. Its elements may be written more than once
  /// @param budget ends the search early: the result then holds the pairs found so far
  ///
  /// Bodies may be so far apart that float cannot tell their parts from each other: the result is
  /// then not complete. Cost: for jaws that touch 0.3 ms with a margin of 0.06 mm; 0.3 µs a pair
  /// that is near, and 0.1 µs a pair that is nearly so.
  [[nodiscard]] NearPairsResult near_pairs(const Eigen::Isometry3d& pose, double margin,
                                           std::span<NearPair> out,
                                           const Budget& budget = {}) noexcept;

  /// The most pairs of parts that near_parts() lists.
  static constexpr std::size_t kMostNearParts = 15;

  /// Lists the parts of two triangles that are no farther apart than a margin: each corner above
  /// the face of the other triangle, and of each two edges the points that are closest. Parts of
  /// triangles that intersect have distances too, and tell no way apart. A motion of the bodies
  /// that keeps all of them apart keeps the triangles apart to first order, as one closest point
  /// does not. Status as near_pairs(); kNoSuchTriangle for an index out of range.
  ///
  /// @param pose      maps moving mesh coordinates to fixed mesh coordinates
  /// @param triangles by their indices in the meshes
  /// @param margin    mesh units
  /// @param out       takes the pairs of parts, in the order of their distances. No two are the
  /// same
  ///
  /// Cost: 0.5 µs.
  [[nodiscard]] NearPairsResult near_parts(const Eigen::Isometry3d& pose, TrianglePair triangles,
                                           double margin,
                                           std::span<NearPair, kMostNearParts> out) noexcept;

  /// Finds which body lies inside the other. A body lies inside if all its components do. A
  /// component does if one of its points has a winding number other than 0, and no triangles of the
  /// two bodies intersect. kNoTriangles if has_triangles() is false.
  ///
  /// @param pose maps moving mesh coordinates to fixed mesh coordinates
  ///
  /// An open body has no certain inside: SphereTree::orientation(). Cost: as intersects(), and some
  /// 3 µs for each component in the bounding box of the other body. The first call for a tree,
  /// or the first signed distance or depth, takes 1.2 µs a triangle and core. It can throw
  /// std::bad_alloc.
  [[nodiscard]] InsideResult inside(const Eigen::Isometry3d& pose);

  /// Forgets the earlier questions: the triangles that met or were nearest last, and the pairs of a
  /// cache. The next answers are those of a new query. Does nothing while another thread is in the
  /// query.
  void forget() noexcept;

  /// The fixed tree, which shares its content with the caller's.
  [[nodiscard]] const SphereTree& fixed() const noexcept;
  /// The moving tree, which shares its content with the caller's.
  [[nodiscard]] const SphereTree& moving() const noexcept;
  /// The bounds in use; kSimple if a tree lacks voxels.
  [[nodiscard]] SpherePolicy policy() const noexcept;
  /// The instruction set in use.
  [[nodiscard]] const char* target() const noexcept;
  /// The threads that search, 1 or 2.
  [[nodiscard]] int workers() const noexcept;
  /// Bytes reserved.
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  friend struct detail::Access;
  explicit Query(std::unique_ptr<detail::QueryState> state) noexcept;

  std::unique_ptr<detail::QueryState> state_;
};

}  // namespace ist
