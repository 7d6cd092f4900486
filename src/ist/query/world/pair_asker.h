#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/query_state.h"
#include "ist/query/world/pair_memory.h"

namespace ist::detail {

/// A body as its pairs are asked.
struct AskedBody {
  const SphereTree& tree;
  const TreeFacts& facts;
};

/// The greatest sizes of the bodies of a world. A query of these sizes can be bound to any pair.
struct AskerRoom {
  /// Measures the bodies. Cost: 0.1 µs for each pair of different depths or voxel sizes.
  static AskerRoom of(std::span<const AskedBody> bodies, const WorldOptions& options);

  const SphereTree* any = nullptr;  ///< one of the trees, without voxels if any has none
  QueryRoom query;
  std::size_t leaves = 1;  ///< that a ContactWork keeps apart

  /// Returns whether two bodies have voxels: else no pair is asked about leaves.
  [[nodiscard]] bool has_leaves() const noexcept { return query.voxels != nullptr; }
};

/// The pair cache of a pair that moves slowly.
struct CacheSlot {
  /// Precondition: room.has_leaves(), for bytes_for() too.
  CacheSlot(const AskerRoom& room, const WorldOptions& options);
  [[nodiscard]] static std::uint64_t bytes_for(const AskerRoom& room, const WorldOptions& options);

  void bind(BodyPair pair, const AskedBody& a, const AskedBody& b, SpherePolicy policy) noexcept;

  BodyPair bodies{};
  std::uint64_t leaf_tick = 0;  // of its last question; 0 if it is free
  SearchPlan plan;
  CachedSearch cached;
};

/// The pair caches of a world. A pair gets one if it was asked about leaf pairs in the question
/// before, and moved little since, until another pair has it.
class CacheSlots {
 public:
  CacheSlots() = default;
  /// Reserves all memory.
  CacheSlots(std::size_t count, const AskerRoom& room, const WorldOptions& options);

  /// Begins a question about leaf pairs.
  void begin() noexcept {
    ++leaf_tick_;
    next_ = 0;
  }
  /// Notes that a pair is asked now. Call it for one pair after the other.
  void note(PairMemory& memory, const BodyPose& pose, const AskedBody& a, const AskedBody& b,
            SpherePolicy policy) noexcept;
  /// Returns the cache of a pair that was noted, or null.
  [[nodiscard]] CachedSearch* of(const PairMemory& memory) noexcept {
    return owns(memory) ? &slots_[memory.slot]->cached : nullptr;
  }
  void forget() noexcept;

 private:
  [[nodiscard]] bool owns(const PairMemory& memory) const noexcept {
    return memory.slot < slots_.size() && slots_[memory.slot]->leaf_tick > 0 &&
           slots_[memory.slot]->bodies == memory.bodies;
  }

  std::vector<std::unique_ptr<CacheSlot>> slots_;
  std::uint64_t leaf_tick_ = 0;
  std::size_t next_ = 0;  // no slot before it is free
};

/// The query of one thread for all pairs, with memory to reduce contacts.
class PairAsker {
 public:
  PairAsker(const AskerRoom& room, const WorldOptions& options);
  [[nodiscard]] static std::uint64_t bytes_for(const AskerRoom& room, const WorldOptions& options);

  /// Returns the query, bound to a pair with its memory. Give the memory back by keep().
  ///
  /// @param of_leaves whether the question may search leaves
  /// @param cached    the pair cache of the pair, or null
  [[nodiscard]] Query& bind(const AskedBody& a, const AskedBody& b, const PairMemory& memory,
                            bool of_leaves, CachedSearch* cached) noexcept;
  /// Returns whether the pair can be asked about leaves.
  [[nodiscard]] bool has_leaves() const noexcept { return state_->has_leaves(); }
  /// Binds a manifold to the same pair. Precondition: has_leaves().
  void bind(ContactManifold& manifold) noexcept {
    reducer_of(manifold).bind(state_->fixed, state_->moving, state_->policy, *work_);
  }
  /// Saves the witnesses of the query in the memory of the pair.
  void keep(PairMemory& memory) const noexcept {
    if (state_->triangles != nullptr) memory.witnesses = state_->triangles->witnesses();
  }

 private:
  std::unique_ptr<ContactWork> work_;  // null if no pair is asked about leaves
  Query query_;
  QueryState* state_;  // of the query
};

}  // namespace ist::detail
