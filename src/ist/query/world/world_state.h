#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ist/base/float_environment.h"
#include "ist/query/query_state.h"
#include "ist/query/world/body_pose.h"
#include "ist/query/world/broad_phase.h"
#include "ist/query/world/world.h"

namespace ist {

/// The place of each pair's query, of all pairs of some bodies.
class PairTable {
 public:
  static constexpr std::uint32_t kNoQuery = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint32_t kIgnored = kNoQuery - 1;

  /// Adds a body, whose pairs with all others have no query.
  void add() {
    places_.insert(places_.end(), bodies_, kNoQuery);
    ++bodies_;
  }
  /// Precondition: a < b < the number of bodies.
  [[nodiscard]] std::uint32_t& operator[](BodyPair pair) noexcept { return places_[at(pair)]; }
  [[nodiscard]] std::uint32_t operator[](BodyPair pair) const noexcept { return places_[at(pair)]; }
  /// Takes all queries out.
  void clear() noexcept {
    std::replace_if(
        places_.begin(), places_.end(), [](auto at) { return at < kIgnored; }, kNoQuery);
  }
  /// Returns the number of all pairs, ignored or not.
  [[nodiscard]] std::size_t size() const noexcept { return places_.size(); }

 private:
  static std::size_t at(BodyPair pair) noexcept {
    return std::size_t{pair.b} * (pair.b - 1) / 2 + pair.a;
  }
  std::vector<std::uint32_t> places_;
  std::size_t bodies_ = 0;
};

/// A pair of bodies at their poses, for the world's own use.
struct PairAtPose {
  BodyPair bodies;
  QueryStatus status;      ///< as WorldPair has it before the pair is asked
  DistanceInterval roots;  ///< as WorldPair has it
  bool overlap;            ///< the roots are no farther apart than they need be to be near
  std::uint32_t place;     ///< of its query; PairTable::kNoQuery without one
  BodyPose pose;           ///< of the later body in the first one's coordinates
};

/// The pairs that are near, in bounded memory: where there is no room for all, those with a query
/// come before those without, and then the first by BodyPair. So it does not matter in which order
/// pairs are found.
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
    bool prepared;
    BodyPair bodies;
    std::uint32_t at;
  };
  static bool is_before(const Entry& a, const Entry& b) noexcept;

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
    std::string name;
    std::array<double, 16> given;  // the pose as it was given
    BodyPose pose;                 // projected
    double rotation_error;         // of the pose as it was given
  };
  /// The memory of a pair from call to call.
  struct PairMemory {
    PairMemory(BodyPair pair, const Body& a, const Body& b, const WorldOptions& options);
    BodyPair bodies;
    Query query;
    std::optional<ContactManifold> manifold;  // only of two bodies with voxels
    std::uint64_t felt = 0;  // the question of contacts that filled the manifold last
  };
  /// A pair that may be the nearest, by the balls of its bodies.
  struct Candidate {
    double lower;
    BodyPair bodies;
    friend auto operator<=>(const Candidate&, const Candidate&) = default;
  };
  /// The room for answers.
  struct Answers {
    Answers() = default;
    explicit Answers(std::size_t room);
    /// Returns the bytes that they reserve.
    static std::uint64_t bytes_for(std::size_t room) noexcept;
    std::size_t room = 0;
    NearSet near;
    std::vector<Candidate> candidates;
    std::vector<WorldPair> pairs, nearest;  // of ask(), of distance()
  };

  explicit WorldState(const WorldOptions& options);

  /// Returns a pair in order. Throws kArgumentInvalid for bodies that are
  /// not there, or the same.
  [[nodiscard]] BodyPair checked(BodyIndex a, BodyIndex b) const;
  /// Returns the pairs in their order, each once. Throws so for each of them, and for one
  /// that is ignored.
  [[nodiscard]] std::vector<BodyPair> checked(std::span<const BodyPair> pairs) const;
  /// Returns all pairs that are not ignored, in their order.
  [[nodiscard]] std::vector<BodyPair> all_pairs() const;
  /// Returns how many pairs one answer may list if so many are prepared.
  [[nodiscard]] std::size_t room_for(std::size_t prepared) const noexcept;
  /// Returns the bytes of the query and the manifold of a pair.
  [[nodiscard]] std::uint64_t bytes_of(BodyPair pair) const;
  /// Returns the bytes that prepare() takes for these pairs. Throws kMemoryLimit beyond `limit`,
  /// naming the pair that was too much.
  [[nodiscard]] std::uint64_t bytes_for(std::span<const BodyPair> pairs, std::uint64_t limit) const;
  /// `proceed` may be empty.
  void prepare(std::span<const BodyPair> pairs, const Proceed& proceed);

  void move(BodyIndex body, const Eigen::Isometry3d& pose) noexcept;
  [[nodiscard]] bool is_there(BodyIndex body) const noexcept { return body < bodies.size(); }
  /// Returns the larger rotation error of the poses that two bodies were given.
  [[nodiscard]] double rotation_error_of(BodyPair pair) const noexcept {
    return std::max(bodies[pair.a].rotation_error, bodies[pair.b].rotation_error);
  }
  /// Returns the memory of two bodies in either order, or null if they have none.
  [[nodiscard]] PairMemory* find(BodyIndex a, BodyIndex b) const noexcept {
    if (!is_there(a) || !is_there(b) || a == b) return nullptr;
    const std::uint32_t place = table[{std::min(a, b), std::max(a, b)}];
    return place < PairTable::kIgnored ? made[place].get() : nullptr;
  }
  /// Returns the query of a pair that is prepared.
  [[nodiscard]] PairMemory& memory(const PairAtPose& pair) noexcept { return *made[pair.place]; }
  /// Returns a pair at its poses.
  [[nodiscard]] PairAtPose look(BodyPair pair) const noexcept;
  /// Finds the pairs that are near, if a body was moved since.
  void find_near() noexcept;
  /// Lists the pairs that may be nearest, by their balls. Returns a lower bound of the distance of
  /// all others that are not farther than one of these.
  [[nodiscard]] double find_candidates() noexcept;

  WorldOptions options;
  std::vector<Body> bodies;
  BroadPhase broad;
  PairTable table;
  std::vector<std::unique_ptr<PairMemory>> made;  // by the table's places
  Answers answers;
  bool ready = false;      // the answers have room for these bodies
  bool stale = true;       // a body was moved since the last find_near()
  std::uint64_t felt = 1;  // counts questions of contacts, and what ends their contacts
  std::atomic_flag in_use;
};

}  // namespace ist::detail
