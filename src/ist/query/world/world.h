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

/// Two bodies of a world. A world returns them with a < b: `a` is the fixed body of their query,
/// and `b` the moving one.
struct BodyPair {
  BodyIndex a,  ///< the body added first
      b;        ///< the body added later

  /// Orders pairs by the first and then by the second body.
  friend auto operator<=>(const BodyPair&, const BodyPair&) = default;
};

/// The most threads of a world.
inline constexpr std::size_t kMostThreads = 16;

/// A number of near pairs: all of the world.
inline constexpr std::size_t kAllPairs = std::numeric_limits<std::size_t>::max();

/// The options of a World.
struct WorldOptions {
  /// Of the query of each pair; with one worker. `near_pairs` has no effect.
  QueryOptions query = {};
  ManifoldOptions manifold = {};  ///< of the manifold of each pair
  /// A pair is near if the distance of its root bounds is at most this, mesh units: at least 0 and
  /// finite.
  double reach = 0;
  /// The threads that ask pairs, 1 to kMostThreads: the caller's, and resident threads that help
  /// if they can. The answer does not depend on it. Leaf pairs, pairs of triangles, questions with
  /// a budget of tests, and distance() take the caller's thread alone.
  std::size_t threads = 1;
  /// The most pairs that have a pair cache at a time, if `query.front_pairs` is over 0. A pair gets
  /// one if the question before asked for its leaf pairs or contacts too, and it moved by less than
  /// half a voxel since. All others search.
  std::size_t pair_caches = 16;
  /// The most bytes to reserve.
  std::uint64_t max_memory = std::uint64_t{4} << 30;
};

/// A question to all pairs of bodies that are near each other.
struct WorldQuestion {
  /// The verb of Query that each pair is asked by.
  enum Kind : std::uint8_t {
    kNear,           ///< none: the answer lists the pairs, with the distance of their roots
    kIntersects,     ///< Query::intersects
    kContacts,       ///< Query::contacts, each pair with a manifold of its own
    kLeafPairs,      ///< Query::leaf_pairs
    kTrianglePairs,  ///< Query::triangle_pairs
    kDistance,       ///< Query::distance
  };
  Kind kind = kNear;     ///< the verb
  double tolerance = 0;  ///< of kDistance: the interval is to be no wider, mesh units
  /// Of kLeafPairs: takes the leaf pairs, sorted, of one pair of bodies after the other.
  std::span<LeafPair> leaf_pairs = {};
  /// Of kTrianglePairs: takes the pairs of triangles in the same way.
  std::span<TrianglePair> triangle_pairs = {};
};

/// The answer of a pair of bodies that are near each other; lengths in mesh units. A member that
/// names kinds of questions keeps its default after the others.
struct WorldPair {
  BodyPair bodies{};  ///< a < b
  /// kDone; kNotPrepared if the bodies are so far apart that no double holds the way from one to
  /// the other; kInvalidPose if a body has no valid pose; else as the query gives it.
  QueryStatus status = QueryStatus::kDone;
  Answer answer = Answer::kUnknown;  ///< kIntersects: exact where both trees have triangles
  bool complete = false;      ///< no budget ended the search; kDistance: within the tolerance
  bool truncated = false;     ///< kLeafPairs, kTrianglePairs: the span was too short for all
  Found way = Found::kFresh;  ///< kContacts, kLeafPairs: QueryResult::found
  int level = 0;              ///< kContacts, kLeafPairs: QueryResult::level
  /// The distance between the surfaces, as far as the root bounds tell it; without a pose from 0 to
  /// the largest double.
  DistanceInterval roots{};
  DistanceInterval distance{};  ///< as far as the question told it, or else the roots
  /// The nearest triangles, as DistanceResult has them, with points in world coordinates. Empty
  /// after other questions than kDistance and World::distance.
  std::optional<NearPair> nearest = std::nullopt;
  double narrowest = 0;            ///< kDistance: DistanceResult::narrowest
  double resolution = 0;           ///< the surfaces in a leaf pair are no farther apart; 0: unknown
  double pad = 0;                  ///< kContacts, kLeafPairs: QueryResult::pad
  std::uint64_t found = 0;         ///< leaf pairs, or of kTrianglePairs pairs of triangles
  std::uint64_t first = 0;         ///< the place of the first of them in the span of the question
  std::uint64_t written = 0;       ///< how many are there, from `first` on
  std::uint64_t sphere_tests = 0;  ///< as Budget::tests counts them
  double rotation_error = 0;       ///< the larger one of the poses that both bodies were given
  /// kContacts: World::manifold of the pair, or null if it was not asked or a body lacks voxels.
  const ContactManifold* manifold = nullptr;
};

