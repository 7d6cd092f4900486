#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/query.h"
#include "ist/tree/tree_parts.h"
#include "query/query_cases.h"
#include "simd/contact_lanes.h"

namespace ist::test {

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
  const auto relative = relative_pose(pose, parts_of(fixed).lattice, parts_of(moving).lattice);
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

/// Rounding changes a leaf pair no more than a motion by this length does, mesh units
/// (docs/guarantees.md, Rates of the contact sums).
[[nodiscard]] inline double rounding_of(const SphereTree& fixed, const ContactManifold& points) {
  return 0x1p-17 * (fixed.bounding_radius() + points.rates().lever);
}

}  // namespace ist::test
