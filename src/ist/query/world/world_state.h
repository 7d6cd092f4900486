#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_set>
#include <vector>

#include "ist/base/float_environment.h"
#include "ist/query/query_state.h"
#include "ist/query/workers/resident_pool.h"
#include "ist/query/world/body_pose.h"
#include "ist/query/world/broad_phase.h"
#include "ist/query/world/pair_asker.h"
#include "ist/query/world/pair_memory.h"
#include "ist/query/world/world.h"

namespace ist {

/// The pairs that a world never looks at.
class IgnoredPairs {
 public:
  void add(BodyPair pair) { keys_.insert(key(pair)); }
  [[nodiscard]] bool has(BodyPair pair) const noexcept {
    return !keys_.empty() && keys_.count(key(pair)) > 0;
  }
  [[nodiscard]] std::size_t size() const noexcept { return keys_.size(); }

 private:
  static std::uint64_t key(BodyPair pair) noexcept { return std::uint64_t{pair.a} << 32 | pair.b; }
  std::unordered_set<std::uint64_t> keys_;
};

/// A pair of bodies at their poses, for the world's own use.
struct PairAtPose {
  BodyPair bodies;
  QueryStatus status;      ///< as WorldPair has it before the pair is asked
  DistanceInterval roots;  ///< as WorldPair has it
  bool overlap;            ///< the roots are no farther apart than they need be to be near
  BodyPose pose;           ///< of the later body in the first one's coordinates
};

/// The near pairs, in bounded memory. If there is no room for all, it keeps the first by BodyPair,
/// in whatever order they are added.
class NearSet {
 public:
  NearSet() = default;
  /// Reserves memory for so many pairs.
  explicit NearSet(std::size_t room) : room_(room) {
    pairs_.reserve(room);
    order_.reserve(room);
  }

  void clear() noexcept;
  void add(const PairAtPose& pair) noexcept;
  /// Ends the additions: sorts.
  void finish() noexcept;

  /// Returns the number of pairs added.
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// Returns the number of pairs kept.
  [[nodiscard]] std::size_t size() const noexcept { return order_.size(); }
  [[nodiscard]] const PairAtPose& operator[](std::size_t k) const noexcept {
    return pairs_[order_[k].at];
  }

 private:
  struct Entry {
    BodyPair bodies;
    std::uint32_t at;
    friend bool operator<(const Entry& a, const Entry& b) noexcept { return a.bodies < b.bodies; }
  };

  std::size_t room_ = 0;
  std::vector<PairAtPose> pairs_;
  std::vector<Entry> order_;  // while full a heap, with the last one on top
  std::uint64_t count_ = 0;
};

}  // namespace ist

namespace ist::detail {

/// The memory of a World, and the steps that its verbs share.
struct WorldState {
  struct Body {
    SphereTree tree;  // which shares the content
    const TreeFacts* facts;
    std::string name;
    std::array<double, 16> given;  // the pose as it was given
    BodyPose pose;                 // projected
    double rotation_error;         // of the pose as it was given
  };
  /// A pair that may be the nearest, by the balls of its bodies.
  struct Candidate {
    double lower;
    BodyPair bodies;
    friend auto operator<=>(const Candidate&, const Candidate&) = default;
  };
  /// A pair that the last question of contacts asked.
  struct Felt {
    BodyPair bodies;
    const ContactManifold* manifold;
  };
  /// The memory for a number of near pairs.
  struct Reserved {
    Reserved() = default;
    Reserved(std::size_t room, WorldState& world, const AskerRoom& sizes);

    std::size_t room = 0;  // for pairs; 0: nothing is reserved
    std::uint64_t bytes = 0;
    NearSet near;
    PairMemories memories;
    std::vector<Candidate> candidates;
    std::vector<WorldPair> pairs, nearest;   // of ask(), of distance()
    std::vector<ContactManifold> manifolds;  // by the places of near pairs
    std::vector<Felt> felt;                  // in the order of BodyPair
    CacheSlots slots;
    std::vector<std::unique_ptr<PairAsker>> askers;  // by thread
    std::unique_ptr<ResidentPool> pool;              // the last: its workers use all others
  };
  /// A question to near pairs, while it is asked.
  struct Round {
    WorldQuestion question;
    Budget budget;
  };

  explicit WorldState(const WorldOptions& options);

  /// Returns a pair in order. Throws kArgumentInvalid for bodies that are
  /// not there, or the same.
  [[nodiscard]] BodyPair checked(BodyIndex a, BodyIndex b) const;
  /// Returns for how many pairs reserve() makes room.
  [[nodiscard]] std::size_t room_for(std::size_t near_pairs) const noexcept;
  /// Returns the sizes of the bodies. Throws as require_answers().
  [[nodiscard]] AskerRoom sizes() const;
  /// Throws kVoxelsMissing if a pair can answer no question: see lacks_common().
  void require_answers() const;
  /// Returns the bytes that reserve() takes for `room` pairs. Throws kMemoryLimit beyond `limit`.
  [[nodiscard]] std::uint64_t bytes_for(std::size_t room, const AskerRoom& sizes,
                                        std::uint64_t limit) const;
  void reserve(std::size_t near_pairs);

  void move(BodyIndex body, const Eigen::Isometry3d& pose) noexcept;
  [[nodiscard]] bool is_there(BodyIndex body) const noexcept { return body < bodies.size(); }
  /// Returns the larger rotation error of the poses that two bodies were given.
  [[nodiscard]] double rotation_error_of(BodyPair pair) const noexcept {
    return std::max(bodies[pair.a].rotation_error, bodies[pair.b].rotation_error);
  }
  [[nodiscard]] AskedBody asked(BodyIndex body) const noexcept {
    return {bodies[body].tree, *bodies[body].facts};
  }
  /// Asks near pair `k` the question of the round.
  void ask_pair(std::size_t thread, std::size_t k, const Budget& budget) noexcept;
  /// Returns a pair at its poses.
  [[nodiscard]] PairAtPose look(BodyPair pair) const noexcept;
  /// Finds the pairs that are near, if a body was moved since.
  void find_near() noexcept;
  /// Lists the pairs that may be nearest, by their balls, in the order of BodyPair. Returns a lower
  /// bound of the distance of all others that are not farther than one of these.
  [[nodiscard]] double find_candidates() noexcept;

  WorldOptions options;
  std::map<const TreeParts*, TreeFacts> facts;  // by content
  std::vector<Body> bodies;
  std::optional<BodyIndex> with_frame, with_unit;  // the first bodies whose frame and unit is known
  BroadPhase broad;
  IgnoredPairs ignored;
  Round round;
  bool ready = false;  // these bodies are reserved for
  bool stale = true;   // a body was moved since the last find_near()
  std::atomic_flag in_use;
  Reserved reserved;  // the last: its workers use all others
};

}  // namespace ist::detail
