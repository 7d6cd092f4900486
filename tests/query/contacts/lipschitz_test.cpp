#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "ist/query/contacts/contact_rates.h"
#include "ist/query/contacts/contact_reducer.h"
#include "query/contacts/contact_cases.h"
#include "query/contacts/pair_sums.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// The largest of |change| / (rate · motion · pairs) for each of the five sums.
struct Steepness {
  double weight = 0, pressure_force = 0, pressure_torque = 0, spring_force = 0, spring_torque = 0;

  // `motion` includes the rounding of both.
  void compare(const ContactSums& a, const ContactSums& b, const ContactRates& rates, double motion,
               double pairs) {
    const double all = motion * pairs;
    const auto take = [all](double& most, double change, double rate) {
      most = std::max(most, change / (rate * all));
    };
    take(weight, std::abs(b.weight - a.weight), rates.weight);
    take(pressure_force, (b.pressure.force - a.pressure.force).norm(), rates.pressure_force);
    take(pressure_torque, (b.pressure.torque - a.pressure.torque).norm(), rates.pressure_torque);
    take(spring_force, (b.spring.force - a.spring.force).norm(), rates.spring_force);
    take(spring_torque, (b.spring.torque - a.spring.torque).norm(), rates.spring_torque);
  }
  void join(const Steepness& other) {
    weight = std::max(weight, other.weight);
    pressure_force = std::max(pressure_force, other.pressure_force);
    pressure_torque = std::max(pressure_torque, other.pressure_torque);
    spring_force = std::max(spring_force, other.spring_force);
    spring_torque = std::max(spring_torque, other.spring_torque);
  }
  [[nodiscard]] double least() const {
    return std::min({weight, pressure_force, pressure_torque, spring_force, spring_torque});
  }
  [[nodiscard]] double most() const {
    return std::max({weight, pressure_force, pressure_torque, spring_force, spring_torque});
  }
};

// A way of the moving body: steps of 1e-4 mm, or turns about the origin of its tree's frame by as
// much at the lever.
struct AxisDirection {
  const char* name;
  Isometry3d from;
  Vector3d along = Vector3d::Zero();  // of unit length, or nothing
  Vector3d axis = Vector3d::Zero();   // likewise
  int steps;

  [[nodiscard]] Isometry3d at(int step, double lever, const Vector3d& centre) const {
    constexpr double kStep = 1e-4;
    Isometry3d pose = from;
    pose.translation() += kStep * step * along;
    if (axis.norm() > 0) {
      pose = pose * Eigen::Translation3d(centre) * Eigen::AngleAxisd(kStep * step / lever, axis) *
             Eigen::Translation3d(-centre);
    }
    return pose;
  }
  [[nodiscard]] double motion() const { return 1e-4 * ((along.norm() + axis.norm()) * 1.000001); }
};

struct Bodies {
  const char* name;
  SphereTree fixed, moving;
  std::vector<AxisDirection> ways;
};

// Millimetres; voxels of 0.5 mm and coarser, so that 1e-4 mm is little.
std::vector<Bodies> all_bodies() {
  const TriangleMesh ball = icosphere(3, 2), block = box({-2, -2, -1}, {2, 2, 1}),
                     cube = box({-1, -1, -1}, {1, 1, 1});
  const Vector3d x = Vector3d::UnitX(), z = Vector3d::UnitZ(),
                 slope = Vector3d(3, -1, 2) / std::sqrt(14.0);
  const Vector3d none = Vector3d::Zero();
  Random random(11);
  const Eigen::Matrix3d turn = random.rotation();
  std::vector<Bodies> bodies;
  // A ball of voxels of 0.5 mm; from apart through the first contact, on, along a face and turning.
  bodies.push_back({"balls", tree_of(ball, 8), tree_of(ball, 8), {}});
  bodies.back().ways = {{"first contact", pose_of(turn, {0.3, 0.2, 4.6}), -z, none, 9000},
                        {"sliding", pose_of(turn, {0.3, 0.2, 3.7}), x, none, 6000},
                        {"turning", pose_of(turn, {0.3, 0.2, 3.7}), none, slope, 3000}};
  bodies.push_back({"boxes", tree_of(block, 8), tree_of(cube, 4), {}});
  bodies.back().ways = {// Faces in the grid's planes, and across them.
                        {"first contact", shift({0.3, 0.2, 2.9}), -z, none, 12000},
                        {"along a face", shift({0.3, 0.2, 2.0}), x, none, 8000},
                        {"tilting", shift({0.3, 0.2, 1.9}), none, x, 3000},
                        {"sloping", shift({1.3, 1.2, 2.4}), -slope, slope, 6000}};
  bodies.push_back({"coarse in fine", tree_of(ball, 10), tree_of(cube, 2), {}});
  bodies.back().ways = {{"first contact", pose_of(turn, {0.3, 0.2, 3.9}), -z, none, 8000},
                        {"turning", pose_of(turn, {0.3, 0.2, 3.0}), none, slope, 3000}};
  bodies.push_back({"fine in coarse", tree_of(cube, 2), tree_of(ball, 10), {}});
  bodies.back().ways = {{"first contact", pose_of(turn, {0.3, 0.2, 3.9}), -z, none, 8000}};
  return bodies;
}

class Lipschitz : public ::testing::TestWithParam<SpherePolicy> {
 protected:
  Lipschitz() { options_.policy = GetParam(); }
  // Rates are bounds; what happens comes as near to them as `near` times what it does for all
  // pairs.
  void check_sums(double least_depth, double near);
  void check_pairs(double least_depth, double near);
  QueryOptions options_;
};

