#include "ist/query/pair_cache/cached_search.h"

#include <algorithm>
#include <limits>
#include <type_traits>

#include "ist/query/traversal/search_pose.h"

namespace ist {
namespace {

// The number of pairs that are tested between two looks at the clock.
constexpr std::size_t kPart = 2048;

constexpr double kUnknown = std::numeric_limits<double>::infinity();
constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

}  // namespace

CachedSearch::CachedSearch(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                           const SearchPlan& plan, const Kernels& kernels,
                           const CacheOptions& options, std::size_t items)
    : plan_(plan),
      kernels_(kernels),
      fixed_(lengths_of(fixed, policy)),
      moving_(lengths_of(moving, policy)),
      bound_(fixed, moving, policy),
      caches_{PairCache(options.front_pairs), PairCache(options.front_pairs)},
      search_(plan, kernels, options.frontier_pairs, items),
      rows_(options.front_pairs),
      schedule_(std::min(fixed.voxel_size(), moving.voxel_size()), options.workers == 2),
      period_(options.period),
      job_(
          [](void* self) noexcept {
            hand_over(HandOver::kClaimed);
            static_cast<CachedSearch*>(self)->search_.advance({});
            hand_over(HandOver::kWorked);
          },
          this) {
  if (options.workers == 2) worker_.emplace();
}

CachedSearch::~CachedSearch() {
  if (!worker_) return;
  worker_->retract(job_);
  job_.wait_idle();
}

void CachedSearch::bind(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                        const MotionBound& bound) noexcept {
  fixed_ = lengths_of(fixed, policy);
  moving_ = lengths_of(moving, policy);
  bound_ = bound;
  schedule_ = CacheSchedule(std::min(fixed.voxel_size(), moving.voxel_size()), false);
  search_.bind();
  forget();
}

// `upper` was measured at the cache's centre. So the largest displacement from `pose` back to that
// centre is added.
double CachedSearch::upper_at(const PairCache& cache, const RelativePose& pose) const noexcept {
  if (!(cache.upper < kUnknown)) return kUnknown;
  return cache.upper + bound_.between(pose, cache.centre, cache.upper);
}

std::optional<double> CachedSearch::motion_to(const PairCache& cache, const RelativePose& pose,
                                              double need) const noexcept {
  const double motion = bound_.between(cache.centre, pose, cache.extent);
  if (need + motion <= cache.extent) return motion;
  return std::nullopt;
}

CachedSearch::CacheAt CachedSearch::find(const RelativePose& pose, double margin,
                                         const Budget& budget) noexcept {
  if (worker_) worker_->tick(std::chrono::steady_clock::now(), period_);
  const double need = most_apart(pose, fixed_, moving_, margin);
  track_.add(pose, bound_, need);
  CacheAt found;
  const auto answer_from_kept = [&] {
    if (const auto motion = motion_to(kept(), pose, need)) {
      found.cache = &kept();
      found.motion = *motion;
      if (kept().empty()) found.upper = upper_at(kept(), pose);
    }
    return found.cache != nullptr;
  };
  const bool busy = job_.busy();
  if (!busy) {
    settle();
    static_cast<void>(take_up(pose, need));
  }
  if (kept().state == State::kKept && answer_from_kept()) return found;
  kept().state = State::kEmpty;  // it is used up
  if (busy) return found;

  // The search under way is ended now if a deadline interrupted a search at once, or if over half
  // of it is done. Else a new search with little slack is made if the body is nearly at rest: it
  // costs little more than a fresh search.
  const bool go_on = is_searching() && motion_to(next(), pose, need) &&
                     search_.most_tests() == kNoLimit &&
                     (next().state == State::kAtOnce || 2 * search_.tests() > search_tests_);
  if (!go_on) {
    const double slack = schedule_.slack_at_once();
    if (!schedule_.is_worth_at_once(slack, track_.speed()) || !may_fit()) return found;
    want(State::kAtOnce, pose, need + slack, kNoLimit);
  }
  const std::uint64_t before = search_.tests();
  advance(budget);
  found.tests = search_.tests() - before;
  give_up_if_full();
  if (take_up(pose, need)) answer_from_kept();
  return found;
}

// Begins the search for the next cache, in place of any other one.
void CachedSearch::want(State by, const RelativePose& centre, double extent,
                        std::uint64_t most_tests) noexcept {
  search_.begin(next(), {centre, to_float(centre, fixed_, moving_, extent), extent,
                         last_pairs_ == 0 ? Measured::kUpper : Measured::kNothing, most_tests});
  next().state = by;
}

// Begins the search for the next cache if it is time for it, and if the cache is worth it.
void CachedSearch::want_next(const RelativePose& pose, double need) noexcept {
  const Pace pace = track_.pace(bound_, need);
  const double slack = schedule_.slack(pace);
  const double reserve = CacheSchedule::reserve(kept().extent - need, pace);
  const bool holds = kept().state == State::kKept;
  if (holds &&
      motion_to(kept(), track_.ahead(CacheSchedule::ticks_ahead(slack, pace)), need + reserve) &&
      !CacheSchedule::is_wasteful(kept().extent - need, slack, kept().lanes.pair_count,
                                  last_pairs_)) {
    return;
  }
  double beyond = slack;
  const bool apart = last_pairs_ == 0;
  if (apart) {
    const double far = holds && kept().empty() ? upper_at(kept(), pose) : kUnknown;
    const double leaves = 2 * (fixed_.largest_leaf + moving_.largest_leaf);
    beyond = std::max(slack, schedule_.clearance(far - leaves, need));
  }
  if (!schedule_.is_worth(beyond, pace.speed) || !may_fit()) return;
  want(State::kAhead, track_.ahead(CacheSchedule::ticks_to_centre(beyond, pace)), need + beyond,
       apart ? CacheSchedule::most_for_clearance(search_tests_) : kNoLimit);
}

bool CachedSearch::may_fit() const noexcept {
  return schedule_.may_fit(last_pairs_, caches_[kept_].lanes.pair_capacity);
}

void CachedSearch::advance(const Budget& budget) noexcept {
  search_.advance(budget);
  settle();
}

// Enters the result of the search, which the worker may have made.
void CachedSearch::settle() noexcept {
  if (next().state == State::kForgotten) next().state = State::kEmpty;
  if (!is_searching()) return;
  if (search_.is_whole()) next().state = State::kReady;
  if (search_.is_full()) next().state = State::kFull;
}

// Lets the next cache answer if it is whole and holds at `pose`. Returns whether it does.
bool CachedSearch::take_up(const RelativePose& pose, double need) noexcept {
  if (next().state != State::kReady || !motion_to(next(), pose, need)) return false;
  kept().state = State::kEmpty;
  kept_ = 1 - kept_;
  kept().state = State::kKept;
  search_tests_ = search_.tests();
  schedule_.took_up(kept().empty(), kept().extent - need);
  return true;
}

void CachedSearch::give_up_if_full() noexcept {
  if (next().state != State::kFull) return;
  schedule_.was_full(search_.most_tests() != kNoLimit);  // only a clearance has a limit of tests
  next().state = State::kEmpty;
}

void CachedSearch::prepare(const RelativePose& pose, double margin, std::uint64_t leaf_pairs,
                           std::uint64_t tests, const Budget& budget) noexcept {
  last_pairs_ = leaf_pairs;
  if (tests > 0 && kept().state != State::kKept) {
    search_tests_ = tests;
    schedule_.searched();
  }
  schedule_.tick();
  if (job_.busy() || budget.is_past()) return;
  settle();
  give_up_if_full();
  const double need = most_apart(pose, fixed_, moving_, margin);
  if (next().state != State::kEmpty &&
      !motion_to(next(), track_.ahead(CacheSchedule::kTicksAhead), need)) {
    next().state = State::kEmpty;  // the body went another way
  }
  if (next().state == State::kEmpty) want_next(pose, need);
  if (!is_searching()) return;
  if (worker_ && worker_->offer(job_)) return;
  advance(budget.within(CacheSchedule::slice(search_tests_, tests > 0)));
}

template <class Sink>
bool CachedSearch::pass_on(const PairCache& cache, const SearchPose& pose, const Budget& budget,
                           Sink& sink) noexcept {
  if (cache.empty()) return true;
  constexpr bool kSurfaces = std::is_same_v<Sink, ContactOutput>;
  kernels_.turn_cache(cache.lanes, plan_.steps().back(), pose, kSurfaces, rows_.rows());
  const std::size_t pairs = cache.lanes.pair_count;
  for (std::size_t begin = 0; begin < pairs; begin += kPart) {
    // The first part is tested even after the deadline: its rows are turned, and it takes 3 µs.
    if ((begin > 0 && budget.is_past()) || sink.stopped()) return false;
    pass_on(cache.lanes, begin, std::min(begin + kPart, pairs), sink);
  }
  return !sink.stopped();
}

template bool CachedSearch::pass_on<LeafPairSink>(const PairCache&, const SearchPose&,
                                                  const Budget&, LeafPairSink&) noexcept;
template bool CachedSearch::pass_on<ContactOutput>(const PairCache&, const SearchPose&,
                                                   const Budget&, ContactOutput&) noexcept;

void CachedSearch::pass_on(const CacheLanes& cache, std::size_t begin, std::size_t end,
                           LeafPairSink& sink) noexcept {
  std::uint32_t places[kPart + kCacheSpare];
  LeafPair pairs[kPart];
  const std::size_t count =
      kernels_.select_cache(cache, plan_.steps().back(), rows_.rows(), begin, end, places);
  for (std::size_t i = 0; i < count; ++i) {
    pairs[i] = {cache.fixed.id[cache.moving.row[places[i]]], cache.moving.id[places[i]]};
  }
  plan_.resolve({pairs, count});
  sink.append(std::span<const LeafPair>(pairs, count));
}

void CachedSearch::pass_on(const CacheLanes& cache, std::size_t begin, std::size_t end,
                           ContactOutput& sink) noexcept {
  kernels_.add_cache(cache, plan_.steps().back(), rows_.rows(), begin, end, sink.adder());
}

void CachedSearch::forget() noexcept {
  kept().state = State::kEmpty;
  next().state = job_.busy() ? State::kForgotten : State::kEmpty;
  track_ = {};
  schedule_.forget();
  last_pairs_ = search_tests_ = 0;
}

std::size_t CachedSearch::bytes_for(const SearchPlan& plan, const CacheOptions& options,
                                    std::size_t items) noexcept {
  return 2 * PairCache::bytes_for(options.front_pairs) +
         CacheRowMemory::bytes_for(options.front_pairs) +
         Search::bytes_for(plan, options.frontier_pairs, items);
}

}  // namespace ist
