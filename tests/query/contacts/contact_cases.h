#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ist/query/query.h"
#include "query/query_cases.h"

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

}  // namespace ist::test
