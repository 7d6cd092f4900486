#include "ist/query/coherent/coherent_search.h"

#include <algorithm>
#include <limits>
#include <type_traits>

#include "ist/query/traversal/search_pose.h"

namespace ist {
namespace {

// The pairs of a front that are tested between two looks at the clock.
constexpr std::size_t kPart = 2048;

constexpr double kUnknown = std::numeric_limits<double>::infinity();
constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

}  // namespace

CoherentSearch::CoherentSearch(const SphereTree& fixed, const SphereTree& moving,
                               SpherePolicy policy, const SearchPlan& plan, const Kernels& kernels,
                               const CoherentOptions& options)
    : plan_(plan),
      kernels_(kernels),
      fixed_(lengths_of(fixed, policy)),
      moving_(lengths_of(moving, policy)),
      bound_(fixed, moving, policy),
      fronts_{Front(options.front_pairs), Front(options.front_pairs)},
      search_(plan, kernels, options.frontier_pairs),
      rows_(options.front_pairs),
      schedule_(std::min(fixed.voxel_size(), moving.voxel_size()), options.workers == 2),
      period_(options.period),
      job_(
          [](void* self) noexcept {
            hand_over(HandOver::kClaimed);
            static_cast<CoherentSearch*>(self)->search_.advance({});
            hand_over(HandOver::kWorked);
          },
          this) {
  if (options.workers == 2) worker_.emplace();
}

CoherentSearch::~CoherentSearch() {
  if (!worker_) return;
  worker_->retract(job_);
  job_.wait_idle();
}

// Those two points whose distance was measured were near each other at the front's centre, and need
// not be at `pose`: so the motion is that from `pose` back to there.
double CoherentSearch::upper_at(const Front& front, const RelativePose& pose) const noexcept {
  if (!(front.upper < kUnknown)) return kUnknown;
  return front.upper + bound_.between(pose, front.centre, front.upper);
}

std::optional<double> CoherentSearch::motion_to(const Front& front, const RelativePose& pose,
                                                double need) const noexcept {
  const double motion = bound_.between(front.centre, pose, front.extent);
  if (need + motion <= front.extent) return motion;
  return std::nullopt;
}

// Takes up the next front, if it is whole and holds at `pose`.
bool CoherentSearch::adopt(const RelativePose& pose, double need) noexcept {
  if (search_.state() != FrontSearch::State::kDone || !motion_to(*next_, pose, need)) return false;
  std::swap(kept_, next_);
  holds_ = true;
  search_tests_ = search_.tests();
  search_.drop();
  schedule_.took_up(kept_->empty(), kept_->extent - need);
  return true;
}

CoherentSearch::FrontAt CoherentSearch::find(const RelativePose& pose, double margin,
                                             const Budget& budget) noexcept {
  if (worker_) worker_->tick(std::chrono::steady_clock::now(), period_);
  const double need = most_apart(pose, fixed_, moving_, margin);
  track_.add(pose, bound_, need);
  FrontAt found;
  const auto answer_from_kept = [&] {
    if (const auto motion = motion_to(*kept_, pose, need)) {
      found.front = kept_;
      found.motion = *motion;
      if (kept_->empty()) found.upper = upper_at(*kept_, pose);
    }
    return found.front != nullptr;
  };
  const bool busy = job_.busy();
  if (!busy) {
    drop_stale();
    static_cast<void>(adopt(pose, need));
  }
  if (holds_ && answer_from_kept()) return found;
  holds_ = false;
  if (busy) return found;

  // The next front may be half done, or was to be made at once and a deadline came between; or the
  // body is nearly at rest, and a front with little slack costs little more than a fresh search.
  const bool go_on = search_.state() == FrontSearch::State::kUnderWay &&
                     motion_to(*next_, pose, need) && search_.most_tests() == kNoLimit &&
                     (at_once_ || 2 * search_.tests() > search_tests_);
  if (!go_on) {
    const double slack = schedule_.slack_at_once();
    if (!schedule_.is_worth_at_once(slack, track_.speed()) || !may_fit()) return found;
    want(pose, need + slack, kNoLimit);
    at_once_ = true;
  }
  const std::uint64_t before = search_.tests();
  search_.advance(budget);
  found.tests = search_.tests() - before;
  give_up_where_full();
  if (adopt(pose, need)) answer_from_kept();
  return found;
}

void CoherentSearch::want(const RelativePose& centre, double extent,
                          std::uint64_t most_tests) noexcept {
  search_.begin(*next_, {centre, to_float(centre, fixed_, moving_, extent), extent,
                         last_pairs_ == 0 ? Measured::kUpper : Measured::kNothing, most_tests});
}

bool CoherentSearch::may_fit() const noexcept {
  return schedule_.may_fit(last_pairs_, kept_->lanes.pair_capacity);
}

void CoherentSearch::give_up_where_full() noexcept {
  if (search_.state() != FrontSearch::State::kFull) return;
  schedule_.was_full(search_.most_tests() != kNoLimit);  // a clearance has a limit of tests
  search_.drop();
}

// Begins the next front, if it is time for it and worth it.
void CoherentSearch::want_next(const RelativePose& pose, double need) noexcept {
  const Pace pace = track_.pace(bound_, need);
  const double slack = schedule_.slack(pace);
  const double reserve = FrontSchedule::reserve(kept_->extent - need, pace);
  if (holds_ &&
      motion_to(*kept_, track_.ahead(FrontSchedule::ticks_ahead(slack, pace)), need + reserve) &&
      !FrontSchedule::is_wasteful(kept_->extent - need, slack, kept_->lanes.pair_count,
                                  last_pairs_)) {
    return;
  }
  double beyond = slack;
  const bool apart = last_pairs_ == 0;
  if (apart) {
    const double far = holds_ && kept_->empty() ? upper_at(*kept_, pose) : kUnknown;
    const double leaves = 2 * (fixed_.largest_leaf + moving_.largest_leaf);
    beyond = std::max(slack, schedule_.clearance(far - leaves, need));
  }
  if (!schedule_.is_worth(beyond, pace.speed) || !may_fit()) return;
  at_once_ = false;
  want(track_.ahead(FrontSchedule::ticks_to_centre(beyond, pace)), need + beyond,
       apart ? FrontSchedule::most_for_clearance(search_tests_) : kNoLimit);
}

void CoherentSearch::prepare(const RelativePose& pose, double margin, std::uint64_t leaf_pairs,
                             std::uint64_t tests, const Budget& budget) noexcept {
  last_pairs_ = leaf_pairs;
  if (tests > 0 && !holds_) {
    search_tests_ = tests;
    schedule_.searched();
  }
  schedule_.tick();
  if (job_.busy() || budget.is_past()) return;
  drop_stale();
  give_up_where_full();
  using State = FrontSearch::State;
  const double need = most_apart(pose, fixed_, moving_, margin);
  if (search_.state() != State::kNone &&
      !motion_to(*next_, track_.ahead(FrontSchedule::kTicksAhead), need)) {
    search_.drop();  // the body went another way
  }
  if (search_.state() == State::kNone) want_next(pose, need);
  if (search_.state() != State::kUnderWay) return;
  if (worker_ && worker_->offer(job_)) return;
  search_.advance(budget.within(FrontSchedule::slice(search_tests_, tests > 0)));
}

template <class Sink>
bool CoherentSearch::pass_on(const Front& front, const SearchPose& pose, const Budget& budget,
                             Sink& sink) noexcept {
  if (front.empty()) return true;
  constexpr bool kSurfaces = std::is_same_v<Sink, ContactOutput>;
  kernels_.turn_front(front.lanes, plan_.steps().back(), pose, kSurfaces, rows_.rows());
  const std::size_t pairs = front.lanes.pair_count;
  for (std::size_t begin = 0; begin < pairs; begin += kPart) {
    // The first part is tested even after the deadline: rows are turned, and it takes 3 µs.
    if ((begin > 0 && budget.is_past()) || sink.stopped()) return false;
    pass_on(front.lanes, begin, std::min(begin + kPart, pairs), sink);
  }
  return !sink.stopped();
}

template bool CoherentSearch::pass_on<LeafPairSink>(const Front&, const SearchPose&, const Budget&,
                                                    LeafPairSink&) noexcept;
template bool CoherentSearch::pass_on<ContactOutput>(const Front&, const SearchPose&, const Budget&,
                                                     ContactOutput&) noexcept;

void CoherentSearch::pass_on(const FrontLanes& front, std::size_t begin, std::size_t end,
                             LeafPairSink& sink) noexcept {
  std::uint32_t places[kPart + kFrontSpare];
  LeafPair pairs[kPart];
  const std::size_t count =
      kernels_.select_front(front, plan_.steps().back(), rows_.rows(), begin, end, places);
  for (std::size_t i = 0; i < count; ++i) {
    pairs[i] = {front.fixed.id[front.moving.row[places[i]]], front.moving.id[places[i]]};
  }
  plan_.resolve({pairs, count});
  sink.append(std::span<const LeafPair>(pairs, count));
}

void CoherentSearch::pass_on(const FrontLanes& front, std::size_t begin, std::size_t end,
                             ContactOutput& sink) noexcept {
  kernels_.add_front(front, plan_.steps().back(), rows_.rows(), begin, end, sink.adder());
}

void CoherentSearch::forget() noexcept {
  holds_ = at_once_ = false;
  track_ = {};
  schedule_.forget();
  last_pairs_ = search_tests_ = 0;
  stale_ = true;
  if (!job_.busy()) drop_stale();
}

void CoherentSearch::drop_stale() noexcept {
  if (stale_) search_.drop();
  stale_ = false;
}

std::size_t CoherentSearch::bytes_for(const SearchPlan& plan,
                                      const CoherentOptions& options) noexcept {
  return 2 * Front::bytes_for(options.front_pairs) +
         FrontRowMemory::bytes_for(options.front_pairs) +
         Search::bytes_for(plan, options.frontier_pairs);
}

}  // namespace ist