/// The answers of all near pairs, in the order of BodyPair. All other pairs are apart: the distance
/// between their surfaces is over WorldOptions::reach.
struct WorldAnswer {
  /// kBusy; kNotPrepared before reserve(), or after another body was added: no pairs were looked
  /// for.
  QueryStatus status = QueryStatus::kDone;
  bool complete = true;  ///< every near pair is listed, and its answer is complete
  /// More pairs are near than were reserved for: the first of them are listed. The answer of the
  /// others is unknown.
  bool truncated = false;
  std::uint64_t near_pairs = 0;           ///< all pairs that are near, listed or not
  std::uint64_t sphere_tests = 0;         ///< of all pairs, as Budget::tests counts them
  std::span<const WorldPair> pairs = {};  ///< until the next ask() or reserve() of the world
};

/// The least distance between any two bodies of a world that are not ignored.
struct WorldDistance {
  /// As for WorldAnswer. kInvalidPose if a body has no valid pose; the interval then holds the
  /// distance of the other bodies.
  QueryStatus status = QueryStatus::kDone;
  bool complete = false;  ///< the interval is no wider than the tolerance, and counts all pairs
  /// Holds the least distance, mesh units. Both ends are the largest double if no pair counts;
  /// [0, infinity] without an answer.
  DistanceInterval distance{0, std::numeric_limits<double>::infinity()};
  /// The pair with the least upper end. Its WorldPair in `pairs` has the nearest points, if the
  /// tolerance asked for them.
  std::optional<BodyPair> nearest = std::nullopt;
  std::uint64_t sphere_tests = 0;  ///< of all pairs, as Budget::tests counts them
  /// The pairs that may be nearest by their roots, in the order of BodyPair, until the next call;
  /// those that need not be asked have the interval of their roots.
  std::span<const WorldPair> pairs = {};
};

/// Bodies at poses. A broad phase over the roots' bounds finds the pairs that are near. Each of
/// them is asked as a Query is, in the order of BodyPair. Lengths are in mesh units, one for all
/// bodies; poses map mesh coordinates of a body to the world's.
///
/// A Query of the two bodies of a pair at pose_of(a, b) gives the same answer, bit by bit. The list
/// of near pairs and its order depend on the poses alone, and on no earlier ones. A pair keeps the
/// triangles that met or were nearest last as long as every question but kNear asks it.
///
/// All pairs share one query a thread. A pair takes memory while it is near.
///
/// A budget is one for the whole call. Tests are given to pairs in their order, so the first may
/// take all: add the bodies that matter most first. Beyond the budget stand the broad phase, and
/// one test of the roots for each pair that is near. With a limit of tests alone the answer is the
/// same on every machine. A pair that the budget did not reach is incomplete, and has the interval
/// of its roots.
///
/// add(), ignore() and reserve() allocate; all other members are noexcept, allocate nothing, lock
/// nothing and make no system call. With several threads a call may wait for pairs that another
/// thread has begun. A world shares the content of its trees, and belongs to one
/// thread at a time: a verb that finds another thread in it gives kBusy.
class IST_API World {
 public:
  /// Throws kArgumentInvalid for an option out of range, kTargetMissing, std::bad_alloc.
  explicit World(const WorldOptions& options = {});
  ~World();
  World(World&&) noexcept;             ///< the other may then only be assigned or destroyed
  World& operator=(World&&) noexcept;  ///< as the constructor

