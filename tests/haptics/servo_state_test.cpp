// The last tick of a ServoCallback, as other threads read it.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <thread>
#include <vector>

#include "haptics/haptic_cases.h"
#include "ist/haptics/servo_callback.h"
#include "loop/haptics/simulation_parts.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr double kMillimetre = 1e-3;
constexpr std::uint64_t kTicks = 600;

// A box of 6 mm, 1 mm above a plate that it cannot enter. Millimetres.
Simulation box_over_plate() {
  const auto plate = std::make_shared<WallBody>(build_tree(box({-10, -10, -4}, {10, 10, 0})));
  const auto piece = std::make_shared<WallBody>(build_tree(box({-3, -3, 1}, {3, 3, 7})));
  const Eigen::Vector3d centre(0, 0, 4);
  const Placement home{Eigen::Matrix3d::Identity(), kMillimetre * centre};
  detail::SimulationParts parts{.coupling = kHapticCoupling,
                                .safety = kHapticSafety,
                                .max_step = std::numeric_limits<double>::infinity(),
                                .start = home,
                                .dt = 1e-3};
  parts.bodies = HandBodies(kMillimetre, home,
                            {{"plate", Placement(), {0, 0, -2}, kMillimetre * 15},
                             {"piece", Placement(), centre, kMillimetre * 6, true}});
  parts.wall.emplace(WallSettings{5e-6, 20e-6});
  parts.wall->add({0, 1}, std::make_unique<WallPair>(plate, piece, WallPair::Options{}));
  return detail::simulation_from(std::move(parts));
}

// Presses the piece 2 mm into the plate at 10 mm/s, and pushes it along x.
ServoCallback::Pose device_at(std::uint64_t tick) {
  const double time = 1e-3 * static_cast<double>(tick);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(1e-3 * time, 0, 4e-3 - std::min(3e-3, 1e-2 * time));
  ServoCallback::Pose numbers;
  std::copy_n(pose.data(), 16, numbers.begin());
  return numbers;
}

class ServoState : public ::testing::Test {
 protected:
  ServoTick tick(const ServoCallback::Pose& pose) {
    return callback_.on_tick(pose, force_, torque_);
  }

  Simulation simulation_ = box_over_plate();
  ServoCallback callback_{simulation_, {.sphere_tests = 1'000'000}};
  std::array<double, 3> force_{}, torque_{};
};

TEST_F(ServoState, IsUnknownBeforeTheFirstTick) { EXPECT_FALSE(callback_.last()); }

