#include "loop/haptics/wrench_limiter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/effort.h"
#include "support/random.h"

namespace ist::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kDt = 0x1p-10;  // sums of it are exact
constexpr SafetySettings kSettings{
    .max_force = 5, .max_torque = 0.25, .force_slew = 400, .torque_slew = 30, .soft_start = 0.25};

Vector6 wrench(double fx, double fy, double fz, double tx, double ty, double tz) {
  Vector6 w;
  w << fx, fy, fz, tx, ty, tz;
  return w;
}

// A guard whose soft start is over.
WrenchLimiter started(const SafetySettings& settings = kSettings) {
  WrenchLimiter guard(settings);
  while (guard.gain() < 1) static_cast<void>(guard.limit(Vector6::Zero(), kDt));
  return guard;
}

// Small, large and huge numbers, now and then infinity or NaN.
Vector6 any_wrench(Random& random) {
  Vector6 w;
  const double scale = std::pow(10.0, random.uniform(-3, 3));
  for (int i = 0; i < 6; ++i) w[i] = random.uniform(-scale, scale);
  switch (random.below(60)) {
    case 0:
      w[random.below(6)] = kNan;
      break;
    case 1:
      w[random.below(6)] = random.below(2) == 0 ? kInfinity : -kInfinity;
      break;
    case 2:
      w[random.below(6)] = std::numeric_limits<double>::max();
      break;
    case 3:
      w.setConstant(-std::numeric_limits<double>::max());
      break;
    case 4:
      w.setConstant(std::numeric_limits<double>::denorm_min());
      break;
    default:
      break;
  }
  return w;
}

