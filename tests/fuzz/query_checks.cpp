#include "fuzz/query_checks.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <utility>

#include "fuzz/fuzz_target.h"
#include "ist/base/pose.h"

namespace ist::test {

struct QueryChecks::Asked {
  QueryResult result;
  std::vector<Contact> contacts;
};

namespace {

constexpr std::uint64_t kFewPairs = 100'000;
constexpr Budget kBudget{5'000};

// Of bounds that are none the ends of an interval may be swapped.
bool is_interval(const GapInterval& gap, bool built) {
  return std::isfinite(gap.lower) && std::isfinite(gap.upper) &&
         (!built || (gap.lower >= 0 && gap.lower <= gap.upper));
}

bool intersect(const GapInterval& a, const GapInterval& b, double error) {
  return std::max(a.lower, b.lower) <= std::min(a.upper, b.upper) + error;
}

bool same(const QueryResult& a, const QueryResult& b) {
  const bool same_gap = a.gap.has_value() == b.gap.has_value() &&
                        (!a.gap || (a.gap->lower == b.gap->lower && a.gap->upper == b.gap->upper));
  return a.status == b.status && a.complete == b.complete && a.truncated == b.truncated &&
         a.level == b.level && a.contacts == b.contacts && a.sphere_tests == b.sphere_tests &&
         a.pad == b.pad && same_gap;
}

bool is_finite(const Wrench& wrench) {
  return wrench.force.allFinite() && wrench.torque.allFinite();
}

}  // namespace

QueryChecks::QueryChecks(const SphereTree& fixed, const SphereTree& moving, Trees trees)
    : fixed_(fixed),
      moving_(moving),
      built_(trees == Trees::kBuilt),
      few_pairs_(std::uint64_t{fixed.octree().leaf_count()} * moving.octree().leaf_count() <=
                 kFewPairs) {
  for (const SpherePolicy policy : kSpherePolicies) {
    if (!fixed.has(policy) || !moving.has(policy)) continue;
    CollisionOptions options;
    options.policy = policy;
    // Small, so that the ways are taken that are taken where memory is full.
    options.frontier_pairs = 16;
    options.triangle_pairs = 64;
    Policy& made = policies_.emplace_back();
    made.best = std::make_unique<CollisionQuery>(fixed, moving, options);
    options.target = "scalar";
    made.scalar = std::make_unique<CollisionQuery>(fixed, moving, options);
    made.points =
        std::make_unique<ContactPoints>(fixed, moving, policy, ContactPointOptions{8, 32});
    if (built_) made.promise = std::make_unique<PromiseCheck>(fixed, moving, policy);
  }
}

std::optional<bool> QueryChecks::at(const Eigen::Isometry3d& pose) {
  std::optional<bool> touches;
  for (std::size_t i = 0; i < policies_.size(); ++i) {
    const auto by_policy = at(pose, i);
    if (by_policy) touches = *by_policy || touches.value_or(false);
  }
  return touches;
}

std::optional<bool> QueryChecks::at(const Eigen::Isometry3d& pose, std::size_t which) {
  Policy& policy = policies_[which % policies_.size()];
  if (!project_to_rigid(pose)) {
    check_invalid(*policy.best, *policy.points, pose);
    return std::nullopt;
  }
  const auto ask = [&](CollisionQuery& query) {
    const auto collide = [&](std::span<Contact> out) {
      return few_pairs_ ? query.collide(pose, out) : query.collide(pose, out, kBudget);
    };
    Asked asked{collide({}), {}};
    // Room for all, or for all but one.
    asked.contacts.resize(asked.result.contacts - asked.result.contacts % 2);
    const QueryResult counted = std::exchange(asked.result, collide(asked.contacts));
    require(counted.contacts == asked.result.contacts, "an empty span changes the count");
    return asked;
  };
  const Asked asked = ask(*policy.best), scalar = ask(*policy.scalar);
  require(same(asked.result, scalar.result), "the scalar form gives another result");
  require(asked.contacts == scalar.contacts, "the scalar form gives other contacts");
  check_list(asked);
  if (few_pairs_) {
    check_gap(*policy.best, asked, pose);
    check_points(*policy.best, *policy.points, asked, pose);
    if (policy.best->is_exact()) check_exact(*policy.scalar, *policy.best, asked, pose);
  }
  if (few_pairs_ && policy.promise) {
    std::vector<Contact> all(asked.result.contacts);
    const QueryResult result = policy.best->collide(pose, all);
    const GivenAnswer given{result, all};
    const auto breach = policy.promise->check(pose, {&given, 1});
    if (breach) throw Finding("the promise is broken: " + breach->what);
  }
  return asked.result.contacts > 0;
}

void QueryChecks::check_invalid(CollisionQuery& query, ContactPoints& points,
                                const Eigen::Isometry3d& pose) {
  const QueryResult result = query.collide(pose, std::span<Contact>{});
  require(result.status == QueryStatus::kInvalidPose && result.contacts == 0,
          "a pose that is none is searched");
  require(query.collide(pose, {}, kBudget).status == QueryStatus::kInvalidPose,
          "a pose that is none is searched, within a budget");
  require(query.gap(pose, 0).status == QueryStatus::kInvalidPose, "a pose that is none has a gap");
  require(query.touches(pose) == Touch::kInvalidPose, "bodies touch at a pose that is none");
  require(query.contact_points(pose, points).status == QueryStatus::kInvalidPose &&
              points.points().empty() && points.sums().weight == 0 &&
              points.sums().spring.force.isZero(0),
          "a pose that is none has contact points");
  if (!query.is_exact()) return;
  require(query.collide_exact(pose, {}).status == QueryStatus::kInvalidPose,
          "triangles meet at a pose that is none");
}

void QueryChecks::check_list(const Asked& asked) const {
  const QueryResult& result = asked.result;
  require(result.status == QueryStatus::kDone, "a rigid pose is refused");
  require(std::isfinite(result.pad) && result.pad >= 0, "the pad is no length");
  require(!result.gap || is_interval(*result.gap, built_), "the gap is no interval");
  require(result.truncated == (result.contacts > asked.contacts.size()),
          "truncated and the count disagree");
  const std::uint64_t leaves = fixed_.octree().leaf_count(), others = moving_.octree().leaf_count();
  std::uint64_t before = 0;  // one more than the last pair's place among all pairs
  for (const Contact& contact : asked.contacts) {
    require(contact.fixed < leaves && contact.moving < others, "a contact is of no leaf");
    const std::uint64_t place = contact.fixed * others + contact.moving;
    require(place + 1 > before, "contacts are not in order");
    before = place + 1;
  }
}

void QueryChecks::check_gap(CollisionQuery& query, const Asked& asked,
                            const Eigen::Isometry3d& pose) const {
  const GapResult gap = query.gap(pose, 0);
  require(gap.status == QueryStatus::kDone && is_interval(gap.gap, built_),
          "the gap is no interval");
  const QueryResult within = query.collide(pose, {}, kBudget);
  require(within.gap && is_interval(*within.gap, built_), "the gap within a budget is no interval");
  require(within.sphere_tests <= kBudget.sphere_tests, "the budget is overspent");
  if (!built_) return;
  // Two triangles' distance is given to 2^-24 of it and of the longest edge.
  const double error = 0x1p-20 * (fixed_.reach() + moving_.reach() + gap.gap.upper);
  require(intersect(gap.gap, *within.gap, error), "two gaps of one pose do not intersect");
  if (asked.result.contacts > 0 || query.is_exact()) return;
  require(gap.gap.upper > 0, "nothing touches, and there is no gap");
}

void QueryChecks::check_points(CollisionQuery& query, ContactPoints& points, const Asked& asked,
                               const Eigen::Isometry3d& pose) const {
  const QueryResult result = query.contact_points(pose, points);
  require(result.status == QueryStatus::kDone && result.contacts == asked.result.contacts,
          "contact points are of other contacts");
  const ContactSums& sums = points.sums();
  require(std::isfinite(sums.weight) && sums.weight >= 0 && is_finite(sums.pressure) &&
              is_finite(sums.spring) && sums.about.allFinite(),
          "a sum is not finite");
  require(sums.pairs <= result.contacts, "more pairs have weight than there are");
  const double s = 0.5 * (fixed_.lattice().voxel_size + moving_.lattice().voxel_size);
  constexpr double kRounding = 1e-9;
  for (const ContactPoint& point : points.points()) {
    require(point.position.allFinite(), "a contact point is nowhere");
    require(std::abs(point.normal.squaredNorm() - 1) <= kRounding, "a normal is not of length 1");
    require(point.depth >= -2 * s * (1 + kRounding) && point.depth <= s * (1 + kRounding),
            "a depth is beyond its bounds");
    require(std::isfinite(point.weight) && point.weight > 0, "a contact point has no weight");
  }
}

void QueryChecks::check_exact(CollisionQuery& scalar, CollisionQuery& best, const Asked& asked,
                              const Eigen::Isometry3d& pose) const {
  const auto ask = [&](CollisionQuery& query) {
    std::vector<TrianglePair> pairs(4'096);
    const ExactResult result = query.collide_exact(pose, pairs);
    require(result.status == QueryStatus::kDone, "a rigid pose is refused by triangles");
    pairs.resize(std::min<std::size_t>(result.triangle_pairs, pairs.size()));
    require(result.truncated == (result.triangle_pairs > pairs.size()),
            "truncated and the count of triangles disagree");
    return pairs;
  };
  const std::vector<TrianglePair> pairs = ask(best);
  require(pairs == ask(scalar), "the scalar form gives other triangles");
  require(std::adjacent_find(pairs.begin(), pairs.end(), std::greater_equal<>()) == pairs.end(),
          "triangles are not in order");
  for (const TrianglePair& pair : pairs) {
    require(pair.fixed < fixed_.triangles()->mesh.triangles.size() &&
                pair.moving < moving_.triangles()->mesh.triangles.size(),
            "a pair is of no triangle");
  }
  const Touch touch = best.touches(pose);
  require(touch == Touch::kNo || touch == Touch::kYes, "triangles only possibly meet");
  if (!built_) return;
  require((touch == Touch::kYes) == !pairs.empty(), "touches() says otherwise");
  require(pairs.empty() || asked.result.contacts > 0, "triangles meet, and no leaves do");
}

}  // namespace ist::test