INSTANTIATE_TEST_SUITE_P(Policies, Lipschitz, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

// The sums of all pairs, through first contacts, along and across voxels' faces and while turning.
void Lipschitz::check_sums(double least_depth, double near) {
  Steepness steepest;
  for (const Bodies& b : all_bodies()) {
    Query query(b.fixed, b.moving, options_);
    ContactManifold points(b.fixed, b.moving, GetParam(), {0, 0, least_depth});
    for (const AxisDirection& way : b.ways) {
      SCOPED_TRACE(std::string(b.name) + ", " + way.name);
      const double lever = points.rates().lever;
      const double motion = way.motion() + 2 * rounding_of(b.fixed, points);
      const Vector3d centre = b.moving.origin();
      Steepness found;
      ContactSums before;
      std::uint64_t most = 0;
      for (int step = 0; step <= way.steps; ++step) {
        static_cast<void>(query.contacts(way.at(step, lever, centre), points));
        const ContactSums& sums = points.sums();
        most = std::max(most, sums.pairs);
        if (step > 0 && sums.pairs + before.pairs > 0) {
          found.compare(before, sums, points.rates(), motion,
                        static_cast<double>(sums.pairs + before.pairs));
        }
        before = sums;
      }
      EXPECT_GT(most, 5u);
      EXPECT_LE(found.most(), 1);
      steepest.join(found);
    }
  }
  EXPECT_GE(steepest.weight, 0.05 * near);  // the rates are not far from what happens
  EXPECT_GE(steepest.least(), 0.004 * near);
}

// Each pair for itself, where a jump cannot hide among many: what is not in the answer counts as 0.
void Lipschitz::check_pairs(double least_depth, double near) {
  Steepness steepest;
  std::size_t faded = 0;
  for (const Bodies& b : all_bodies()) {
    Query query(b.fixed, b.moving, options_);
    ContactManifold points(b.fixed, b.moving, GetParam(), {0, 0, least_depth});
    const auto pairs_at = [&](const Isometry3d& pose) {
      std::map<LeafPair, ContactSums> sums;
      for (const PairSums& pair : sums_by_pair(query, points, b.fixed, b.moving, pose)) {
        sums[pair.leaves] = pair.sums;
      }
      return sums;
    };
    for (const AxisDirection& way : b.ways) {
      SCOPED_TRACE(std::string(b.name) + ", " + way.name);
      const double lever = points.rates().lever;
      const double motion = way.motion() + 2 * rounding_of(b.fixed, points);
      const Vector3d centre = b.moving.origin();
      Steepness found;
      for (int start = 0; start < way.steps; start += 29) {  // two steps in a row here and there
        const auto before = pairs_at(way.at(start, lever, centre)),
                   after = pairs_at(way.at(start + 1, lever, centre));
        for (const auto& [pair, sums] : before) {
          const auto same = after.find(pair);
          const bool gone = same == after.end();
          found.compare(sums, gone ? ContactSums{} : same->second, points.rates(), motion, 1);
          faded += gone ? 1U : 0U;
        }
        for (const auto& [pair, sums] : after) {
          if (before.count(pair) != 0) continue;
          found.compare({}, sums, points.rates(), motion, 1);
          ++faded;
        }
      }
      EXPECT_LE(found.most(), 1);
      steepest.join(found);
    }
  }
  EXPECT_GE(steepest.weight, 0.2 * near);
  EXPECT_GE(steepest.least(), 0.03 * near);
  EXPECT_GT(faded, 10u);
}

TEST_P(Lipschitz, SumsChangeNoFasterThanTheirRates) { check_sums(-2, 1); }
TEST_P(Lipschitz, EveryPairFadesInAndOut) { check_pairs(-2, 1); }

// What bears a load, alone: from a voxel before surfaces meet.
TEST_P(Lipschitz, LoadsChangeNoFasterThanTheirRates) {
  check_sums(-1, 0.3);
  check_pairs(-1, 0.3);
}

// At every step: what has come into the answer or left it is as good as nothing on the other side.
TEST_P(Lipschitz, NothingIsLeftOfAPairThatLeaves) {
  std::size_t leaving = 0;
  for (const Bodies& b : all_bodies()) {
    Query query(b.fixed, b.moving, options_);
    ContactManifold points(b.fixed, b.moving, GetParam(), {0, 0});
    const double lever = points.rates().lever;
    const Vector3d centre = b.moving.origin();
    for (const AxisDirection& way : b.ways) {
      SCOPED_TRACE(std::string(b.name) + ", " + way.name);
      double most = 0;
      for (int start = 0; start < way.steps; start += 7) {
        const auto at = [&](int step) { return way.at(step, lever, centre); };
        const std::vector<LeafPair> first = ask(query, at(start)).leaf_pairs,
                                    second = ask(query, at(start + 1)).leaf_pairs;
        if (first == second) continue;
        for (const int side : {0, 1}) {  // what left, and what came
          const auto &in = side == 0 ? first : second, &out = side == 0 ? second : first;
          for (const PairSums& pair :
               sums_by_pair(query, points, b.fixed, b.moving, at(start + side))) {
            if (std::binary_search(out.begin(), out.end(), pair.leaves)) continue;
            most = std::max(most, pair.sums.weight / points.rates().weight);
          }
          leaving += in.size() > out.size() ? in.size() - out.size() : 0;
        }
      }
      EXPECT_LE(most, way.motion() + 2 * rounding_of(b.fixed, points));
    }
  }
  EXPECT_GT(leaving, 50u);
}

}  // namespace
}  // namespace ist::test
