#include "fuzz/query_checks.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <span>
#include <utility>

#include "fuzz/fuzz_target.h"
#include "ist/base/pose.h"
#include "ist/tree/tree_parts.h"

namespace ist::test {

struct QueryChecks::Asked {
  QueryResult result;
  std::vector<LeafPair> leaf_pairs;
};

namespace {

constexpr std::uint64_t kFewPairs = 100'000;
constexpr Budget kBudget{5'000};

// Of bounds that are none the ends of an interval may be swapped.
bool is_interval(const DistanceInterval& gap, bool built) {
  return std::isfinite(gap.lower) && std::isfinite(gap.upper) &&
         (!built || (gap.lower >= 0 && gap.lower <= gap.upper));
}

bool intersect(const DistanceInterval& a, const DistanceInterval& b, double error) {
  return std::max(a.lower, b.lower) <= std::min(a.upper, b.upper) + error;
}

bool same(const QueryResult& a, const QueryResult& b) {
  const bool same_gap = a.distance.has_value() == b.distance.has_value() &&
                        (!a.distance || (a.distance->lower == b.distance->lower &&
                                         a.distance->upper == b.distance->upper));
  return a.status == b.status && a.complete == b.complete && a.truncated == b.truncated &&
         a.level == b.level && a.leaf_pairs == b.leaf_pairs && a.sphere_tests == b.sphere_tests &&
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
      few_pairs_(std::uint64_t{fixed.leaf_count()} * moving.leaf_count() <= kFewPairs) {
  for (const SpherePolicy policy : kSpherePolicies) {
    if (!fixed.has(policy) || !moving.has(policy)) continue;
    QueryOptions options;
    options.policy = policy;
    // Small, so that the ways are taken that are taken where memory is full.
    options.frontier_pairs = 16;
    Policy& made = policies_.emplace_back();
    made.best = std::make_unique<Query>(fixed, moving, options);
    options.target = "scalar";
    made.scalar = std::make_unique<Query>(fixed, moving, options);
    made.points = std::make_unique<ContactManifold>(fixed, moving, policy, ManifoldOptions{8, 32});
    if (built_) made.guarantee = std::make_unique<AnswerVerifier>(fixed, moving, policy);
  }
}

std::optional<bool> QueryChecks::at(const Eigen::Isometry3d& pose) {
  std::optional<bool> intersects;
  for (std::size_t i = 0; i < policies_.size(); ++i) {
    const auto by_policy = at(pose, i);
    if (by_policy) intersects = *by_policy || intersects.value_or(false);
  }
  return intersects;
}

std::optional<bool> QueryChecks::at(const Eigen::Isometry3d& pose, std::size_t which) {
  Policy& policy = policies_[which % policies_.size()];
  if (!project_to_rigid(pose)) {
    check_invalid(*policy.best, *policy.points, pose);
    return std::nullopt;
  }
  const auto ask = [&](Query& query) {
    const auto leaf_pairs = [&](std::span<LeafPair> out) {
      return few_pairs_ ? query.leaf_pairs(pose, out) : query.leaf_pairs(pose, out, kBudget);
    };
    Asked asked{leaf_pairs({}), {}};
    // Room for all, or for all but one.
    asked.leaf_pairs.resize(asked.result.leaf_pairs - asked.result.leaf_pairs % 2);
    const QueryResult counted = std::exchange(asked.result, leaf_pairs(asked.leaf_pairs));
    require(counted.leaf_pairs == asked.result.leaf_pairs, "an empty span changes the count");
    return asked;
  };
  const Asked asked = ask(*policy.best), scalar = ask(*policy.scalar);
  require(same(asked.result, scalar.result), "the scalar form gives another result");
  require(asked.leaf_pairs == scalar.leaf_pairs, "the scalar form gives other contacts");
  check_list(asked);
  if (few_pairs_) {
    check_gap(*policy.best, asked, pose);
    check_points(*policy.best, *policy.points, asked, pose);
    if (policy.best->has_triangles()) check_exact(*policy.scalar, *policy.best, asked, pose);
  }
  if (few_pairs_ && policy.guarantee) {
    std::vector<LeafPair> all(asked.result.leaf_pairs);
    const QueryResult result = policy.best->leaf_pairs(pose, all);
    const GivenAnswer given{result, all};
    const auto violation = policy.guarantee->check(pose, {&given, 1});
    if (violation) throw Finding("the guarantee is broken: " + violation->detail);
  }
  return asked.result.leaf_pairs > 0;
}

void QueryChecks::check_invalid(Query& query, ContactManifold& points,
                                const Eigen::Isometry3d& pose) {
  const QueryResult result = query.leaf_pairs(pose, std::span<LeafPair>{});
  require(result.status == QueryStatus::kInvalidPose && result.leaf_pairs == 0,
          "a pose that is none is searched");
  require(query.leaf_pairs(pose, {}, kBudget).status == QueryStatus::kInvalidPose,
          "a pose that is none is searched, within a budget");
  require(query.distance(pose, 0).status == QueryStatus::kInvalidPose,
          "a pose that is none has a gap");
  require(query.intersects(pose).status == QueryStatus::kInvalidPose &&
              query.intersects(pose).answer == ist::Answer::kUnknown,
          "bodies touch at a pose that is none");
  require(query.contacts(pose, points).status == QueryStatus::kInvalidPose &&
              points.points().empty() && points.sums().weight == 0 &&
              points.sums().spring.force.isZero(0),
          "a pose that is none has contact points");
  if (!query.has_triangles()) return;
  require(query.triangle_pairs(pose, {}).status == QueryStatus::kInvalidPose,
          "triangles meet at a pose that is none");
  require(query.near_pairs(pose, 1, {}).status == QueryStatus::kInvalidPose,
          "triangles are near at a pose that is none");
}

void QueryChecks::check_list(const Asked& asked) const {
  const QueryResult& result = asked.result;
  require(result.status == QueryStatus::kDone, "a rigid pose is refused");
  require(std::isfinite(result.pad) && result.pad >= 0, "the pad is no length");
  require(!result.distance || is_interval(*result.distance, built_), "the gap is no interval");
  require(result.truncated == (result.leaf_pairs > asked.leaf_pairs.size()),
          "truncated and the count disagree");
  const std::uint64_t leaves = fixed_.leaf_count(), others = moving_.leaf_count();
  std::uint64_t before = 0;  // one more than the last pair's place among all pairs
  for (const LeafPair& leaf_pair : asked.leaf_pairs) {
    require(leaf_pair.fixed < leaves && leaf_pair.moving < others, "a contact is of no leaf");
    const std::uint64_t place = leaf_pair.fixed * others + leaf_pair.moving;
    require(place + 1 > before, "contacts are not in order");
    before = place + 1;
  }
}

void QueryChecks::check_gap(Query& query, const Asked& asked, const Eigen::Isometry3d& pose) const {
  const DistanceResult gap = query.distance(pose, 0);
  require(gap.status == QueryStatus::kDone && is_interval(gap.distance, built_),
          "the gap is no interval");
  const QueryResult within = query.leaf_pairs(pose, {}, kBudget);
  require(within.distance && is_interval(*within.distance, built_),
          "the gap within a budget is no interval");
  require(within.sphere_tests <= kBudget.tests, "the budget is overspent");
  if (!built_) return;
  // Two triangles' distance is given to 2^-24 of it and of the longest edge.
  const double error =
      0x1p-20 * (fixed_.bounding_radius() + moving_.bounding_radius() + gap.distance.upper);
  require(intersect(gap.distance, *within.distance, error),
          "two gaps of one pose do not intersect");
  if (asked.result.leaf_pairs > 0 || query.has_triangles()) return;
  require(gap.distance.upper > 0, "nothing touches, and there is no gap");
}

void QueryChecks::check_points(Query& query, ContactManifold& points, const Asked& asked,
                               const Eigen::Isometry3d& pose) const {
  const QueryResult result = query.contacts(pose, points);
  require(result.status == QueryStatus::kDone && result.leaf_pairs == asked.result.leaf_pairs,
          "contact points are of other contacts");
  const ContactSums& sums = points.sums();
  require(std::isfinite(sums.weight) && sums.weight >= 0 && is_finite(sums.pressure) &&
              is_finite(sums.spring) && sums.about.allFinite(),
          "a sum is not finite");
  require(sums.pairs <= result.leaf_pairs, "more pairs have weight than there are");
  const double s = 0.5 * (fixed_.voxel_size() + moving_.voxel_size());
  constexpr double kRounding = 1e-9;
  for (const Contact& point : points.points()) {
    require(point.position.allFinite(), "a contact point is nowhere");
    require(std::abs(point.normal.squaredNorm() - 1) <= kRounding, "a normal is not of length 1");
    require(point.depth >= -2 * s * (1 + kRounding) && point.depth <= s * (1 + kRounding),
            "a depth is beyond its bounds");
    require(std::isfinite(point.weight) && point.weight > 0, "a contact point has no weight");
  }
}

// Pairs within no margin are those that intersect, and perhaps some that nearly do.
void QueryChecks::check_near(Query& scalar, Query& best, const std::vector<TrianglePair>& meeting,
                             const Eigen::Isometry3d& pose) const {
  const auto ask = [&](Query& query) {
    std::vector<NearPair> pairs(4'096);
    const NearPairsResult result = query.near_pairs(pose, 0, pairs);
    require(result.status == QueryStatus::kDone, "a rigid pose is refused by near pairs");
    pairs.resize(std::min<std::size_t>(result.near_pairs, pairs.size()));
    require(result.near_pairs >= meeting.size() || !result.complete,
            "a pair intersects and is not near");
    return pairs;
  };
  const std::vector<NearPair> pairs = ask(best), others = ask(scalar);
  require(pairs.size() == others.size(), "the scalar form gives other near pairs");
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    require(std::memcmp(&pairs[k].distance, &others[k].distance, 7 * sizeof(double)) == 0 &&
                pairs[k].triangles == others[k].triangles,
            "the scalar form gives other near points");
  }
}

void QueryChecks::check_exact(Query& scalar, Query& best, const Asked& asked,
                              const Eigen::Isometry3d& pose) const {
  const auto ask = [&](Query& query) {
    std::vector<TrianglePair> pairs(4'096);
    const TrianglePairsResult result = query.triangle_pairs(pose, pairs);
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
    require(pair.fixed < parts_of(fixed_).triangles->mesh.triangles.size() &&
                pair.moving < parts_of(moving_).triangles->mesh.triangles.size(),
            "a pair is of no triangle");
  }
  check_near(scalar, best, pairs, pose);
  const ist::Answer found = best.intersects(pose).answer;
  require(found == ist::Answer::kYes || found == ist::Answer::kNo, "triangles decide nothing");
  if (!built_) return;
  require((found == ist::Answer::kYes) == !pairs.empty(), "intersects() says otherwise");
  require(pairs.empty() || asked.result.leaf_pairs > 0, "triangles meet, and no leaves do");
}

}  // namespace ist::test