  /// Adds a body and returns its number. Verbs give kNotPrepared until the next reserve().
  ///
  /// @param tree shared by content
  /// @param pose maps mesh coordinates to the world's
  /// @param name names the body in errors; if empty, `body` and its number do
  ///
  /// Throws kPolicyMissing if the tree lacks the bounds of the options, kPoseInvalid,
  /// kArgumentInvalid beyond kMostBodies and for a tree in another unit, or another frame of a
  /// patient, than an earlier one, kMemoryLimit for a tree that is too large to be searched,
  /// std::bad_alloc.
  ///
  /// Cost: 0.5 µs; for the first body of a tree 10 ns a triangle and 1 ns a node.
  BodyIndex add(const SphereTree& tree,
                const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity(),
                std::string name = {});

  /// Never looks at a pair again. Throws kArgumentInvalid if a body is not there, or both are the
  /// same; std::bad_alloc.
  void ignore(BodyIndex a, BodyIndex b);

  /// Returns the bytes that reserve(near_pairs) takes.
  [[nodiscard]] std::uint64_t bytes_needed(std::size_t near_pairs = kAllPairs) const;
  /// Reserves memory for all bodies, and for so many pairs that are near at a time: at least for
  /// one. If more are near, an answer lists the first of them. Frees what was reserved before, and
  /// forgets earlier questions.
  ///
  /// Throws kMemoryLimit beyond WorldOptions::max_memory, kArgumentInvalid for a manifold option
  /// out of range, std::bad_alloc: then the world is as it was. Cost: some milliseconds, and 1 µs a
  /// pair.
  void reserve(std::size_t near_pairs = kAllPairs);

  /// Moves a body. Returns kInvalidPose if `pose` is no rigid motion: the pairs of this body
  /// then have that status until its next pose. kNoSuchBody, or kBusy, change nothing.
  QueryStatus set_pose(BodyIndex body, const Eigen::Isometry3d& pose) noexcept;

  /// Asks each pair that is near a question.
  ///
  /// @param question names the verb of Query, and has its tolerance or its span
  /// @param budget   of the whole call; kNear needs none
  ///
  /// Cost: 20 ns a body and 0.5 µs a near pair if a body was moved since the last verb; then what
  /// each pair's query costs.
  [[nodiscard]] WorldAnswer ask(const WorldQuestion& question, const Budget& budget = {}) noexcept;
  /// Returns the contacts that the last question of kContacts found for a pair, until the next such
  /// question, reserve() or ignore(). Null if it did not ask the pair.
  [[nodiscard]] const ContactManifold* manifold(BodyIndex a, BodyIndex b) const noexcept;
  /// Bounds the least distance of all pairs, near or not, to a tolerance in mesh units. Asks pairs
  /// by their roots' lower ends, the nearest first, until no other can matter. Pairs that were not
  /// reserved for count with their roots.
  [[nodiscard]] WorldDistance distance(double tolerance, const Budget& budget = {}) noexcept;

  /// Forgets what earlier questions left in the queries.
  void forget() noexcept;

  /// Returns the pose at which a pair is asked: from mesh coordinates of `b` to those of `a`, after
  /// both poses were projected to rigid motions. It is composed in twice the precision of double
  /// and rounded once, so that the place of the bodies in the world does not matter. Returns
  /// nothing if a body is not there or has no valid pose.
  [[nodiscard]] std::optional<Eigen::Isometry3d> pose_of(BodyIndex a, BodyIndex b) const noexcept;
  /// Returns the number of bodies.
  [[nodiscard]] BodyIndex body_count() const noexcept;
  /// Returns the name of a body; empty if it is not there.
  [[nodiscard]] std::string_view name(BodyIndex body) const noexcept;
  /// Returns the bytes that reserve() took.
  [[nodiscard]] std::uint64_t bytes() const noexcept;

 private:
  std::unique_ptr<detail::WorldState> state_;
};

}  // namespace ist
