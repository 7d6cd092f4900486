// A hand that takes bodies and releases them: where it may, and what it feels.

#include <gtest/gtest.h>

#include <cstring>

#include "haptics/bodies/body_cases.h"
#include "ist/haptics/recording.h"
#include "ist/haptics/simulation.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kFloor = 0, kLoose = 3, kTool = 4;

class HandChanges : public ::testing::TestWithParam<Keeps> {
 protected:
  HandChanges() : built_(build_scene(five_bodies(GetParam()))), start_(simulation().tool_pose()) {}

  [[nodiscard]] Simulation& simulation() { return *built_.simulation; }
  // Ticks along a straight line to a place, 10 µm each, and some more to come to rest.
  Tick go(const Vector3d& to, int rest = 300) {
    Tick tick{};
    while ((to - at_).norm() > 1e-2) {
      at_ += 1e-2 * (to - at_).normalized();
      tick = felt(simulation().tick(moved_by(start_, at_)));
    }
    at_ = to;
    for (int i = 0; i < rest; ++i) tick = felt(simulation().tick(moved_by(start_, at_)));
    return tick;
  }
  // The force changes within what the limiter allows.
  Tick felt(const Tick& tick) {
    const SafetySettings safety;
    EXPECT_LE((tick.wrench - last_).head<3>().norm(),
              safety.force_slew * simulation().dt() * (1 + 1e-9));
    EXPECT_LE((tick.wrench - last_).tail<3>().norm(),
              safety.torque_slew * simulation().dt() * (1 + 1e-9));
    EXPECT_FALSE(tick.fault || tick.held);
    last_ = tick.wrench;
    return tick;
  }

  BuiltScene built_;
  Placement start_;
  Vector3d at_ = Vector3d::Zero();  // of the device, mm from the start
  Vector6 last_ = Vector6::Zero();
};

INSTANTIATE_TEST_SUITE_P(, HandChanges, ::testing::Values(Keeps::kContact, Keeps::kSprings),
                         name_of);

class HandChangeCase : public ::testing::TestWithParam<Keeps> {};
INSTANTIATE_TEST_SUITE_P(, HandChangeCase, ::testing::Values(Keeps::kContact, Keeps::kSprings),
                         name_of);

TEST_P(HandChanges, ATakenBodyIsCarriedAndFelt) {
  go({0, 10, 5}, 600);
  ASSERT_EQ(simulation().attach(kLoose), ChangeStatus::kDone);
  EXPECT_TRUE(simulation().is_held(kLoose));
  const Vector3d before = simulation().body_pose(kLoose).translation;
  go({0, 10, 10});
  EXPECT_NEAR((simulation().body_pose(kLoose).translation - before).z(), 5e-3, 1e-6);
  // The loose ball's lowest point was 1.5 mm above the floor, the tool's 1 mm. Lowered by 5 mm the
  // tool alone would touch it.
  const Tick both = go({0, 10, -2}, 600);
  EXPECT_GT(both.wrench[2], 0.5);
  // With the ball turned down, the tool's side is up: the wall on the right is felt by the ball.
  const Tick aside = go({10, 10, 6}, 600);
  EXPECT_LT(aside.wrench[0], -0.5);
}

TEST_P(HandChanges, AReleasedBodyStaysAndIsFeltAsAFixedOne) {
  go({0, 10, 5}, 600);
  ASSERT_EQ(simulation().attach(kLoose), ChangeStatus::kDone);
  go({0, 10, 15});
  const Placement there = simulation().body_pose(kLoose);
  ASSERT_EQ(simulation().release(kLoose), ChangeStatus::kDone);
  EXPECT_FALSE(simulation().is_held(kLoose));
  go({0, 5, 15});
  EXPECT_EQ(simulation().body_pose(kLoose).translation, there.translation);
  EXPECT_EQ(simulation().body_pose(kLoose).rotation, there.rotation);
  go({0, 5, 9.5});  // the same height
  const Tick pressed = go({0, 24, 9.5}, 600);
  EXPECT_LT(pressed.wrench[1], -0.3) << "it is in the way";
  EXPECT_EQ(simulation().body_pose(kLoose).translation, there.translation);
}

TEST_P(HandChanges, IsRefusedWhileSomethingTouches) {
  go({0, 0, -2}, 600);  // the tool is pressed on the floor
  EXPECT_EQ(simulation().attach(kLoose), ChangeStatus::kTouching);
  go({0, 22.5, 0.1}, 600);  // the tool is pressed on the loose ball
  EXPECT_EQ(simulation().attach(kLoose), ChangeStatus::kTouching);
  EXPECT_FALSE(simulation().is_held(kLoose));
  go({0, 0, 5}, 600);
  EXPECT_EQ(simulation().attach(kLoose), ChangeStatus::kDone);
}