TEST(WrenchLimiter, KeepsItsBoundsForAnyInput) {
  Random random(1);
  const auto& s = kSettings;
  std::uint64_t faults = 0;
  int at_the_limit = 0, at_the_slew = 0;
  WrenchLimiter guard(s);
  Vector6 last = Vector6::Zero(), wanted = last;
  for (int i = 0; i < samples(200'000); ++i) {
    // Most stay for a while, so that the output arrives.
    if (random.below(10) == 0 || !wanted.allFinite()) wanted = any_wrench(random);
    const double dt = random.uniform(1e-4, 1e-2);
    const Vector6 output = guard.limit(wanted, dt);
    ASSERT_TRUE(output.allFinite()) << wanted;
    const double force = output.head<3>().norm(), torque = output.tail<3>().norm();
    ASSERT_LE(force, s.max_force * guard.gain() + 1e-15 * s.max_force);
    ASSERT_LE(torque, s.max_torque * guard.gain() + 1e-15 * s.max_torque);
    if (!wanted.allFinite()) {
      ++faults;
      ASSERT_TRUE((output.array() == 0).all());
      ASSERT_EQ(guard.gain(), 0);
    } else {
      const double change = (output - last).head<3>().norm();
      ASSERT_LE(change, s.force_slew * dt + 1e-15 * s.max_force);
      ASSERT_LE((output - last).tail<3>().norm(), s.torque_slew * dt + 1e-15 * s.max_torque);
      at_the_limit += force > 0.999 * s.max_force ? 1 : 0;
      at_the_slew += change > 0.999 * s.force_slew * dt ? 1 : 0;
    }
    ASSERT_EQ(guard.faults(), faults);
    last = output;
  }
  EXPECT_GT(faults, samples(300U));
  EXPECT_GT(at_the_limit, samples(3'000));
  EXPECT_GT(at_the_slew, samples(12'000));
}

TEST(WrenchLimiter, PassesBitForBitWhatBreaksNoLimit) {
  Random random(2);
  SafetySettings settings = kSettings;
  settings.force_slew = 2 * settings.max_force / kDt;
  settings.torque_slew = 2 * settings.max_torque / kDt;
  WrenchLimiter guard = started(settings);
  for (int i = 0; i < samples(10'000); ++i) {
    Vector6 wanted;
    wanted << random.uniform(0, settings.max_force) * random.direction(),
        random.uniform(0, settings.max_torque) * random.direction();
    ASSERT_EQ(guard.limit(wanted, kDt), wanted);
  }
  const Vector6 at_the_limit = wrench(3, 0, -4, 0, 0.25, 0);
  EXPECT_EQ(guard.limit(at_the_limit, kDt), at_the_limit);
  EXPECT_EQ(guard.faults(), 0U);
}

TEST(WrenchLimiter, ScalesWhatIsTooLongAndKeepsItsDirection) {
  SafetySettings settings = kSettings;
  settings.force_slew = settings.torque_slew = 1e9;
  for (const double length : {6.0, 1e10, 1e300}) {
    WrenchLimiter guard = started(settings);
    const Vector6 output = guard.limit(length * wrench(0.6, 0, -0.8, 0, 0.8, 0.6), kDt);
    EXPECT_LE((output - wrench(3, 0, -4, 0, 0.2, 0.15)).norm(), 1e-15) << length;
  }
  // A force that is too long leaves a torque that is not as it is.
  WrenchLimiter guard = started(settings);
  EXPECT_EQ(guard.limit(wrench(0, 10, 0, 0.1, 0, 0.05), kDt), wrench(0, 5, 0, 0.1, 0, 0.05));
}

TEST(WrenchLimiter, GoesToANewWrenchAtItsSlewAndArrives) {
  WrenchLimiter guard = started();
  const Vector6 wanted = wrench(0, 3, 0, 0.125, 0, 0);
  const double force_step = kSettings.force_slew * kDt, torque_step = kSettings.torque_slew * kDt;
  for (int tick = 1; tick <= 10; ++tick) {
    const Vector6 output = guard.limit(wanted, kDt);
    EXPECT_NEAR(output[1], std::min(3.0, tick * force_step), 1e-15);
    EXPECT_NEAR(output[3], std::min(0.125, tick * torque_step), 1e-16);
  }
  EXPECT_EQ(guard.limit(wanted, kDt), wanted);
}

TEST(WrenchLimiter, StartsSoftlyAndExactly) {
  const Vector6 wanted = wrench(1, -2, 0.5, 0.125, 0, -0.0625);
  WrenchLimiter guard(kSettings);
  EXPECT_EQ(guard.gain(), 0);
  constexpr int kTicks = 256;  // 0.25 s of 1/1024
  for (int round = 0; round < 2; ++round) {
    for (int tick = 1; tick <= kTicks + 5; ++tick) {
      const Vector6 output = guard.limit(wanted, kDt);
      const double gain = std::min(1.0, static_cast<double>(tick) / kTicks);
      ASSERT_EQ(guard.gain(), gain);
      ASSERT_EQ(output, gain * wanted) << tick;
    }
    guard.fault();
  }
}

TEST(WrenchLimiter, AFaultIsZeroAtOnceWhateverTheSlewAndComesBackSoftly) {
  for (const bool own : {true, false}) {
    WrenchLimiter guard = started();
    const Vector6 full = wrench(4, 0, 0, 0, 0.25, 0);
    for (int i = 0; i < 100; ++i) static_cast<void>(guard.limit(full, kDt));
    ASSERT_EQ(guard.limit(full, kDt), full);
    Vector6 bad = full;
    bad[5] = kNan;
    const Vector6 output = own ? guard.fault() : guard.limit(bad, kDt);
    EXPECT_TRUE((output.array() == 0).all());
    EXPECT_EQ(guard.gain(), 0);
    EXPECT_EQ(guard.faults(), 1U);
    EXPECT_EQ(guard.limit(full, kDt), full / 256);
    // A second fault within the soft start begins it anew.
    guard.fault();
    EXPECT_EQ(guard.limit(full, kDt), full / 256);
    EXPECT_EQ(guard.faults(), 2U);
  }
}

TEST(WrenchLimiter, ATickThatLastsNoTimeIsAFault) {
  for (const double dt : {0.0, -1e-3, kNan, kInfinity}) {
    WrenchLimiter guard = started();
    static_cast<void>(guard.limit(wrench(0.1, 0, 0, 0, 0, 0), kDt));
    EXPECT_TRUE((guard.limit(wrench(0.1, 0, 0, 0, 0, 0), dt).array() == 0).all()) << dt;
    EXPECT_EQ(guard.faults(), 1U) << dt;
  }
}

TEST(WrenchLimiter, WithoutASoftStartTheFirstTickHasAll) {
  SafetySettings settings = kSettings;
  settings.soft_start = 0;
  WrenchLimiter guard(settings);
  const Vector6 wanted = wrench(0.25, 0, 0, 0, 0, 0.01);
  EXPECT_EQ(guard.limit(wanted, kDt), wanted);
  guard.fault();
  EXPECT_EQ(guard.limit(wanted, kDt), wanted);
}

}  // namespace
}  // namespace ist::test
