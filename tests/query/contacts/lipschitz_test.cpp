#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "query/contacts/contact_cases.h"
#include "query/scenes.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

inline constexpr double kStep = 1e-4;  // mm, of a way

/// A way of the moving body: steps of kStep, or turns about the origin of its tree's frame by as
/// much at the lever.
struct Way {
  const char* name;
  Eigen::Isometry3d from;
  Eigen::Vector3d along = Eigen::Vector3d::Zero();  // of unit length, or nothing
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();   // of unit length, or nothing
  int steps;

  [[nodiscard]] Eigen::Isometry3d at(int step, double lever, const Eigen::Vector3d& centre) const {
    Eigen::Isometry3d pose = from;
    pose.translation() += kStep * step * along;
    if (axis.norm() > 0) {
      pose = pose * Eigen::Translation3d(centre) * Eigen::AngleAxisd(kStep * step / lever, axis) *
             Eigen::Translation3d(-centre);
    }
    return pose;
  }
  [[nodiscard]] double motion() const { return kStep * ((along.norm() + axis.norm()) * 1.000001); }
};

/// Two bodies, and ways of the moving one.
struct TravelBodies {
  const char* name;
  SphereTree fixed, moving;
  std::vector<Way> ways;
};

/// Some of all kinds, in millimetres; voxels of 0.4 mm and coarser, so that a step is little.
[[nodiscard]] std::vector<TravelBodies> all_bodies();

/// Two bodies on one way: their contacts at each step, and the length of a step.
class Travel {
 public:
  Travel(const TravelBodies& bodies, const Way& way, SpherePolicy policy, double margin)
      : bodies_(bodies),
        way_(way),
        query_(bodies.fixed, bodies.moving, options_of(policy)),
        manifold_(bodies.fixed, bodies.moving, policy, {.points = 0, .margin = margin}) {}

  [[nodiscard]] const ContactRates& rates() const { return manifold_.rates(); }
  [[nodiscard]] int steps() const { return way_.steps; }
  /// The length of a step, mm, with the rounding of both its ends.
  [[nodiscard]] double motion() const {
    return way_.motion() + 2 * rounding_of(bodies_.fixed, manifold_);
  }
  [[nodiscard]] std::vector<LeafPair> leaf_pairs(int step) {
    return ask(query_, at(step)).leaf_pairs;
  }
  [[nodiscard]] ContactSums sums(int step) {
    static_cast<void>(query_.contacts(at(step), manifold_));
    return manifold_.sums();
  }
  /// The sums of each pair with a weight.
  [[nodiscard]] std::map<LeafPair, ContactSums> sums_of_pairs(int step) {
    std::map<LeafPair, ContactSums> sums;
    for (const PairSums& pair :
         sums_by_pair(query_, manifold_, bodies_.fixed, bodies_.moving, at(step))) {
      sums[pair.leaves] = pair.sums;
    }
    return sums;
  }

 private:
  [[nodiscard]] Eigen::Isometry3d at(int step) const {
    return way_.at(step, rates().lever, bodies_.moving.origin());
  }
  const TravelBodies& bodies_;
  const Way& way_;
  Query query_;
  ContactManifold manifold_;
};

/// `check` of all bodies on all their ways.
template <class Check>
void for_each_travel(SpherePolicy policy, double margin, const Check& check) {
  for (const TravelBodies& bodies : all_bodies()) {
    for (const Way& way : bodies.ways) {
      SCOPED_TRACE(std::string(bodies.name) + ", " + way.name);
      Travel travel(bodies, way, policy, margin);
      check(travel);
    }
  }
}

using Eigen::Vector3d;