// A body that lies on the floor is touched by it, and is not taken.
TEST_P(HandChangeCase, OfABodyThatAnotherTouchesIsRefused) {
  Scene scene = five_bodies(GetParam());
  scene.fixed.back().translation.z() = 3.95;
  const BuiltScene built = build_scene(scene);
  const Placement before = built.simulation->body_pose(kLoose);
  EXPECT_EQ(built.simulation->attach(kLoose), ChangeStatus::kTouching);
  EXPECT_FALSE(built.simulation->is_held(kLoose));
  EXPECT_EQ(built.simulation->body_pose(kLoose).translation, before.translation);
}

TEST_P(HandChanges, OfTheWrongBodiesAreRefused) {
  Simulation& hand = simulation();
  EXPECT_EQ(hand.attach(5), ChangeStatus::kUnknownBody);
  EXPECT_EQ(hand.release(99), ChangeStatus::kUnknownBody);
  EXPECT_EQ(hand.attach(kFloor), ChangeStatus::kFixedForGood);
  EXPECT_EQ(hand.release(kTool), ChangeStatus::kFixedForGood);
  EXPECT_EQ(hand.release(kLoose), ChangeStatus::kAlreadyThere);
  ASSERT_EQ(hand.attach(kLoose), ChangeStatus::kDone);
  EXPECT_EQ(hand.attach(kLoose), ChangeStatus::kAlreadyThere);
}

TEST_P(HandChanges, WithoutTimeForTheQueriesAreRefused) {
  go({0, 10, 0.5});
  TickBudget none;
  none.contacts.tests = none.change.tests = 0;
  EXPECT_EQ(simulation().attach(kLoose, none), ChangeStatus::kUnfinished);
  EXPECT_FALSE(simulation().is_held(kLoose));
  ASSERT_EQ(simulation().attach(kLoose), ChangeStatus::kDone);
  // The balls are far apart, which contact knows without a search.
  const bool knows = GetParam() == Keeps::kContact;
  EXPECT_EQ(simulation().release(kLoose, none),
            knows ? ChangeStatus::kDone : ChangeStatus::kUnfinished);
  EXPECT_EQ(simulation().is_held(kLoose), !knows);
}

// Released while it is pressed on the floor: the force fades, the hand is thrown nowhere.
TEST_P(HandChanges, AReleaseUnderForceDoesNotLeap) {
  go({0, 10, 5}, 600);
  ASSERT_EQ(simulation().attach(kLoose), ChangeStatus::kDone);
  const Tick pressed = go({0, 10, -2.5}, 600);
  ASSERT_GT(pressed.wrench[2], 0.5);
  ASSERT_EQ(simulation().release(kLoose), ChangeStatus::kDone);
  go({0, 10, -2.5}, 600);
}

// The hand may be empty, and then feels nothing.
TEST_P(HandChangeCase, OfTheLastHeldBodyLeavesAnEmptyHand) {
  Scene scene = five_bodies(GetParam());
  scene.held.front().attachable = true;
  const BuiltScene built = build_scene(scene);
  Simulation& hand = *built.simulation;
  const Placement start = hand.tool_pose();
  ASSERT_EQ(hand.release(kTool), ChangeStatus::kDone);
  Tick tick{};
  for (int i = 0; i < 2000; ++i) tick = hand.tick(moved_by(start, {0, 0, -5e-3 * i}));
  EXPECT_LT(tick.wrench.norm(), 1e-9);
  EXPECT_NEAR(hand.tool_pose().translation.z(), start.translation.z() - 9.995e-3, 1e-6);
  EXPECT_EQ(hand.attach(kTool), ChangeStatus::kDone) << "it takes it from afar";
}

TickBudget unlimited(int /*tick*/) { return {}; }

std::vector<TickRecord> recorded(const Scene& scene, int ticks,
                                 TickBudget (*budget_of)(int tick) = unlimited) {
  const BuiltScene built = build_scene(scene);
  std::vector<TickRecord> records;
  for (int i = 0; i < ticks; ++i) {
    const auto at = built.device->read();
    const Tick tick = built.simulation->tick(at, budget_of(i));
    built.device->write(tick.wrench, built.simulation->dt());
    records.push_back(record_of(static_cast<std::uint64_t>(i), built.simulation->dt(), tick, true));
  }
  return records;
}

