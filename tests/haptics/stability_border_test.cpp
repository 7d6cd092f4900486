#include "loop/haptics/stability_border.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "ist/models/models.h"
#include "ist/tree/sphere_tree.h"
#include "loop/haptics/tool.h"
#include "query/query_cases.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// A triangle is nowhere farther away than at a corner.
double farthest_vertex(const TriangleMesh& mesh, const Eigen::Vector3d& origin) {
  double farthest = 0;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    farthest = std::max(farthest, (vertex - origin).norm());
  }
  return farthest;
}

void expect_radius_of(const TriangleMesh& mesh, double voxel_size) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  options.spheres = SpherePolicy::kSimple;
  const SphereTree tree = build_tree(mesh, options);
  const double farthest = farthest_vertex(mesh, tree.origin());
  const double radius = surface_radius(tree);
  EXPECT_GE(radius, farthest) << voxel_size;
  EXPECT_LE(radius, (farthest + 2 * std::sqrt(3.0) * voxel_size) * (1 + 1e-8)) << voxel_size;
}

TEST(SurfaceRadius, HoldsAllVerticesAndNotMuchMore) {
  Random random(11);
  for (int i = 0; i < samples(60); ++i) {
    const TriangleMesh mesh = turned(
        moved(icosphere(1, random.uniform(0.1, 5)), random.point(-20, 20)), random.rotation());
    expect_radius_of(mesh, random.uniform(0.02, 6));
    expect_radius_of(open_strip(1 + i % 60), random.uniform(0.05, 4));
  }
  expect_radius_of(make_jaw(Jaw::kLower, 1), 1);
}

TEST(SurfaceRadius, OfASingleVoxelHoldsItToo) {
  expect_radius_of(box({3, 3, 3}, {4, 4, 4}), 1);
  expect_radius_of(triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 50);
}

constexpr CouplingSettings kCoupling{.stiffness = 1000,
                                     .damping = 1,
                                     .angular_stiffness = 0.5,
                                     .angular_damping = 0.001,
                                     .max_force = 8,
                                     .max_torque = 0.3};

// The least damping of a device on which the coupling is passive: Colgate and Schenkel's condition
// (1997, theorem 1) as it stands, over many frequencies up to half the rate.
double damping_needed(double stiffness, double damping, double period, int periods_of_delay) {
  using namespace std::complex_literals;
  constexpr int kFrequencies = 4000;
  double needed = -1e300;
  for (int i = 1; i <= kFrequencies; ++i) {
    const double angle = std::numbers::pi * i / kFrequencies;
    const std::complex<double> back = std::exp(-1i * angle);  // 1/z
    const std::complex<double> coupling =
        (stiffness + damping / period * (1.0 - back)) * std::pow(back, periods_of_delay);
    needed =
        std::max(needed, period / 2 / (1 - std::cos(angle)) * std::real((1.0 - back) * coupling));
  }
  return needed;
}

TEST(StabilityBorder, IsTheFormula) {
  EXPECT_DOUBLE_EQ(largest_stiffness(5, 1, 1e-3, 0), 8000);
  EXPECT_DOUBLE_EQ(largest_stiffness(5, 1, 1e-3, 1.5e-3), 2000);
  EXPECT_DOUBLE_EQ(largest_stiffness(5, -1, 1e-4, 0), 80000);
  for (const double damping : {1.0, -1.0, 2.0, 1e9}) {
    EXPECT_EQ(largest_stiffness(1, damping, 1e-3, 0), 0) << damping;
  }
  EXPECT_EQ(largest_stiffness(0, 0, 1e-3, 1e-3), 0);
}

TEST(StabilityBorder, FallsWithDelayPeriodAndCouplingDampingAndGrowsWithTheDevices) {
  Random random(3);
  for (int i = 0; i < samples(1000); ++i) {
    const double b = random.uniform(1, 20), own = random.uniform(0, 0.9);
    const double period = random.uniform(1e-4, 2e-3), delay = random.uniform(0, 5e-3);
    const double largest = largest_stiffness(b, own, period, delay);
    EXPECT_GT(largest, 0);
    EXPECT_LT(largest, largest_stiffness(1.01 * b, own, period, delay));
    EXPECT_GT(largest, largest_stiffness(b, own + 0.01, period, delay));
    EXPECT_GT(largest, largest_stiffness(b, own, 1.01 * period, delay));
    EXPECT_GT(largest, largest_stiffness(b, own, period, delay + 1e-5));
  }
}

TEST(StabilityBorder, OfASpringIsThatOfThePassivityConditionAndWithADamperWithinIt) {
  Random random(4);
  for (int i = 0; i < samples(100); ++i) {
    const double b = random.uniform(0.5, 20), period = random.uniform(1e-4, 2e-3);
    const int delay = static_cast<int>(random.below(11));
    const double spring = largest_stiffness(b, 0, period, delay * period);
    // The lowest frequency looked at is 1/4000 of the way; the largest value is at 0.
    EXPECT_NEAR(damping_needed(spring, 0, period, delay) / b, 1, 1e-4);

    const double own = random.uniform(-0.95, 0.95) * b;
    const double damped = largest_stiffness(b, own, period, delay * period);
    EXPECT_LE(damping_needed(damped, own, period, delay), b * (1 + 1e-9));
  }
}

TEST(StabilityBorder, WithoutDelayIsThatOfThePassivityConditionForEitherSignOfDamping) {
  // A damper needs most at half the rate, a negative one at frequency 0; the spring the same at
  // all.
  for (const double own : {2.0, -2.0}) {
    EXPECT_NEAR(damping_needed(largest_stiffness(6, own, 1e-3, 0), own, 1e-3, 0), 6, 1e-4);
  }
}

