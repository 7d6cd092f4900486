#include "ist/haptics/servo_callback.h"

#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <cmath>
#include <limits>

#include "haptics/haptic_cases.h"
#include "ist/base/error.h"
#include "support/fake_scheduler.h"

namespace ist::test {
namespace {

constexpr std::uint64_t kCalls = 600;

int call_back(void* user, const double pose[16], double force[3], double torque[3]) {
  auto& callback = *static_cast<ServoCallback*>(user);
  return static_cast<int>(callback.on_tick(std::span<const double, 16>(pose, 16),
                                           std::span<double, 3>(force, 3),
                                           std::span<double, 3>(torque, 3)));
}

// The ball above the box, pressed on it along -z at 5 mm/s from 1 mm above, and turned a little: in
// metres divided by `unit`.
class PressingPath {
 public:
  PressingPath(const HapticBodies& bodies, double unit) : bodies_(bodies), unit_(unit) {}

  [[nodiscard]] Placement at(double time) const {
    Placement placement = bodies_.at(1e-3 - 5e-3 * time);
    placement.rotation = Eigen::AngleAxisd(0.2 * time, Eigen::Vector3d(1, 2, 2) / 3).matrix();
    return placement;
  }
  void operator()(double time, double pose[16]) const {
    Eigen::Isometry3d isometry = at(time).isometry();
    isometry.translation() /= unit_;
    std::copy_n(isometry.data(), 16, pose);
  }

 private:
  const HapticBodies& bodies_;
  double unit_;
};

class Callback : public ::testing::Test {
 protected:
  // By tests, so that no answer hangs on the clock.
  [[nodiscard]] static ServoCallbackOptions by_tests(double unit = 1) {
    return {.unit = unit, .sphere_tests = 1'000'000};
  }
  [[nodiscard]] FakeScheduler scheduler(ServoCallback& callback, double unit = 1) const {
    return {call_back, &callback, PressingPath(bodies_, unit)};
  }

  const HapticBodies bodies_ = ball_over_box();
  Simulation simulation_ = bodies_.simulation();
};

TEST_F(Callback, GivesWhatTheSimulationGivesBitForBit) {
  ServoCallback callback(simulation_, by_tests());
  const std::vector<FakeScheduler::Call> calls = scheduler(callback).run(kCalls);
  ASSERT_EQ(calls.size(), kCalls);
  Simulation plain = bodies_.simulation();
  const PressingPath path(bodies_, 1);
  double felt = 0, turned = 0;
  for (const FakeScheduler::Call& call : calls) {
    TickBudget budget;
    budget.contacts.tests = budget.proximity.tests = 1'000'000;
    const Tick tick = plain.tick(Placement::from(path.at(call.time).isometry()), budget);
    EXPECT_EQ(call.answer, static_cast<int>(ServoTick::kFine));
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(call.force[i], tick.wrench[i]);
      EXPECT_EQ(call.torque[i], tick.wrench[3 + i]);
    }
    felt = std::max(felt, call.force[2]);
    turned = std::max(turned, Eigen::Map<const Eigen::Vector3d>(call.torque).norm());
  }
  EXPECT_GT(felt, 0.5);
  EXPECT_GT(turned, 1e-4);
  EXPECT_EQ(callback.counts().ticks, kCalls);
  EXPECT_EQ(callback.counts().held + callback.counts().faults, 0u);
}

TEST_F(Callback, SpeaksMillimetresWhereTheyAreDeclared) {
  ServoCallback metres(simulation_, by_tests());
  Simulation other = bodies_.simulation();
  ServoCallback millimetres(other, by_tests(1e-3));
  EXPECT_NEAR(millimetres.tool()[14], 1e3 * metres.tool()[14], 1e-12);
  const auto a = scheduler(metres).run(kCalls), b = scheduler(millimetres, 1e-3).run(kCalls);
  double felt = 0;
  for (std::size_t i = 0; i < kCalls; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(a[i].force[axis], b[i].force[axis], 1e-6);
      EXPECT_NEAR(a[i].torque[axis], b[i].torque[axis], 1e-9);
    }
    felt = std::max(felt, b[i].force[2]);
  }
  EXPECT_GT(felt, 0.5);
  EXPECT_NEAR(millimetres.tool()[14], 1e3 * metres.tool()[14], 1e-6);
}

TEST_F(Callback, ToldWhereTheToolIs) {
  ServoCallback callback(simulation_, by_tests());
  const Placement start = bodies_.at(1e-3);
  const ServoCallback::Pose before = callback.tool();
  EXPECT_EQ(before[14], start.translation.z());
  EXPECT_EQ(before[0], 1.0);
  EXPECT_EQ(before[15], 1.0);
  static_cast<void>(scheduler(callback).run(kCalls));
  // The device goes 2 mm in, the tool stays out.
  EXPECT_GT(callback.tool()[14], bodies_.touching() - bodies_.voxel());
  EXPECT_LT(callback.tool()[14], start.translation.z());
}

