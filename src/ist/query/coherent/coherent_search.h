#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "ist/query/coherent/front.h"
#include "ist/query/coherent/front_schedule.h"
#include "ist/query/coherent/front_search.h"
#include "ist/query/coherent/motion_bound.h"
#include "ist/query/coherent/pose_track.h"
#include "ist/query/contacts/contact_visitor.h"
#include "ist/query/workers/resident_worker.h"

namespace ist {

struct CoherentOptions {
  std::size_t frontier_pairs, front_pairs;
  int workers;
  std::chrono::nanoseconds period;
};

/// Carries a front of leaf pairs from one pose to the next. While the motion since the front was
/// made stays within its slack, its pairs are all that can overlap, and need only be tested again;
/// an empty front is a clearance. The next front is made a few ticks ahead, in parts that are
/// counted in tests, or by the resident worker.
///
/// Nothing here changes an answer: that is the set of leaf pairs whose bounds overlap, however it
/// is found.
class CoherentSearch {
 public:
  CoherentSearch(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                 const SearchPlan& plan, const Kernels& kernels, const CoherentOptions& options);
  ~CoherentSearch();
  CoherentSearch(const CoherentSearch&) = delete;
  CoherentSearch& operator=(const CoherentSearch&) = delete;

  /// A front that holds all leaf pairs of a pose.
  struct FrontAt {
    const Front* front = nullptr;  ///< null where a fresh search is to answer
    std::uint64_t tests = 0;       ///< made at this pose to find it
    double motion = 0;             ///< since the front's centre, mesh units
    double upper = 0;              ///< of an empty one: bounds the distance, mesh units
  };
  /// Begins a tick, at a pose where bounds no farther apart than `margin` count. The budget must
  /// have no limit of tests.
  [[nodiscard]] FrontAt find(const RelativePose& pose, double margin,
                             const Budget& budget) noexcept;
  /// Ends a tick that had an answer, found by as many tests of a search: goes on with the next
  /// front. The budget must have no limit of tests.
  void prepare(const RelativePose& pose, double margin, std::uint64_t leaf_pairs,
               std::uint64_t tests, const Budget& budget) noexcept;

  /// Tests the pairs of a front again and passes on those that overlap, in order. Returns whether
  /// that came to its end: neither the deadline nor the sink ended it.
  template <class Sink>
  [[nodiscard]] bool pass_on(const Front& front, const SearchPose& pose, const Budget& budget,
                             Sink& sink) noexcept;
  /// Begins afresh, as if there had been no pose. Does not wait for the worker.
  void forget() noexcept;
  /// Returns the bytes that a search with these options reserves.
  [[nodiscard]] static std::size_t bytes_for(const SearchPlan& plan,
                                             const CoherentOptions& options) noexcept;

 private:
  [[nodiscard]] double upper_at(const Front& front, const RelativePose& pose) const noexcept;
  // Returns the motion of a front's centre to `pose`, or nothing where it may lack a pair.
  [[nodiscard]] std::optional<double> motion_to(const Front& front, const RelativePose& pose,
                                                double need) const noexcept;
  [[nodiscard]] bool adopt(const RelativePose& pose, double need) noexcept;
  void pass_on(const FrontLanes& front, std::size_t begin, std::size_t end,
               LeafPairSink& sink) noexcept;
  void pass_on(const FrontLanes& front, std::size_t begin, std::size_t end,
               ContactOutput& sink) noexcept;
  void want(const RelativePose& centre, double extent, std::uint64_t most_tests) noexcept;
  void want_next(const RelativePose& pose, double need) noexcept;
  void give_up_where_full() noexcept;
  void drop_stale() noexcept;
  [[nodiscard]] bool may_fit() const noexcept;

  const SearchPlan& plan_;
  const Kernels& kernels_;
  TreeLengths fixed_, moving_;
  MotionBound bound_;
  PoseTrack track_;
  Front fronts_[2];
  Front *kept_ = fronts_, *next_ = fronts_ + 1;
  bool holds_ = false;  // kept_ is whole
  bool stale_ = false;  // the next front was forgotten while the worker was busy with it
  FrontSearch search_;  // for next_; the worker's while the job is busy
  FrontRowMemory rows_;
  FrontSchedule schedule_;
  bool at_once_ = false;            // the next front was to be made within a tick
  std::uint64_t last_pairs_ = 0;    // of the last answer
  std::uint64_t search_tests_ = 0;  // of the last search that was whole
  std::chrono::nanoseconds period_;
  Job job_;
  std::optional<ResidentWorker> worker_;
};

}  // namespace ist
