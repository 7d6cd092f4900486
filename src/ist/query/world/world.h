#pragma once

#include <Eigen/Geometry>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "ist/base/api.h"
#include "ist/base/progress.h"
#include "ist/query/manifold.h"
#include "ist/query/query.h"
#include "ist/query/results.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

namespace detail {
struct WorldState;
}

/// The number of a body in a world, from 0 in the order of adding.
using BodyIndex = std::uint32_t;

/// The most bodies of a world.
inline constexpr BodyIndex kMostBodies = 4096;

/// Two bodies of a world, a < b in what a world returns: `a` is the fixed body of their query, `b`
/// the moving one.
struct BodyPair {
  BodyIndex a,  ///< the body added first
      b;        ///< the body added later

  /// Orders pairs by the first and then by the second body.
  friend auto operator<=>(const BodyPair&, const BodyPair&) = default;
};

/// The options of a World.
struct WorldOptions {
  QueryOptions query = {};        ///< of the query of each pair; with one worker
  ManifoldOptions manifold = {};  ///< of the manifold of each pair
  /// Pairs whose root bounds are no farther apart than this are near too, mesh units: at least 0
  /// and finite.
  double reach = 0;
  /// The most pairs that one answer lists beyond those that are prepared, some 800 bytes each.
  std::size_t most_near = 1 << 12;
  /// The most bytes to reserve for queries, manifolds and answers.
  std::uint64_t max_memory = std::uint64_t{4} << 30;
};

/// A pair of bodies that are near each other, and what their roots tell.
struct NearPair {
  BodyPair bodies{};  ///< a < b
  /// kDone; kNotPrepared for a pair without a query, or so far apart that no double holds the way
  /// from one to the other; kInvalidPose where a body has no valid pose.
  QueryStatus status = QueryStatus::kDone;
  /// The distance between the surfaces, as far as the root bounds tell it, mesh units; without a
  /// pose from 0 to the largest double.
  DistanceInterval roots{};
};
/// Whether two bodies of a pair intersect.
struct PairIntersection : NearPair {
  IntersectionResult result{};  ///< as Query::intersects gives it
};
/// The contacts of a pair.
struct PairContacts : NearPair {
  QueryResult result{};  ///< as Query::contacts gives it
  /// The contacts, until the next contacts() of the world; null where the pair was not asked.
  const ContactManifold* manifold = nullptr;
};
/// The leaf pairs of a pair.
struct PairLeaves : NearPair {
  QueryResult result{};  ///< as Query::leaf_pairs gives it
  std::span<const LeafPair> pairs =
      {};  ///< in the caller's span, sorted; the first where truncated
};
/// The pairs of triangles of a pair that intersect.
struct PairTriangles : NearPair {
  TrianglePairsResult result{};              ///< as Query::triangle_pairs gives it
  std::span<const TrianglePair> pairs = {};  ///< in the caller's span, sorted
};
/// The distance between two bodies of a pair.
struct PairDistance : NearPair {
  DistanceResult result{};  ///< as Query::distance gives it; the roots' interval where not asked
};

/// One answer for each pair that is near, in the order of BodyPair. All other pairs are apart: the
/// distance between their surfaces is over WorldOptions::reach.
template <class Pair>
struct WorldAnswer {
  /// kBusy; kNotPrepared before prepare(), or after another body was added: no pairs were looked
  /// for.
  QueryStatus status = QueryStatus::kDone;
  bool complete = true;              ///< every near pair is listed, and its answer is complete
  bool truncated = false;            ///< more pairs are near than fit: the first of them are listed
  std::uint64_t near_pairs = 0;      ///< all pairs that are near, listed or not
  std::uint64_t sphere_tests = 0;    ///< of all pairs, as Budget::tests counts them
  std::span<const Pair> pairs = {};  ///< until the next call of the same verb
};