TEST_F(Callback, APoseThatIsNoneIsAFaultAndNothingIsFelt) {
  ServoCallback callback(simulation_, by_tests());
  static_cast<void>(scheduler(callback).run(kCalls));
  double good[16], force[3], torque[3];
  PressingPath(bodies_, 1)(0.6, good);
  EXPECT_EQ(call_back(&callback, good, force, torque), static_cast<int>(ServoTick::kFine));
  ASSERT_GT(force[2], 0.5);
  const ServoCallback::Pose before = callback.tool();
  const auto expect_fault = [&](int entry, double value) {
    double pose[16];
    std::copy_n(good, 16, pose);
    pose[entry] = value;
    EXPECT_EQ(call_back(&callback, pose, force, torque), static_cast<int>(ServoTick::kFault));
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(force[i], 0.0);
      EXPECT_EQ(torque[i], 0.0);
    }
  };
  for (int entry = 0; entry < 16; ++entry) {
    expect_fault(entry, std::nan(""));
    expect_fault(entry, std::numeric_limits<double>::infinity());
  }
  expect_fault(0, -good[0]);  // not orthonormal any more
  expect_fault(3, 0.5);       // a last row of no motion, as of a transposed pose
  EXPECT_EQ(callback.counts().faults, 34u);
  EXPECT_EQ(callback.tool(), before);
  // Then little by little.
  EXPECT_EQ(call_back(&callback, good, force, torque), static_cast<int>(ServoTick::kFine));
  EXPECT_GT(force[2], 0.0);
  EXPECT_LE(force[2], kHapticSafety.max_force * 1e-3 / kHapticSafety.soft_start * (1 + 1e-9));
}

// Whoever calls late or not at all gets no kick: force never changes faster than it may, per call.
TEST_F(Callback, DroppedAndLateCallsGiveNoKick) {
  ServoCallback callback(simulation_, by_tests());
  FakeScheduler fake = scheduler(callback);
  fake.drop(250, 20);
  fake.drop(400, 1);
  fake.delay(330, 7e-4);
  fake.delay(500, 5e-3);
  const std::vector<FakeScheduler::Call> calls = fake.run(kCalls);
  ASSERT_EQ(calls.size(), kCalls - 21);
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  for (const FakeScheduler::Call& call : calls) {
    EXPECT_EQ(call.answer, static_cast<int>(ServoTick::kFine));
    const Eigen::Vector3d force(call.force);
    EXPECT_LE((force - last).norm(), kHapticSafety.force_slew * 1e-3 * (1 + 1e-9));
    EXPECT_LE(force.norm(), kHapticSafety.max_force * (1 + 1e-9));
    last = force;
  }
  EXPECT_GT(last.z(), 0.5);
}

TEST_F(Callback, HoldsTheToolWhereThereIsNoTime) {
  ServoCallback callback(simulation_, {.sphere_tests = 0});
  const std::vector<FakeScheduler::Call> calls = scheduler(callback).run(20);
  for (const FakeScheduler::Call& call : calls) {
    EXPECT_EQ(call.answer, static_cast<int>(ServoTick::kHeld));
  }
  EXPECT_EQ(callback.counts().held, 20u);
  EXPECT_EQ(callback.tool()[14], bodies_.at(1e-3).translation.z());

  // By the clock: a fraction that is over when the query begins.
  Simulation other = bodies_.simulation();
  ServoCallback hasty(other, {.query_time_fraction = 1e-9});
  EXPECT_EQ(scheduler(hasty).run(1).front().answer, static_cast<int>(ServoTick::kHeld));
}

TEST_F(Callback, TheCallersArithmeticChangesNothing) {
  ServoCallback callback(simulation_, by_tests(1e-3));
  const auto expected = scheduler(callback, 1e-3).run(kCalls);
  Simulation other = bodies_.simulation();
  ServoCallback again(other, by_tests(1e-3));
  FakeScheduler fake(
      [](void* user, const double pose[16], double force[3], double torque[3]) {
        const unsigned saved = _mm_getcsr();
        constexpr unsigned kUpFlushing = 0x1F80 | 0x4000 | 0x8000 | 0x0040;
        _mm_setcsr(kUpFlushing);
        const int answer = call_back(user, pose, force, torque);
        EXPECT_EQ(_mm_getcsr(), kUpFlushing);
        _mm_setcsr(saved);
        return answer;
      },
      &again, PressingPath(bodies_, 1e-3));
  const auto got = fake.run(kCalls);
  for (std::size_t i = 0; i < kCalls; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(got[i].force[axis], expected[i].force[axis]);
      EXPECT_EQ(got[i].torque[axis], expected[i].torque[axis]);
    }
  }
}

TEST_F(Callback, RefusesSettingsWithoutSense) {
  const double none = std::nan(""), endless = std::numeric_limits<double>::infinity();
  const auto refuses = [&](const ServoCallbackOptions& options) {
    try {
      ServoCallback(simulation_, options);
    } catch (const Error& error) {
      return error.code() == ErrorCode::kArgumentInvalid;
    }
    return false;
  };
  for (const double unit : {0.0, -1.0, none, endless}) EXPECT_TRUE(refuses({.unit = unit})) << unit;
  for (const double fraction : {0.0, -0.5, 1.01, none}) {
    EXPECT_TRUE(refuses({.query_time_fraction = fraction})) << fraction;
  }
  EXPECT_FALSE(refuses({.query_time_fraction = 1}));
}

}  // namespace
}  // namespace ist::test
