#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "ist/query/workers/shared_work.h"
#include "stability/all_engines.h"
#include "support/effort.h"
#include "support/exact_query.h"
#include "support/shapes.h"
#include "support/stability.h"

namespace ist::test {
namespace {

// A straight way on which bodies touch at `from` and are apart at `to`.
struct AxisDirection {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d start, direction;  // x = 0 is at the start
  double from, to;
  [[nodiscard]] Eigen::Isometry3d at(double x) const {
    return pose_of(rotation, start + x * direction);
  }
};

// One vertex of each brought together, and then apart: along an axis, where x is the coordinate
// itself, or along any direction.
AxisDirection way_apart(const TriangleMesh& a, const TriangleMesh& b,
                        const Eigen::Matrix3d& rotation, bool along_axis, Random& random) {
  AxisDirection way{rotation, a.vertices[random.below(a.vertices.size())], {}, 0, 20};
  way.start -= rotation * b.vertices[random.below(b.vertices.size())];
  if (!along_axis) {
    way.direction = random.direction();
    return way;
  }
  const auto axis = static_cast<Eigen::Index>(random.below(3));
  way.direction = (random.below(2) == 0 ? 1 : -1) * Eigen::Vector3d::Unit(axis);
  way.from = way.start.dot(way.direction);
  way.to = way.from + 20;
  way.start[axis] = 0;
  return way;
}

// x and 8 doubles to either side of it, and the float next to it and 8 floats to either side.
std::vector<double> ulps_round(double x) {
  std::vector<double> all{x, static_cast<double>(static_cast<float>(x))};
  for (const double end : {-HUGE_VAL, HUGE_VAL}) {
    double next = x;
    auto next_float = static_cast<float>(x);
    for (int ulp = 1; ulp <= 8; ++ulp) {
      all.push_back(next = std::nextafter(next, end));
      all.push_back(next_float = std::nextafter(next_float, static_cast<float>(end)));
    }
  }
  return all;
}

bool holds(const FoundPairs& answer, const LeafPair& pair) {
  return std::find(answer.leaf_pairs.begin(), answer.leaf_pairs.end(), pair) !=
         answer.leaf_pairs.end();
}

// How far the bounds of a pair are apart, in pads, if that is no more than one.
double pads_apart(const ExactPair& exact, SpherePolicy policy, const LeafPair& pair, double pad) {
  double apart = 0, together = 1;
  if (exact.bounds_meet(policy, pair.fixed, pair.moving, 0)) return 0;
  for (int step = 0; step < 10; ++step) {
    const double middle = 0.5 * (apart + together);
    (exact.bounds_meet(policy, pair.fixed, pair.moving, middle * pad) ? together : apart) = middle;
  }
  return together;
}

// What is counted of a policy.
struct Cases {
  Cases(const std::string& tried, SpherePolicy policy)
      : name(tried + ", " + std::string(to_string(policy))) {}
  std::string name;
  StabilityCase wrong{"tangency", "8 ulps round where contacts end: " + name, "wrong answers"};
  StabilityCase one_pair{"tangency", "where one pair ends: " + name, "wrong answers"};
  StabilityCase pads{"tangency", "how far pairs in the answer are apart: " + name, "pads"};
};

class Tangency : public ::testing::TestWithParam<SpherePolicy> {
 protected:
  // All engines at each of these places, against the guarantee.
  void check(Cases& cases, const RationalBodies& bodies, AllEngines& engines,
             const AxisDirection& way, const std::vector<double>& places) {
    for (const double x : places) {
      const FoundPairs answer = engines(way.at(x));
      const ExactPair exact = bodies.at(way.at(x));
      const auto kept = keeps_guarantee(exact, GetParam(), answer.leaf_pairs, answer.result.pad);
      cases.wrong.sample(kept ? 0 : 1, 0, kept.message());
      for (const LeafPair& pair : answer.leaf_pairs) {
        cases.pads.sample(pads_apart(exact, GetParam(), pair, answer.result.pad), 1);
      }
    }
  }

  // Where the last contact ends.
  void check_last_contact(Cases& cases, const RationalBodies& bodies, AllEngines& engines,
                          const AxisDirection& way) {
    const double last = last_touching(way.from, way.to, [&](double x) {
      return ask(engines.first(), way.at(x)).result.leaf_pairs > 0;
    });
    EXPECT_GT(engines(way.at(last)).leaf_pairs.size(), 0u);
    check(cases, bodies, engines, way, ulps_round(last));
  }