// A hand that by plan takes the loose ball, presses it on the floor and leaves it there.
Scene planned(Keeps keeps) {
  Scene scene = five_bodies(keeps);
  const auto at = [](double time, double y, double z) {
    return Waypoint{time, {Eigen::Matrix3d::Identity(), {0, 1e-3 * y, 1e-3 * z}}};
  };
  scene.device = HandSettings{.plan = {at(0, 0, 0), at(0.5, 10, 5), at(1, 10, 5), at(1.5, 0, -2.5),
                                       at(2, 0, -2.5), at(2.5, -10, 10)}};
  scene.changes = {{0.9, "loose", true}, {1.8, "loose", false}, {1.9, "loose", true}};
  return scene;
}

TEST_P(HandChangeCase, ByPlanIsMadeAtItsTick) {
  const std::vector<TickRecord> records = recorded(planned(GetParam()), 2500);
  std::vector<std::pair<std::uint64_t, HandChange>> made;
  for (const TickRecord& record : records) {
    if (record.change) made.emplace_back(record.tick, *record.change);
  }
  ASSERT_EQ(made.size(), 3u);
  EXPECT_EQ(made[0].first, 900u);
  EXPECT_EQ(made[0].second.status, ChangeStatus::kDone);
  EXPECT_TRUE(made[0].second.attach);
  EXPECT_EQ(made[1].first, 1800u);
  EXPECT_EQ(made[1].second.status, ChangeStatus::kDone);
  EXPECT_EQ(made[2].first, 1900u);
  EXPECT_EQ(made[2].second.body, kLoose);
  EXPECT_EQ(made[2].second.status, ChangeStatus::kTouching) << "it was pressed into the floor";
}

// Replays with no tests for queries that a budget ended, as a reader of a recording does.
void expect_replayed(const Scene& scene, const std::vector<TickRecord>& records) {
  const BuiltScene again = build_scene(scene);
  for (const TickRecord& record : records) {
    TickBudget budget;
    if (record.contacts && !record.contacts->complete) budget.contacts.tests = 0;
    if (record.held) budget.steps = record.steps;
    if (record.change && record.change->status == ChangeStatus::kUnfinished)
      budget.change.tests = 0;
    const TickRecord same =
        replay({record.tick, to_placement(record.device), budget}, *again.simulation);
    ASSERT_EQ(same.tool, record.tool) << record.tick;
    ASSERT_EQ(same.wrench, record.wrench) << record.tick;
    ASSERT_EQ(same.held, record.held) << record.tick;
    ASSERT_EQ(same.leaf_pairs, record.leaf_pairs) << record.tick;
    ASSERT_EQ(same.point_count, record.point_count) << record.tick;
    ASSERT_EQ(same.change.has_value(), record.change.has_value()) << record.tick;
    if (same.change) {
      ASSERT_EQ(same.change->status, record.change->status) << record.tick;
    }
  }
}

TEST_P(HandChangeCase, IsReplayedToTheByte) {
  expect_replayed(planned(GetParam()), recorded(planned(GetParam()), 2500));
}

// With springs a change waits while the tick's own contacts are unfinished. If its own query is
// stopped it is not made, and the next changes meet the bodies as they are.
TEST_P(HandChangeCase, IsReplayedToTheByteWhereQueriesWereStopped) {
  Scene scene = planned(GetParam());
  std::get<HandSettings>(scene.device).plan[1].pose.translation.z() = 1e-3;
  std::get<HandSettings>(scene.device).plan[2].pose.translation.z() = 1e-3;
  const std::vector<TickRecord> records = recorded(scene, 2500, [](int tick) {
    TickBudget budget;
    if (tick >= 900 && tick < 905) budget.contacts.tests = 0;
    if (tick == 1800) budget.change.tests = 0;
    return budget;
  });
  const bool waits = GetParam() == Keeps::kSprings;
  EXPECT_TRUE(records[900].held && !records[905].held);
  std::vector<std::pair<std::uint64_t, ChangeStatus>> made;
  for (const TickRecord& record : records) {
    if (record.change) made.emplace_back(record.tick, record.change->status);
  }
  // Contact knows without a search that the released ball is far from the tool. The tool presses on
  // the floor as it is to take the ball again.
  const std::vector<std::pair<std::uint64_t, ChangeStatus>> expected = {
      {waits ? 905 : 900, ChangeStatus::kDone},
      {1800, waits ? ChangeStatus::kUnfinished : ChangeStatus::kDone},
      {1900, waits ? ChangeStatus::kAlreadyThere : ChangeStatus::kTouching}};
  EXPECT_EQ(made, expected);
  expect_replayed(scene, records);
}

}  // namespace
}  // namespace ist::test