std::vector<TravelBodies> all_bodies() {
  const TriangleMesh ball = icosphere(3, 2), block = box({-2, -2, -1}, {2, 2, 1}),
                     cube = box({-1, -1, -1}, {1, 1, 1});
  const Vector3d x = Vector3d::UnitX(), z = Vector3d::UnitZ(),
                 slope = Vector3d(3, -1, 2) / std::sqrt(14.0);
  const Vector3d none = Vector3d::Zero();
  Random random(11);
  const Eigen::Matrix3d turn = random.rotation();
  std::vector<TravelBodies> bodies;
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

// Rates are bounds; what happens must come so near to them, or they say nothing.
struct Nearness {
  double weight;  // of the weight
  double all;     // of each of the five sums
};
// A rate has the steepest share, the greatest depth and the farthest position at once, which no
// pair has: a weight reaches a fifth of its rate, a torque to a thirtieth.
constexpr Nearness kOfAPair{0.2, 0.03};
// And the bound of a sum has all its pairs change by as much the same way, before and after.
constexpr Nearness kOfASum{0.05, 0.0039};
// If springs begin at a margin below 2, the steepest fade by depth adds to the rate.
constexpr double kOfLoads = 0.3;

// The bounds are not far from what happens.
void expect_near(const Steepness& steepest, const Nearness& near, double part) {
  EXPECT_GE(steepest.weight, part * near.weight);
  EXPECT_GE(steepest.least(), part * near.all);
}

// The sums of all pairs, through first contacts, along and across voxels' faces and while turning.
void check_sums(SpherePolicy policy, double margin, double part) {
  Steepness steepest;
  for_each_travel(policy, margin, [&](Travel& travel) {
    Steepness found;
    ContactSums before = travel.sums(0);
    std::uint64_t most = before.pairs;
    for (int step = 1; step <= travel.steps(); ++step) {
      const ContactSums sums = travel.sums(step);
      most = std::max(most, sums.pairs);
      if (const std::uint64_t pairs = sums.pairs + before.pairs; pairs > 0) {
        found.compare(before, sums, travel.rates(), travel.motion(), static_cast<double>(pairs));
      }
      before = sums;
    }
    EXPECT_GT(most, 5u);
    EXPECT_LE(found.most(), 1);
    steepest.join(found);
  });
  expect_near(steepest, kOfASum, part);
}

// Compares each pair by itself, so that no jump hides among many. A pair that is not in the answer
// counts as 0.
void check_pairs(SpherePolicy policy, double margin, double part) {
  constexpr int kStride = 29;  // two steps in a row here and there
  Steepness steepest;
  std::size_t faded = 0;
  for_each_travel(policy, margin, [&](Travel& travel) {
    Steepness found;
    for (int step = 0; step < travel.steps(); step += kStride) {
      auto before = travel.sums_of_pairs(step), after = travel.sums_of_pairs(step + 1);
      for (const auto& [pair, sums] : before) faded += after.try_emplace(pair).second ? 1U : 0U;
      for (const auto& [pair, sums] : after) {
        faded += before.try_emplace(pair).second ? 1U : 0U;
        found.compare(before[pair], sums, travel.rates(), travel.motion(), 1);
      }
    }
    EXPECT_LE(found.most(), 1);
    steepest.join(found);
  });
  expect_near(steepest, kOfAPair, part);
  EXPECT_GT(faded, 10u);
}

class Lipschitz : public ::testing::TestWithParam<SpherePolicy> {};

INSTANTIATE_TEST_SUITE_P(Policies, Lipschitz, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

TEST_P(Lipschitz, SumsChangeNoFasterThanTheirRates) { check_sums(GetParam(), 2, 1); }
TEST_P(Lipschitz, EveryPairFadesInAndOut) { check_pairs(GetParam(), 2, 1); }

// What bears a load, alone: from a voxel before surfaces meet.
TEST_P(Lipschitz, LoadsChangeNoFasterThanTheirRates) { check_sums(GetParam(), 1, kOfLoads); }
TEST_P(Lipschitz, EveryLoadFadesInAndOut) { check_pairs(GetParam(), 1, kOfLoads); }

// At every step, a pair that enters or leaves the answer weighs almost 0.
TEST_P(Lipschitz, NothingIsLeftOfAPairThatLeaves) {
  constexpr int kStride = 7;
  std::size_t leaving = 0;
  for_each_travel(GetParam(), 2, [&](Travel& travel) {
    double most = 0;  // of a pair in one answer that is not in the other
    const auto compare = [&](int step, const std::vector<LeafPair>& in,
                             const std::vector<LeafPair>& out) {
      for (const auto& [pair, sums] : travel.sums_of_pairs(step)) {
        if (std::binary_search(out.begin(), out.end(), pair)) continue;
        most = std::max(most, sums.weight / travel.rates().weight);
      }
      leaving += in.size() > out.size() ? in.size() - out.size() : 0;
    };
    for (int step = 0; step < travel.steps(); step += kStride) {
      const auto first = travel.leaf_pairs(step), second = travel.leaf_pairs(step + 1);
      if (first == second) continue;
      compare(step, first, second);
      compare(step + 1, second, first);
    }
    EXPECT_LE(most, travel.motion());
  });
  EXPECT_GT(leaving, 50u);
}

}  // namespace
}  // namespace ist::test