/// The least distance between any two bodies of a world that are not ignored.
struct WorldDistance {
  /// As for WorldAnswer; kInvalidPose where a body has no valid pose: the interval is then that of
  /// the other bodies.
  QueryStatus status = QueryStatus::kDone;
  bool complete = false;  ///< the interval is no wider than the tolerance, and counts all pairs
  /// Holds the least distance, mesh units. Both ends are the largest double where no pair counts;
  /// [0, infinity] without an answer.
  DistanceInterval distance{0, std::numeric_limits<double>::infinity()};
  std::optional<BodyPair> nearest = std::nullopt;  ///< the pair with the least upper end
  std::uint64_t sphere_tests = 0;                  ///< of all pairs, as Budget::tests counts them
  /// The pairs that may be nearest by their roots, in the order of BodyPair, until the next call;
  /// those that need not be asked have the interval of their roots.
  std::span<const PairDistance> pairs = {};
};

/// Some bodies, each at a pose, and the queries of their pairs. A broad phase over the roots'
/// bounds finds the pairs that are near; each of them is asked as a Query is, in the order of
/// BodyPair. Lengths are in mesh units, one for all bodies; poses map mesh coordinates of a body to
/// the world's.
///
/// The answer of a pair is that of a Query of its two bodies at pose_of(a, b), bit by bit. Its
/// `rotation_error` is the larger one of the poses that both bodies were given. Which
/// pairs are near and in which order they are listed depends on the poses alone, and on no earlier
/// ones. What a query keeps (QueryOptions::front_pairs, and the triangles that were nearest last)
/// each pair keeps for itself.
///
/// A budget is one for the whole call. Tests are given to pairs in their order, so the first may
/// take all: add the bodies that matter most first. Beyond the budget stand the broad phase, and
/// one test of the roots for each pair that is near. With a limit of tests alone the answer is the
/// same on every machine. A pair that the budget did not reach is incomplete, and has the interval
/// of its roots.
///
/// add(), ignore() and prepare() allocate; all other members are noexcept, allocate nothing, lock
/// nothing and make no system call. A world shares the content of its trees, and belongs to one
/// thread at a time: a verb that finds another thread in it gives kBusy.
class IST_API World {
 public:
  /// Throws kArgumentInvalid for an option out of range, kTargetMissing, std::bad_alloc.
  explicit World(const WorldOptions& options = {});
  ~World();
  World(World&&) noexcept;             ///< the other may then only be assigned or destroyed
  World& operator=(World&&) noexcept;  ///< as the constructor

  /// Adds a body and returns its number. Verbs give kNotPrepared until the next prepare().
  ///
  /// @param tree shared by content
  /// @param pose maps mesh coordinates to the world's
  /// @param name names the body in errors; if empty, `body` and its number do
  ///
  /// Throws kPolicyMissing where the tree lacks the bounds of the options, kPoseInvalid,
  /// kArgumentInvalid beyond kMostBodies and for a tree in another frame of a patient than an
  /// earlier one, std::bad_alloc.
  BodyIndex add(const SphereTree& tree,
                const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity(),
                std::string name = {});
  BodyIndex add(const SphereTree&&, const Eigen::Isometry3d& = {}, std::string = {}) = delete;

  /// Never looks at a pair again, and frees its query. Throws kArgumentInvalid where a body is not
  /// there, or both are the same.
  void ignore(BodyIndex a, BodyIndex b);

  /// Returns the bytes of the query and the manifold of a pair, prepared or not, as Query::bytes
  /// and ContactManifold::bytes count them. Throws kArgumentInvalid, and what the constructors of
  /// both throw. Cost: some 10 µs.
  [[nodiscard]] std::uint64_t bytes_for(BodyIndex a, BodyIndex b) const;
  /// Returns the bytes that prepare() takes in all, what is reserved already counted too. Cost: as
  /// bytes_for(), for each pair.
  [[nodiscard]] std::uint64_t bytes_needed() const;
  /// Returns the bytes that prepare(pairs) takes in all.
  [[nodiscard]] std::uint64_t bytes_needed(std::span<const BodyPair> pairs) const;

