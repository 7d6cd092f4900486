#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "query/contacts/travels.h"

namespace ist::test {
namespace {

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
constexpr Nearness kOfASum{0.05, 0.004};
// Where springs begin at a margin below 2, a rate has the steepest fade by depth besides.
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

// Each pair for itself, where a jump cannot hide among many: what is not in the answer counts as 0.
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

// At every step: what has come into the answer or left it is as good as nothing on the other side.
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
