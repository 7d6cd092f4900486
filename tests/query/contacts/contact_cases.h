#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/query.h"
#include "ist/tree/tree_parts.h"
#include "query/query_cases.h"
#include "simd/contact_lanes.h"

namespace ist::test {

/// The contacts of one query, kept.
struct FoundContacts {
  ContactSums sums;
  std::vector<Contact> points;
  QueryResult result;
};

[[nodiscard]] inline FoundContacts find_contacts(Query& query, ContactManifold& points,
                                                 const Eigen::Isometry3d& pose) {
  const QueryResult result = query.contacts(pose, points);
  return {points.sums(), {points.points().begin(), points.points().end()}, result};
}

/// Everything of one pose, at most `most` points.
[[nodiscard]] inline FoundContacts find_contacts(const SphereTree& fixed, const SphereTree& moving,
                                                 SpherePolicy policy, const Eigen::Isometry3d& pose,
                                                 std::size_t most = 1 << 14) {
  QueryOptions options;
  options.policy = policy;
  Query query(fixed, moving, options);
  ContactManifold points(fixed, moving, policy, {most, std::size_t{1} << 20, 2});
  return find_contacts(query, points, pose);
}

/// Whether all of it is numbers, and within what Contact states; `size` is s.
[[nodiscard]] inline bool is_sound(const FoundContacts& touched, double size) {
  constexpr double kRounded = 1 + 1e-9;
  const auto finite = [](const Wrench& w) { return w.force.allFinite() && w.torque.allFinite(); };
  const ContactSums& sums = touched.sums;
  return std::isfinite(sums.weight) && finite(sums.pressure) && finite(sums.spring) &&
         std::all_of(touched.points.begin(), touched.points.end(), [&](const Contact& p) {
           return p.position.allFinite() && std::abs(p.normal.norm() - 1) < 1e-9 &&
                  p.depth >= -2 * size * kRounded && p.depth <= size * kRounded && p.weight > 0 &&
                  std::isfinite(p.weight);
         });
}

inline void expect_close(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double tolerance) {
  EXPECT_LE((a - b).norm(), tolerance) << a.transpose() << " and " << b.transpose();
}

/// Whether they are the same, bit by bit.
[[nodiscard]] inline bool same(const Wrench& a, const Wrench& b) {
  return a.force == b.force && a.torque == b.torque;
}
[[nodiscard]] inline bool same(const ContactSums& a, const ContactSums& b) {
  return a.weight == b.weight && a.pairs == b.pairs && a.about == b.about &&
         same(a.pressure, b.pressure) && same(a.spring, b.spring);
}
[[nodiscard]] inline bool same(const Contact& a, const Contact& b) {
  return a.position == b.position && a.normal == b.normal && a.depth == b.depth &&
         a.weight == b.weight;
}
[[nodiscard]] inline bool same(const FoundContacts& a, const FoundContacts& b) {
  return same(a.sums, b.sums) &&
         std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                    [](const Contact& p, const Contact& q) { return same(p, q); });
}

/// A leaf pair of an answer, and its terms in the sums.
struct PairSums {
  LeafPair leaves;
  ContactSums sums;
};

/// The leaf pairs of a pose that have a weight, each by itself; `points` has a margin of 0 and no
/// points, and is of no use afterwards.
[[nodiscard]] inline std::vector<PairSums> sums_by_pair(Query& query, ContactManifold& points,
                                                        const SphereTree& fixed,
                                                        const SphereTree& moving,
                                                        const Eigen::Isometry3d& pose) {
  struct Recorder final : ContactTermsStream {
    std::vector<PairTerms> pairs;
    void take(const ContactTerms& t) noexcept override {
      for (std::size_t i = 0; i < t.count; ++i) {
        pairs.push_back({t.weight[i],
                         t.depth[i],
                         {t.x[i], t.y[i], t.z[i]},
                         {t.force_x[i], t.force_y[i], t.force_z[i]}});
      }
    }
  } recorder;
  detail::ContactReducer& reducer = detail::reducer_of(points);
  reducer.adder().stream = &recorder;
  static_cast<void>(query.contacts(pose, points));
  const std::vector<LeafPair> leaves = ask(query, pose).leaf_pairs;
  EXPECT_EQ(leaves.size(), recorder.pairs.size());
  const auto relative = relative_pose(pose, parts_of(fixed).origin, parts_of(moving).origin);
  std::vector<PairSums> all;
  for (std::size_t i = 0; i < leaves.size() && i < recorder.pairs.size(); ++i) {
    if (!(recorder.pairs[i].weight > 0)) continue;
    reducer.clear();
    add_pair(reducer.adder().rule, recorder.pairs[i], reducer.adder().totals);
    reducer.finish(*relative, true);
    all.push_back({leaves[i], reducer.sums()});
  }
  return all;
}

/// Returns a length in mesh units. Rounding changes a leaf pair at most as much as a motion by this
/// length (docs/guarantees.md, Rates of the contact sums).
[[nodiscard]] inline double rounding_of(const SphereTree& fixed, const ContactManifold& points) {
  return 0x1p-17 * (fixed.bounding_radius() + points.rates().lever);
}

}  // namespace ist::test