  /// Reserves a query and a manifold for each pair that is not ignored, and the room for answers.
  /// Throws kMemoryLimit before anything is reserved, naming the pair that is too much; and what
  /// the constructors of both throw: then the world is as it was. Cost: 0.1 to 4 ms a pair.
  void prepare();
  /// Does so for these pairs alone. Pairs that have a query and are among them keep it with what it
  /// knows; those that are not lose it, once all others are there. Throws kArgumentInvalid too, for
  /// a pair that is ignored, or of bodies that are not there.
  void prepare(std::span<const BodyPair> pairs);
  /// Does so for some pairs, or for all without them, and can be followed and ended.
  ///
  /// @param pairs   as above; nothing: all that are not ignored
  /// @param proceed asked before each pair; where it says no, kCancelled is thrown, and the world
  ///                is as it was
  void prepare(std::optional<std::span<const BodyPair>> pairs, const Proceed& proceed);

  /// Moves a body. Returns kInvalidPose where `pose` is no rigid motion: the pairs of this body
  /// then have that status until its next pose. kNoSuchBody, or kBusy, change nothing.
  QueryStatus set_pose(BodyIndex body, const Eigen::Isometry3d& pose) noexcept;

  /// Lists the pairs that are near, without asking any. Cost: 20 ns a body, 0.5 µs a pair that is
  /// near; if no body was moved since the last verb, none.
  [[nodiscard]] WorldAnswer<NearPair> near_pairs() noexcept;
  /// Tests of each pair that is near whether the bodies intersect.
  [[nodiscard]] WorldAnswer<PairIntersection> intersects(const Budget& budget = {}) noexcept;
  /// Finds the contacts of each pair that is near, each in a manifold of its own.
  [[nodiscard]] WorldAnswer<PairContacts> contacts(const Budget& budget = {}) noexcept;
  /// Finds the leaf pairs of each pair that is near.
  ///
  /// @param out    takes the leaf pairs of one pair after the other
  /// @param budget of the whole call
  [[nodiscard]] WorldAnswer<PairLeaves> leaf_pairs(std::span<LeafPair> out,
                                                   const Budget& budget = {}) noexcept;
  /// Finds the pairs of triangles that intersect, of each pair that is near.
  ///
  /// @param out    takes them, of one pair after the other
  /// @param budget of the whole call
  [[nodiscard]] WorldAnswer<PairTriangles> triangle_pairs(std::span<TrianglePair> out,
                                                          const Budget& budget = {}) noexcept;
  /// Bounds the distance of each pair that is near, to a tolerance in mesh units.
  [[nodiscard]] WorldAnswer<PairDistance> distances(double tolerance,
                                                    const Budget& budget = {}) noexcept;
  /// Bounds the least distance of all pairs, near or not, to a tolerance in mesh units. Asks pairs
  /// by their roots' lower ends, the nearest first, until no other can matter; pairs without a
  /// query count with their roots.
  [[nodiscard]] WorldDistance distance(double tolerance, const Budget& budget = {}) noexcept;

  /// Forgets what earlier questions left in the queries.
  void forget() noexcept;

  /// Returns the pose at which a pair is asked: from mesh coordinates of `b` to those of `a`, after
  /// both poses were projected to rigid motions. It is composed in twice the precision of double
  /// and rounded once, so that the place of the bodies in the world does not matter. Nothing where
  /// a body is not there or has no valid pose.
  [[nodiscard]] std::optional<Eigen::Isometry3d> pose_of(BodyIndex a, BodyIndex b) const noexcept;
  /// The query of a pair, or null where it has none. What it is asked counts as an earlier
  /// question.
  [[nodiscard]] Query* query(BodyIndex a, BodyIndex b) noexcept;
  /// The number of bodies.
  [[nodiscard]] BodyIndex body_count() const noexcept;
  /// The name of a body; empty where it is not there.
  [[nodiscard]] std::string_view name(BodyIndex body) const noexcept;
  /// Bytes reserved for queries, manifolds and answers.
  [[nodiscard]] std::uint64_t bytes() const noexcept;

 private:
  std::unique_ptr<detail::WorldState> state_;
};

}  // namespace ist