  // The places where one pair need no longer be found, and where its bounds part by more than the
  // pad. It is in the answer up to the first, and not beyond the second. Returns whether there is
  // such a pair.
  bool check_one_pair(Cases& cases, const RationalBodies& bodies, AllEngines& engines,
                      const AxisDirection& way, Random& random) {
    const SpherePolicy policy = GetParam();
    std::vector<LeafPair> meeting = engines(way.at(way.from)).leaf_pairs;
    const ExactPair from = bodies.at(way.at(way.from));
    std::erase_if(meeting, [&](const LeafPair& pair) {
      return !must_be_found(from, policy, pair.fixed, pair.moving);
    });
    if (meeting.empty()) return false;
    const LeafPair pair = meeting[random.below(meeting.size())];
    const double last = last_touching(way.from, way.to, [&](double x) {
      return must_be_found(bodies.at(way.at(x)), policy, pair.fixed, pair.moving);
    });
    cases.one_pair.sample(holds(engines(way.at(last)), pair) ? 0 : 1, 0, "it must be found");
    const double last_bounds = last_touching(last, way.to, [&](double x) {
      const double pad = ask(engines.first(), way.at(x)).result.pad;
      return bodies.at(way.at(x)).bounds_meet(policy, pair.fixed, pair.moving, pad);
    });
    const double after = std::nextafter(last_bounds, way.to);
    cases.one_pair.sample(holds(engines(way.at(after)), pair) ? 1 : 0, 0, "its bounds are apart");
    check(cases, bodies, engines, way,
          {last, std::nextafter(last, way.to), last_bounds, after, last * (1 - 0x1p-24),
           last * (1 + 0x1p-24)});
    return true;
  }
};

INSTANTIATE_TEST_SUITE_P(Policies, Tangency, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

TEST_P(Tangency, IsDecidedToTheLastFloat) {
  constexpr double kCells[] = {1, 1.5, 2, 3, 5, 7};
  const std::vector<Eigen::Matrix3d> turns = quarter_turns();
  Cases cases("random pairs", GetParam());
  int pairs = 0;
  const int seeds = std::max(4, samples(12));  // each kind below at least once
  for (int seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(5000 + static_cast<std::uint64_t>(seed));
    // Faces on lattice planes; any bodies in the same axes; turned; and moved along any direction.
    const int kind = seed % 4;
    const auto block = [&random] {
      const auto whole = [&random](std::size_t count) {
        return static_cast<double>(1 + random.below(count));
      };
      const Eigen::Vector3d corner(whole(9), whole(9), whole(9));
      return box(corner, corner + Eigen::Vector3d(4, whole(4), whole(4)));
    };
    const TriangleMesh a = kind == 0 ? block() : random_mesh(random);
    const TriangleMesh b = kind == 0 ? block() : random_mesh(random);
    const double cells_a = kind == 0 ? 4 : kCells[random.below(6)];
    const double cells_b = kind == 0 ? 4 : kCells[random.below(6)];
    const RationalBodies bodies(a, tree_of(a, cells_a), b, tree_of(b, cells_b));
    const Eigen::Matrix3d rotation =
        kind < 2 ? turns[random.below(turns.size())] : random.rotation();
    AllEngines engines(bodies.fixed, bodies.moving, GetParam());
    const AxisDirection way = way_apart(a, b, rotation, kind < 3, random);
    check_last_contact(cases, bodies, engines, way);
    pairs += check_one_pair(cases, bodies, engines, way, random) ? 1 : 0;
  }
  EXPECT_GT(pairs, seeds / 4);
}

// One pair parts while thousands of others overlap, so that the second worker has its part.
TEST_P(Tangency, IsDecidedAmidManyOthers) {
  IST_SLOW();
  Cases cases("amid many others", GetParam());
  const TriangleMesh ball = icosphere(2, 1);
  const RationalBodies bodies(ball, tree_of(ball, 14), ball, tree_of(ball, 14));
  AllEngines engines(bodies.fixed, bodies.moving, GetParam(), 1 << 16);
  Random random(1);
  const AxisDirection way{Eigen::Matrix3d::Identity(), {0, 0.02, 0.005}, {1, 0, 0}, 0.01, 4};
  for (int i = 0; i < samples(1); ++i) {
    const std::vector<LeafPair> all = engines(way.at(way.from)).leaf_pairs;
    EXPECT_GT(all.size(), 1000u);
    const LeafPair pair = all[random.below(all.size())];
    const double last = last_touching(
        way.from, way.to, [&](double x) { return holds(ask(engines.first(), way.at(x)), pair); });
    const std::vector<double> places = ulps_round(last);
    for (std::size_t k = 0; k < places.size(); k += 5) {
      const FoundPairs answer = engines(way.at(places[k]));
      const ExactPair exact = bodies.at(way.at(places[k]));
      const bool there = holds(answer, pair);
      const bool meets = must_be_found(exact, GetParam(), pair.fixed, pair.moving);
      cases.one_pair.sample(meets && !there ? 1 : 0, 0);
      const double pad = answer.result.pad;
      const bool apart = !exact.bounds_meet(GetParam(), pair.fixed, pair.moving, pad);
      cases.one_pair.sample(there && apart ? 1 : 0, 0);
      if (there && !apart) cases.pads.sample(pads_apart(exact, GetParam(), pair, pad), 1);
    }
    const FoundPairs answer = engines(way.at(last));
    const auto kept =
        keeps_guarantee(bodies.at(way.at(last)), GetParam(), answer.leaf_pairs, answer.result.pad);
    cases.wrong.sample(kept ? 0 : 1, 0, kept.message());
  }
  EXPECT_GT(sharing_of(engines.shared()).worth, 0u);
}

}  // namespace
}  // namespace ist::test
