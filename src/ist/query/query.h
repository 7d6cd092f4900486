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
#include "ist/mesh/mesh.h"
#include "ist/query/manifold.h"
#include "ist/query/results.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

namespace detail {
struct QueryState;
struct InsideState;
}  // namespace detail

/// The options of a Query: its bounds, its speed and its memory.
struct QueryOptions {
  /// How bounds are read; by default the tightest policy that both trees have.
  std::optional<SpherePolicy> policy = std::nullopt;
  /// The instruction set: `avx3`, `avx2`, `sse4`, `ssse3` or `scalar`; by default the environment's
  /// IST_TARGET, or the best one. The answer does not depend on it.
  std::string target = {};
  /// The most pairs of nodes of one level in memory, 12 bytes each, a level and worker. The answer
  /// does not depend on it. With the default a level stays in a core's own cache; a quarter of it
  /// costs a tenth of the time more where jaws are closed, four times as many gain nothing.
  std::size_t frontier_pairs = 1 << 16;
  /// 1: the calling thread does all work. 2: a resident thread helps where it can.
  int workers = 1;
  /// With two workers: the time from the beginning of one query to the beginning of the next; 0
  /// where queries follow each other at once.
  std::chrono::nanoseconds period = std::chrono::milliseconds(1);
  /// The most leaf pairs to keep from one pose to the next, 224 bytes each, and the memory of one
  /// more search; 0: none, and every query is a search of its own. They may be of half as many
  /// different fixed leaves; three times the leaf pairs that overlap is room enough. For a body
  /// that moves by less than some 0.1 voxel from query to query: leaf_pairs() and contacts() then
  /// keep the pairs that are nearly near enough, test them again, and search only where the motion
  /// has used that up. Where they do not fit, they search. The answers are the same, bit by bit,
  /// but for `sphere_tests`, `distance` and `found`. A budget of tests makes every query a search
  /// of its own. A query that a stream or a deadline ended makes nothing for the next one.
  std::size_t front_pairs = 0;
};

/// Finds where two rigid bodies are near each other, intersect and push each other, and how far
/// apart they are: traversals of two bounding volume hierarchies in vectors, of spheres breadth
/// first, of clusters of triangles depth first.
///
/// `pose` maps moving mesh coordinates to fixed mesh coordinates; a pose that is no rigid motion
/// gives kInvalidPose. Lengths are in mesh units. For one pair of trees and one pose every answer
/// is the same, bit by bit, on every instruction set, with one worker or two, and whatever the
/// options for memory. Of what a query keeps from earlier questions only these depend: the numbers
/// that `front_pairs` names, the ends of distance(), and `sphere_tests`. A budget of tests ignores
/// it.
///
/// The constructor reserves all memory and makes the first call of the kernels. A verb allocates
/// nothing, locks nothing and makes no system call. A query shares the content of both trees; a
/// temporary tree does not compile. Any number of threads may share a tree; one query belongs to
/// one thread at a time: a verb that finds another thread in the query gives kBusy.
class IST_API Query {
 public:
  /// Throws kPolicyMissing, kTargetMissing, kMemoryLimit; kArgumentInvalid for a number of workers
  /// other than 1 or 2, and for trees in different frames of a patient; std::bad_alloc.
  Query(const SphereTree& fixed, const SphereTree& moving, const QueryOptions& options = {});
  Query(const SphereTree&&, const SphereTree&, const QueryOptions& = {}) = delete;
  Query(const SphereTree&, const SphereTree&&, const QueryOptions& = {}) = delete;
  Query(const SphereTree&&, const SphereTree&&, const QueryOptions& = {}) = delete;
  ~Query();
  Query(Query&&) noexcept;             ///< the other may then only be assigned or destroyed
  Query& operator=(Query&&) noexcept;  ///< as the constructor

  /// Tests whether the bodies intersect. Ends at the first certain answer: exact if both trees have
  /// triangles, else kNo or kNear. The answer is kUnknown if the status is not kDone.
  ///
  /// @param pose   maps moving mesh coordinates to fixed mesh coordinates
  /// @param budget ends the search early: the answer is then kUnknown
  ///
  /// Cost: 2 to 70 µs for jaws, 0.3 µs where the triangles that met last still meet.
  [[nodiscard]] IntersectionResult intersects(const Eigen::Isometry3d& pose,
                                              const Budget& budget = {}) noexcept;

  /// Finds all pairs of leaves whose bounds overlap.
  ///
  /// @param pose   maps moving mesh coordinates to fixed mesh coordinates
  /// @param out    takes the pairs, sorted by fixed and then by moving leaf; where it is too short,
  ///               the first of them. Elements behind the last pair may be overwritten
  /// @param budget ends the search early: the result then holds the first pairs, of pairs that were
  ///               kept none, and the distance as far as it is known. With a budget the distance is
  ///               bounded in any case
  ///
  /// Cost: 1 to 3 ns a test of two bounds, 20 to 40 ns a pair of nodes.
  [[nodiscard]] QueryResult leaf_pairs(const Eigen::Isometry3d& pose, std::span<LeafPair> out,
                                       const Budget& budget = {}) noexcept;

  /// Streams every leaf pair to `stream`, in the same order, instead of storing them. If take()
  /// returns false the search stops and the result is incomplete; its counts then depend on memory
  /// and workers.
  [[nodiscard]] QueryResult leaf_pairs(const Eigen::Isometry3d& pose,
                                       LeafPairStream& stream) noexcept;