TEST_F(ServoState, HasThePosesTheWrenchTheContactsAndTheTimes) {
  std::size_t most = 0;
  std::int64_t begin = 0;
  const auto now = [] {
    return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  for (std::uint64_t i = 0; i < kTicks; ++i) {
    const ServoCallback::Pose device = device_at(i);
    const std::int64_t before = now();
    ASSERT_EQ(tick(device), ServoTick::kFine);
    const std::int64_t after = now();
    const std::optional<TickRecord> last = callback_.last();
    ASSERT_TRUE(last);
    EXPECT_EQ(last->tick, i);
    EXPECT_TRUE(last->device_known);
    EXPECT_FALSE(last->fault || last->held);
    EXPECT_GE(last->steps, 1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(last->device[axis], device[12 + axis]);
      EXPECT_EQ(last->tool[axis], callback_.tool()[12 + axis]);
      EXPECT_EQ(last->wrench[axis], force_[axis]);
      EXPECT_EQ(last->wrench[3 + axis], torque_[axis]);
    }
    EXPECT_LE(before, last->begin_ns);
    EXPECT_LT(begin, last->begin_ns);
    EXPECT_GE(last->execution_ns, 0);
    EXPECT_LE(last->begin_ns + last->execution_ns, after);
    begin = last->begin_ns;
    most = std::max<std::size_t>(most, last->point_count);
  }
  EXPECT_GE(most, 2u) << "the piece lies on the plate";

  // At rest on the plate the contacts bear the force of the hand.
  const TickRecord last = *callback_.last();
  ASSERT_GE(last.point_count, 1u);
  double borne = 0;
  for (std::size_t i = 0; i < last.point_count; ++i) {
    const ContactRecord& point = last.points[i];
    EXPECT_NEAR(point.position[2], 0, 1e-9);
    EXPECT_NEAR(point.normal[2], 1, 1e-9);
    EXPECT_GT(point.gap, 0);
    EXPECT_LT(point.gap, 25e-6);
    EXPECT_EQ(point.fixed, 0u);
    EXPECT_EQ(point.held, 1u);
    EXPECT_LT(point.fixed_triangle, 12u);
    EXPECT_LT(point.held_triangle, 12u);
    borne += point.force[2];
  }
  EXPECT_GT(borne, 1);
  EXPECT_NEAR(borne, last.wrench[2], 1e-3);
}

TEST_F(ServoState, HasTheFaultsToo) {
  for (std::uint64_t i = 0; i < kTicks; ++i) tick(device_at(i));
  const TickRecord before = *callback_.last();
  ASSERT_GT(before.wrench[2], 1);
  const auto expect_fault = [&](std::uint64_t number) {
    const std::optional<TickRecord> last = callback_.last();
    ASSERT_TRUE(last);
    EXPECT_EQ(last->tick, number);
    EXPECT_TRUE(last->fault);
    EXPECT_FALSE(last->device_known);
    EXPECT_EQ(last->device, before.device);
    EXPECT_EQ(last->tool, before.tool);
    EXPECT_EQ(last->wrench, (std::array<double, 6>{}));
    EXPECT_EQ(last->point_count, 0u);
  };
  callback_.fault();
  expect_fault(kTicks);
  tick(device_at(kTicks - 1));
  ServoCallback::Pose none = device_at(kTicks - 1);
  none[3] = std::nan("");
  EXPECT_EQ(tick(none), ServoTick::kFault);
  expect_fault(kTicks + 2);
}

TEST_F(ServoState, IsInMetresWhateverTheUnitOfThePoses) {
  Simulation other = box_over_plate();
  ServoCallback millimetres(other, {.unit = kMillimetre, .sphere_tests = 1'000'000});
  ServoCallback::Pose pose = device_at(100);
  tick(pose);
  for (std::size_t i = 12; i < 15; ++i) pose[i] /= kMillimetre;
  millimetres.on_tick(pose, force_, torque_);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(millimetres.last()->device[i], callback_.last()->device[i], 1e-15);
    EXPECT_NEAR(millimetres.last()->tool[i], callback_.last()->tool[i], 1e-12);
  }
}

// Another thread reads while the loop ticks. Each record that it reads is compared with the same
// tick of an earlier run, so a mixture of two ticks is noticed.
TEST(ServoStateThread, IsOneWholeTick) {
  std::array<double, 3> force, torque;
  std::vector<TickRecord> wanted;
  {
    Simulation simulation = box_over_plate();
    ServoCallback callback(simulation, {.sphere_tests = 1'000'000});
    for (std::uint64_t i = 0; i < kTicks; ++i) {
      callback.on_tick(device_at(i), force, torque);
      wanted.push_back(callback.last().value());
    }
  }
  Simulation simulation = box_over_plate();
  ServoCallback callback(simulation, {.sphere_tests = 1'000'000});
  std::atomic<bool> done{false};
  std::atomic<std::uint64_t> latest{0};
  std::uint64_t seen = 0, mixed = 0, backwards = 0;
  std::thread reader([&] {
    std::uint64_t last = 0;
    while (!done.load(std::memory_order_relaxed)) {
      const std::optional<TickRecord> record = callback.last();
      if (!record) continue;
      ++seen;
      backwards += record->tick < last ? 1U : 0U;
      last = record->tick;
      const TickRecord& tick = wanted.at(record->tick);
      const bool whole =
          record->device == tick.device && record->tool == tick.tool &&
          record->wrench == tick.wrench && record->steps == tick.steps &&
          record->point_count == tick.point_count &&
          std::equal(record->points.begin(), record->points.begin() + record->point_count,
                     tick.points.begin(), [](const ContactRecord& a, const ContactRecord& b) {
                       return a.position == b.position && a.force == b.force && a.gap == b.gap &&
                              a.held_triangle == b.held_triangle;
                     });
      mixed += whole ? 0U : 1U;
      latest.store(record->tick, std::memory_order_relaxed);
    }
  });
  // Threads may share a core. So now and then the loop waits until the reader has its tick.
  for (std::uint64_t i = 0; i < kTicks; ++i) {
    callback.on_tick(device_at(i), force, torque);
    while (i % 20 == 19 && latest.load(std::memory_order_relaxed) != i) std::this_thread::yield();
  }
  done = true;
  reader.join();
  EXPECT_GE(seen, kTicks / 20);
  EXPECT_EQ(mixed, 0u);
  EXPECT_EQ(backwards, 0u);
}

}  // namespace
}  // namespace ist::test
