#include "loop/haptics/bodies/pair_queries.h"

#include <algorithm>
#include <utility>

namespace ist {
namespace {

using Clock = Budget::Clock;
using std::chrono::nanoseconds;

void join(QueryResult& all, const QueryResult& one) noexcept {
  if (all.status == QueryStatus::kDone) all.status = one.status;
  all.complete = all.complete && one.complete;
  all.truncated = all.truncated || one.truncated;
  all.level = std::max(all.level, one.level);
  all.leaf_pairs += one.leaf_pairs;
  all.sphere_tests += one.sphere_tests;
  if (one.distance) {
    if (!all.distance) all.distance = one.distance;
    all.distance->lower = std::min(all.distance->lower, one.distance->lower);
    all.distance->upper = std::min(all.distance->upper, one.distance->upper);
  }
  all.resolution = std::max(all.resolution, one.resolution);
  all.pad = std::max(all.pad, one.pad);
  const auto cost = [](Found found) { return found == Found::kFresh ? 2 : found == Found::kKept; };
  if (cost(one.found) > cost(all.found)) all.found = one.found;
}

// The part of `rest` for a pair of need `own`, where the pairs behind it need `later`.
double share(double rest, double own, double later) noexcept {
  return std::max(rest - later, rest * (own / (own + later)));
}

// The same of a whole number. What is left of it may be more than a double tells apart.
template <typename Count>
Count part_of(Count rest, double own, double later) noexcept {
  const auto all = static_cast<double>(rest);
  const double part = share(all, own, later);
  return part < all ? static_cast<Count>(part) : rest;
}

}  // namespace

void PairQueries::add(const HandPair& pair, std::unique_ptr<ToolContactQuery> query) {
  pairs_.push_back({pair, std::move(query), {}});
}

std::size_t PairQueries::bytes() const noexcept {
  std::size_t bytes = 0;
  for (const PairQuery& pair : pairs_) bytes += pair.query->bytes();
  return bytes;
}

void PairQueries::place(const HandBodies& bodies) noexcept {
  for (PairQuery& pair : pairs_) {
    pair.query->place(bodies.frames(pair.bodies.fixed, pair.bodies.held));
  }
}

QueryResult PairQueries::ask(PairQuery& pair, const Placement& tool, const Budget& budget,
                             ToolContacts& contacts) noexcept {
  const auto number = static_cast<std::size_t>(&pair - pairs_.data());
  const QueryResult result = pair.query->find(tool, budget, contacts, number);
  // A pair that was stopped needs more than it had.
  const double factor = result.complete ? 1 : 2;
  pair.need.tests = std::max(1.0, factor * static_cast<double>(result.sphere_tests));
  return result;
}

std::optional<QueryResult> PairQueries::find(const HandBodies& bodies, const Placement& tool,
                                             const Budget& budget,
                                             ToolContacts& contacts) noexcept {
  contacts.clear();
  if (empty()) return std::nullopt;
  QueryResult all{.found = Found::kClear};
  std::size_t asked = 0;
  Need later{0, 0};
  for (const PairQuery& pair : pairs_) {
    if (!bodies.may_touch(pair.bodies.fixed, pair.bodies.held)) continue;
    ++asked;
    later.tests += pair.need.tests;
    later.nanoseconds += pair.need.nanoseconds;
  }
  Budget rest = budget;
  for (PairQuery& pair : pairs_) {
    if (!bodies.may_touch(pair.bodies.fixed, pair.bodies.held)) continue;
    if (asked == 1) {  // nothing to divide: no look at the clock
      join(all, ask(pair, tool, rest, contacts));
      break;
    }
    later.tests -= pair.need.tests;
    later.nanoseconds -= pair.need.nanoseconds;
    Budget part = rest;
    if (rest.has_tests()) {
      part.tests = part_of(rest.tests, pair.need.tests, later.tests);
    }
    Clock::time_point begin{};
    if (rest.has_deadline()) {
      begin = detail::budget_now();
      const nanoseconds left = rest.deadline - begin;
      part.deadline =
          begin + nanoseconds(part_of(left.count(), pair.need.nanoseconds, later.nanoseconds));
    }
    const QueryResult result = ask(pair, tool, part, contacts);
    if (rest.has_tests()) rest.tests -= std::min(rest.tests, result.sphere_tests);
    if (rest.has_deadline()) {
      const auto spent = static_cast<double>(nanoseconds(detail::budget_now() - begin).count());
      pair.need.nanoseconds = std::max(1.0, result.complete ? spent : 2 * spent);
    }
    join(all, result);
  }
  for (const HandPair& pair : far_) {
    if (!bodies.may_touch(pair.fixed, pair.held)) continue;
    if (!(bodies.gap(pair.fixed, pair.held, tool) > 0)) all.complete = false;
  }
  return all;
}

void PairQueries::note_drift(const HandBodies& bodies, const Placement& tool,
                             ToolContacts& contacts) const noexcept {
  for (ContactPair& pair : contacts.pairs()) {
    pair.drift = bodies.drift(pairs_[pair.number].bodies.fixed, tool);
  }
}

}  // namespace ist
