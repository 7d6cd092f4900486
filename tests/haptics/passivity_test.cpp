#include <gtest/gtest.h>

#include <vector>

#include "haptics/wall_press.h"
#include "loop/haptics/stability_border.h"
#include "support/effort.h"

namespace ist::test {
namespace {

constexpr double kInside = 0.8;  // what clamp_coupling() leaves of the border
constexpr double kBeyond = 2;    // at which a wall is surely active

// Beyond the border a coupling is as stiff, at 4 kHz, as the wall, which is no stiff wall then.
const std::vector<double> kRates = {500, 1000, 4000}, kRatesOfStiffWalls = {500, 1000};

// Each rate with no delay and with 1 ms, each damping of the device; the coupling has none.
std::vector<PressSettings> points(const std::vector<double>& rates,
                                  const std::vector<double>& dampings, double resolution) {
  std::vector<PressSettings> points;
  for (const double rate : rates) {
    for (const double delay : {0.0, 1e-3}) {
      for (const double damping : dampings) {
        points.push_back({.rate = rate,
                          .delay = delay,
                          .damping = damping,
                          .stiffness = largest_stiffness(damping, 0, 1 / rate, delay),
                          .coupling_damping = 0,
                          .resolution = resolution});
      }
    }
  }
  return points;
}

std::string told(const PressSettings& settings) {
  return std::to_string(settings.rate) + " Hz, delay " + std::to_string(settings.delay) + ", b " +
         std::to_string(settings.damping) + ", K " + std::to_string(settings.stiffness) + ", B " +
         std::to_string(settings.coupling_damping);
}

void expect_passive(const PressedWall& wall, PressSettings settings) {
  settings.stiffness = kInside * largest_stiffness(settings.damping, settings.coupling_damping,
                                                   1 / settings.rate, settings.delay);
  const PressResult result = press(wall, settings);
  EXPECT_GT(result.most_felt, 0.02) << "nothing was pressed: " << told(settings);
  EXPECT_LE(result.returned, result.allowance) << told(settings);
  EXPECT_LT(result.growth(), 1) << told(settings);
}

void expect_active(const PressedWall& wall, PressSettings settings) {
  settings.stiffness *= kBeyond;
  const PressResult result = press(wall, settings);
  EXPECT_GT(result.returned, result.allowance) << told(settings);
}

TEST(Passivity, OfAPushHoldsWithinTheBorder) {
  const PressedWall wall = slab_wall(Stop::kSprings);
  for (const PressSettings& settings : points(kRates, {1, 4}, 2e-6)) expect_passive(wall, settings);
}

TEST(Passivity, OfAPushHoldsWithADamperInTheCoupling) {
  const PressedWall wall = slab_wall(Stop::kSprings);
  for (PressSettings settings : points(kRates, {2}, 2e-6)) {
    settings.coupling_damping = 0.5 * settings.damping;
    expect_passive(wall, settings);
  }
}

TEST(Passivity, OfAPushEndsBeyondTheBorder) {
  const PressedWall wall = slab_wall(Stop::kSprings);
  for (const PressSettings& settings : points(kRatesOfStiffWalls, {2}, 2e-6)) {
    expect_active(wall, settings);
  }
}

TEST(Passivity, OfATurnHoldsWithinTheBorder) {
  IST_SLOW();
  const PressedWall wall = stop_wall(Stop::kSprings);
  for (const PressSettings& settings : points(kRates, {1e-3, 2e-3}, 2e-5))
    expect_passive(wall, settings);
}

TEST(Passivity, OfATurnEndsBeyondTheBorder) {
  const PressedWall wall = stop_wall(Stop::kSprings);
  for (const PressSettings& settings : points(kRatesOfStiffWalls, {2e-3}, 2e-5)) {
    expect_active(wall, settings);
  }
}

// A contact's force that came a tick behind its depth would be active here.
TEST(Passivity, OnATipHoldsWhereContactsBegin) {
  const PressedWall wall = tip_wall(Stop::kSprings);
  for (const PressSettings& settings : points(kRates, {2}, 2e-6)) expect_passive(wall, settings);
}

// Within so much of the border as computed, for the contact is not quite rigid.
TEST(Passivity, EndsWhereTheBorderIs) {
  const PressedWall wall = slab_wall(Stop::kSprings);
  const PressSettings settings{.resolution = 2e-6};
  const double computed = largest_stiffness(settings.damping, 0, 1 / settings.rate, 0);
  const double measured = measured_border(wall, settings, computed);
  EXPECT_GT(measured, computed);
  EXPECT_LT(measured, 1.25 * computed);
}

}  // namespace
}  // namespace ist::test