TEST(ClampCoupling, LeavesWhatIsWithinTheBorderBitForBit) {
  const DeviceMechanics device{.damping = 3, .angular_damping = 0.005, .delay = 0.5e-3};
  const ClampedCoupling result = clamp_coupling(kCoupling, device, 1e-3);
  EXPECT_FALSE(result.clamped());
  EXPECT_EQ(result.settings.stiffness, kCoupling.stiffness);
  EXPECT_EQ(result.settings.damping, kCoupling.damping);
  EXPECT_EQ(result.settings.angular_stiffness, kCoupling.angular_stiffness);
  EXPECT_EQ(result.settings.angular_damping, kCoupling.angular_damping);
  EXPECT_DOUBLE_EQ(result.stiffness.largest, 2000);
  EXPECT_DOUBLE_EQ(result.angular_stiffness.largest, 4);
}

TEST(ClampCoupling, ClampsStiffnessBelowTheLargestAndSaysSo) {
  const DeviceMechanics device{.damping = 2, .angular_damping = 0.0015, .delay = 0.5e-3};
  CouplingSettings asked = kCoupling;
  asked.angular_damping = 0.0005;
  asked.angular_stiffness = 3;
  const ClampedCoupling result = clamp_coupling(asked, device, 1e-3);
  EXPECT_TRUE(result.stiffness.clamped());
  EXPECT_EQ(result.stiffness.asked, 1000);
  EXPECT_DOUBLE_EQ(result.stiffness.largest, 1000);
  EXPECT_DOUBLE_EQ(result.stiffness.used, 800);
  EXPECT_EQ(result.settings.stiffness, result.stiffness.used);
  EXPECT_FALSE(result.damping.clamped());
  EXPECT_TRUE(result.angular_stiffness.clamped());
  EXPECT_DOUBLE_EQ(result.angular_stiffness.largest, 1);
  EXPECT_DOUBLE_EQ(result.settings.angular_stiffness, 0.8);
  EXPECT_FALSE(result.angular_damping.clamped());
  EXPECT_EQ(result.settings.max_force, asked.max_force);
  EXPECT_EQ(result.settings.max_torque, asked.max_torque);
}

TEST(ClampCoupling, IsExactAtTheBorder) {
  const DeviceMechanics device{.damping = 3, .angular_damping = 0.003, .delay = 0};
  CouplingSettings asked = kCoupling;
  asked.stiffness = 0.8 * largest_stiffness(3, asked.damping, 1e-3, 0);
  EXPECT_FALSE(clamp_coupling(asked, device, 1e-3).stiffness.clamped());
  const double border = asked.stiffness;
  asked.stiffness = std::nextafter(border, 1e9);
  const ClampedCoupling result = clamp_coupling(asked, device, 1e-3);
  EXPECT_TRUE(result.stiffness.clamped());
  EXPECT_TRUE(result.clamped());
  EXPECT_EQ(result.settings.stiffness, border);
}

TEST(ClampCoupling, LimitsDampingToHalfOfTheDevicesBeforeStiffness) {
  const DeviceMechanics device{.damping = 0.5, .angular_damping = 1, .delay = 0};
  const ClampedCoupling result = clamp_coupling(kCoupling, device, 1e-3);
  EXPECT_TRUE(result.damping.clamped());
  EXPECT_EQ(result.damping.asked, 1);
  EXPECT_EQ(result.damping.largest, 0.25);
  EXPECT_EQ(result.settings.damping, 0.25);
  EXPECT_DOUBLE_EQ(result.stiffness.largest, 500);
  EXPECT_DOUBLE_EQ(result.settings.stiffness, 400);
  EXPECT_FALSE(result.angular_damping.clamped());
  EXPECT_FALSE(result.angular_stiffness.clamped());
}

TEST(ClampCoupling, LeavesNothingToADeviceWithoutDamping) {
  const ClampedCoupling result = clamp_coupling(kCoupling, {}, 1e-3);
  EXPECT_EQ(result.settings.damping, 0);
  EXPECT_EQ(result.settings.stiffness, 0);
  EXPECT_EQ(result.settings.angular_damping, 0);
  EXPECT_EQ(result.settings.angular_stiffness, 0);
  EXPECT_TRUE(result.clamped());
}

TEST(ClampCoupling, WhatItGivesIsPassiveForAnythingAsked) {
  Random random(5);
  for (int i = 0; i < samples(100); ++i) {
    const int periods = static_cast<int>(random.below(6));
    const double period = random.uniform(1e-4, 2e-3);
    const DeviceMechanics device{.damping = random.uniform(0.1, 20),
                                 .angular_damping = random.uniform(1e-3, 0.1),
                                 .delay = periods * period};
    CouplingSettings asked = kCoupling;
    asked.stiffness = random.uniform(0, 1e5);
    asked.damping = random.uniform(0, 40);
    asked.angular_stiffness = random.uniform(0, 200);
    asked.angular_damping = random.uniform(0, 0.2);
    const CouplingSettings given = clamp_coupling(asked, device, period).settings;
    EXPECT_LE(damping_needed(given.stiffness, given.damping, period, periods), device.damping);
    EXPECT_LE(damping_needed(given.angular_stiffness, given.angular_damping, period, periods),
              device.angular_damping);
    EXPECT_LE(given.stiffness, asked.stiffness);
    EXPECT_LE(given.damping, asked.damping);
  }
}

}  // namespace
}  // namespace ist::test
