#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "ist/query/contacts/contact_visitor.h"
#include "ist/query/pair_cache/cache_filler.h"
#include "ist/query/pair_cache/cache_schedule.h"
#include "ist/query/pair_cache/motion_bound.h"
#include "ist/query/pair_cache/pair_cache.h"
#include "ist/query/pair_cache/pose_track.h"
#include "ist/query/workers/resident_worker.h"

namespace ist {

struct CacheOptions {
  std::size_t frontier_pairs, front_pairs;
  int workers;
  std::chrono::nanoseconds period;
};

/// Carries a cache of leaf pairs from one pose to the next. No other pairs can overlap while the
/// motion since the cache was made stays within its slack, so only its pairs are tested again. An
/// empty cache is a clearance. The next cache is made a few ticks ahead, by the resident worker or
/// in parts that are limited in tests. PairCache has a drawing of the states.
///
/// An answer is the set of leaf pairs whose bounds overlap. It is the same with a cache and
/// without.
class CachedSearch {
 public:
  CachedSearch(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
               const SearchPlan& plan, const Kernels& kernels, const CacheOptions& options,
               std::size_t items = 0);
  ~CachedSearch();
  CachedSearch(const CachedSearch&) = delete;
  CachedSearch& operator=(const CachedSearch&) = delete;

  /// Call after the plan was made anew, for other trees: forgets all poses and both caches.
  /// Allocates nothing. Precondition: it was made for one worker, with Search::items_for() the
  /// plan.
  void bind(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
            const MotionBound& bound) noexcept;

  /// A cache that holds all leaf pairs of a pose.
  struct CacheAt {
    const PairCache* cache = nullptr;  ///< null if a fresh search must answer
    std::uint64_t tests = 0;           ///< made at this pose to find it
    double motion = 0;                 ///< since the cache's centre, mesh units
    double upper = 0;                  ///< bounds the distance if the cache is empty, mesh units
  };
  /// Begins a tick. Bounds that are no farther apart than `margin` count as overlapping. The budget
  /// must have no limit of tests.
  [[nodiscard]] CacheAt find(const RelativePose& pose, double margin,
                             const Budget& budget) noexcept;
  /// Ends a tick that had a complete answer, and goes on with the next cache. `tests` counts the
  /// tests of the searches of this tick: 0 if a cache answered without any. The budget must have no
  /// limit of tests.
  void prepare(const RelativePose& pose, double margin, std::uint64_t leaf_pairs,
               std::uint64_t tests, const Budget& budget) noexcept;

  /// Tests the pairs of a pair cache again, and passes on the pairs that overlap, in order. Returns
  /// whether all were tested: neither the deadline nor the sink ended it.
  template <class Sink>
  [[nodiscard]] bool pass_on(const PairCache& cache, const SearchPose& pose, const Budget& budget,
                             Sink& sink) noexcept;
  /// Forgets all poses and both caches. Does not wait for the worker.
  void forget() noexcept;
  /// Returns the bytes that a search with these options reserves.
  [[nodiscard]] static std::size_t bytes_for(const SearchPlan& plan, const CacheOptions& options,
                                             std::size_t items = 0) noexcept;

 private:
  using State = PairCache::State;

  [[nodiscard]] double upper_at(const PairCache& cache, const RelativePose& pose) const noexcept;
  // Returns the motion from a cache's centre to `pose`, or nothing if the cache may lack a pair.
  [[nodiscard]] std::optional<double> motion_to(const PairCache& cache, const RelativePose& pose,
                                                double need) const noexcept;
  void pass_on(const CacheLanes& cache, std::size_t begin, std::size_t end,
               LeafPairSink& sink) noexcept;
  void pass_on(const CacheLanes& cache, std::size_t begin, std::size_t end,
               ContactOutput& sink) noexcept;

  // The transitions of PairCache::State, in the order of its drawing. The worker must not be busy,
  // except in forget().
  void want(State by, const RelativePose& centre, double extent, std::uint64_t most_tests) noexcept;
  void want_next(const RelativePose& pose, double need) noexcept;
  void advance(const Budget& budget) noexcept;
  void settle() noexcept;
  [[nodiscard]] bool take_up(const RelativePose& pose, double need) noexcept;
  void give_up_if_full() noexcept;

  [[nodiscard]] PairCache& kept() noexcept { return caches_[kept_]; }
  [[nodiscard]] PairCache& next() noexcept { return caches_[1 - kept_]; }
  [[nodiscard]] bool is_searching() noexcept {
    return next().state == State::kAhead || next().state == State::kAtOnce;
  }
  [[nodiscard]] bool may_fit() const noexcept;

  const SearchPlan& plan_;
  const Kernels& kernels_;
  TreeLengths fixed_, moving_;
  MotionBound bound_;
  PoseTrack track_;
  PairCache caches_[2];
  std::size_t kept_ = 0;  // the other cache is the next one
  CacheFiller search_;    // for the next cache; the worker's while the job is busy
  CacheRowMemory rows_;
  CacheSchedule schedule_;
  std::uint64_t last_pairs_ = 0;    // of the last answer
  std::uint64_t search_tests_ = 0;  // of the last search that was whole
  std::chrono::nanoseconds period_;
  Job job_;
  std::optional<ResidentWorker> worker_;
};

}  // namespace ist