  /// Reduces all leaf pairs to contacts and to the sums that forces are made of. The distance is
  /// that of the roots' bounds, and no more than the resolution where there are pairs; of a search
  /// that a budget ended, no more than that of its pairs; inside a clearance that was kept, what is
  /// left of it.
  ///
  /// @param pose     maps moving mesh coordinates to fixed mesh coordinates
  /// @param manifold made for the same trees and policy, else kManifoldMismatch; emptied where the
  ///                 status is another than kDone
  /// @param budget   ends the search early: then neither result nor manifold is complete, there are
  ///                 no contacts, and no force should be made of the sums. Contacts are made after
  ///                 the last look at the clock, in 15 ns a fixed leaf
  ///
  /// Cost: that of leaf_pairs(), and 3 to 5 ns a leaf pair, with points 10 to 15; on the scalar
  /// target 50.
  [[nodiscard]] QueryResult contacts(const Eigen::Isometry3d& pose, ContactManifold& manifold,
                                     const Budget& budget = {}) noexcept;

  /// Bounds the distance between the surfaces by an interval no wider than `tolerance`, or
  /// `narrowest` where that is more. A tolerance that is NaN or negative counts as 0.
  ///
  /// @param pose      maps moving mesh coordinates to fixed mesh coordinates
  /// @param tolerance mesh units
  /// @param budget    ends the search early: the interval is then wider
  ///
  /// The interval holds the true distance in any case; `complete` says whether the tolerance was
  /// reached. It is 0 where triangle_pairs() finds any. Bodies so far apart that float cannot tell
  /// their parts from each other keep the interval of their roots. The search begins with the
  /// triangles that were nearest last: so the ends may be others after other questions, unless the
  /// tolerance is 0. docs/guarantees.md gives the rounding of each bound and how fast the distance
  /// can change with the pose. Cost: 0.02 to 0.35 ms for two jaws that touch or are millimetres
  /// apart, up to 60 ms where they are a kilometre apart; without triangles 0.1 to 0.7 ms.
  [[nodiscard]] DistanceResult distance(const Eigen::Isometry3d& pose, double tolerance,
                                        const Budget& budget = {}) noexcept;

  /// Returns whether both trees have triangles.
  [[nodiscard]] bool has_triangles() const noexcept;

  /// Finds all pairs of triangles that have a point in common, exactly. A moved vertex is rounded
  /// to double first. kNoTriangles where has_triangles() is false.
  ///
  /// @param pose   maps moving mesh coordinates to fixed mesh coordinates
  /// @param out    takes the pairs, sorted by fixed and then by moving triangle; where it is too
  ///               short, the first of them
  /// @param budget ends the search early: the result then holds the pairs found so far
  ///
  /// Cost: 0.1 to 0.2 µs a pair that meets, of jaws that are closed. It does not depend on the
  /// voxels.
  [[nodiscard]] TrianglePairsResult triangle_pairs(const Eigen::Isometry3d& pose,
                                                   std::span<TrianglePair> out,
                                                   const Budget& budget = {}) noexcept;

  /// Forgets what earlier questions left behind: the triangles that met or were nearest last, and
  /// the pairs of a front. The next answers are those of a new query. Does nothing while another
  /// thread is using the query.
  void forget() noexcept;

  /// The fixed tree, which shares its content with the caller's.
  [[nodiscard]] const SphereTree& fixed() const noexcept;
  /// The moving tree, which shares its content with the caller's.
  [[nodiscard]] const SphereTree& moving() const noexcept;
  /// The bounds in use.
  [[nodiscard]] SpherePolicy policy() const noexcept;
  /// The instruction set in use.
  [[nodiscard]] const char* target() const noexcept;
  /// The threads that search, 1 or 2.
  [[nodiscard]] int workers() const noexcept;
  /// Bytes reserved.
  [[nodiscard]] std::size_t bytes() const noexcept;

  /// How often the second worker helped; all zero with one worker.
  [[nodiscard]] Sharing sharing() const noexcept;

 private:
  std::unique_ptr<detail::QueryState> state_;
};

/// The one of two bodies that lies inside the other; their surfaces do not intersect.
enum class Inside : std::uint8_t {
  kNone,    ///< neither, or only some components
  kFixed,   ///< the fixed body
  kMoving,  ///< the moving body
};
/// Returns "none", "fixed" or "moving".
[[nodiscard]] IST_API const char* to_string(Inside inside) noexcept;

/// Finds which body lies inside the other: by a point of each component of one body, and the
/// winding number of the other body round that point. Both meshes must outlive the test.
class IST_API InsideTest {
 public:
  /// Finds the components of both meshes, and puts their triangles into trees. Throws
  /// kMeshNotFinite or kMeshBadIndex. Cost: 0.4 µs a triangle.
  InsideTest(const TriangleMesh& fixed, const TriangleMesh& moving);
  InsideTest(const TriangleMesh&&, const TriangleMesh&) = delete;
  InsideTest(const TriangleMesh&, const TriangleMesh&&) = delete;
  InsideTest(const TriangleMesh&&, const TriangleMesh&&) = delete;
  ~InsideTest();
  InsideTest(InsideTest&&) noexcept;  ///< the other may then only be assigned or destroyed
  InsideTest& operator=(InsideTest&&) noexcept;  ///< as the constructor

  /// Returns the body of which all components lie inside the other. Precondition: `pose` is rigid,
  /// and the surfaces do not intersect. Cost: some 3 µs for each component that lies in the
  /// bounding box of the other body.
  [[nodiscard]] Inside at(const Eigen::Isometry3d& pose) const noexcept;

 private:
  std::unique_ptr<const detail::InsideState> state_;
};

}  // namespace ist
