// The servo through C gives the simulation's forces, in either unit.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "capi/c_bodies.h"
#include "ist/haptics/devices/device.h"
#include "ist/scene.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

constexpr int kTicks = 120;
constexpr std::uint64_t kTests = 1'000'000;

// A ball pressed on a box; `more` in [held].
std::string scene_text(const std::string& more = "") {
  return R"(unit = "mm"
rate = 500
[fixed]
shape = "box"
size = [20, 20, 6]
voxel_size = 1
[held]
shape = "sphere"
radius = 4
voxel_size = 1
translation = [0, 0, 8]
)" + more +
         R"(
[device]
kind = "hand"
damping = 3
plan = [{ time = 0, move = [0, 0, 0] }, { time = 1, move = [0, 0, -4] }]
[effects.springs]
stiffness = 20000
)";
}

class CServo : public ::testing::Test {
 protected:
  [[nodiscard]] ist_servo* open(std::int32_t unit, const std::string& text = scene_text()) const {
    const std::string file = folder_.write("scene.toml", text).string();
    auto options = sized<ist_servo_options>();
    options.unit = unit;
    options.sphere_tests = kTests;
    ist_servo* servo = nullptr;
    EXPECT_EQ(name(ist_servo_open_scene(file.c_str(), &options, &servo)), "ok")
        << ist_last_error_message();
    return servo;
  }
  [[nodiscard]] static ist_servo_info info_of(ist_servo* servo) {
    auto info = sized<ist_servo_info>();
    EXPECT_EQ(name(ist_servo_get_info(servo, &info)), "ok");
    return info;
  }
  // Into the box, 2.4 mm deep at the end, in metres and in the scene's axes.
  [[nodiscard]] static Eigen::Vector3d way(int tick) {
    return {2e-5 * tick, 0, -1e-3 - 2e-5 * tick};
  }

  const TempDir folder_;
};

TEST_F(CServo, GivesWhatTheSimulationGives) {
  ist_servo* metres = open(IST_UNIT_M);
  ist_servo* millimetres = open(IST_UNIT_MM);
  Scene scene = read_scene(folder_.path() / "scene.toml");
  scene.device = NullSettings{std::get<HandSettings>(scene.device).mechanics};
  const BuiltScene built = build_scene(scene);
  const Placement start = *built.device->read();

  const ist_servo_info in_m = info_of(metres), in_mm = info_of(millimetres);
  EXPECT_EQ(in_m.tick_seconds, built.simulation->dt());
  for (int i = 0; i < 16; ++i) {
    EXPECT_EQ(in_m.tool[i], start.isometry().data()[i]) << i;
    EXPECT_DOUBLE_EQ(in_mm.tool[i], i >= 12 && i < 15 ? 1000 * in_m.tool[i] : in_m.tool[i]) << i;
  }

  double most = 0;
  for (int tick = 0; tick < kTicks; ++tick) {
    Placement device = start;
    device.translation += way(tick);
    TickBudget budget;
    budget.contacts.tests = budget.proximity.tests = kTests;
    const Tick wanted = built.simulation->tick(device, budget);
    Eigen::Isometry3d pose = device.isometry();
    double force[3], torque[3];
    ASSERT_EQ(name(ist_servo_on_tick(metres, pose.data(), force, torque)), "ok");
    for (int i = 0; i < 3; ++i) {
      ASSERT_EQ(force[i], wanted.wrench[i]) << tick;
      ASSERT_EQ(torque[i], wanted.wrench[3 + i]) << tick;
    }
    pose.translation() *= 1000;
    ASSERT_EQ(name(ist_servo_on_tick(millimetres, pose.data(), force, torque)), "ok");
    for (int i = 0; i < 3; ++i) {
      ASSERT_NEAR(force[i], wanted.wrench[i], 1e-6) << tick;
      ASSERT_NEAR(torque[i], wanted.wrench[3 + i], 1e-8) << tick;
    }
    most = std::max(most, force[2]);
  }
  EXPECT_GT(most, 0.3);
  EXPECT_EQ(info_of(metres).ticks, std::uint64_t{kTicks});
  EXPECT_EQ(info_of(metres).held + info_of(metres).faults, 0u);
  EXPECT_EQ(name(ist_servo_free(metres)), "ok");
  EXPECT_EQ(name(ist_servo_free(millimetres)), "ok");
}

TEST_F(CServo, CountsWhatWentWrongAndComesBackSoftly) {
  ist_servo* servo = open(IST_UNIT_M);
  const ist_servo_info start = info_of(servo);
  std::array<double, 16> pose;
  std::copy_n(start.tool, 16, pose.begin());
  double force[3], torque[3];
  const auto tick = [&](double z) {
    pose[14] = z;
    return name(ist_servo_on_tick(servo, pose.data(), force, torque));
  };
  for (int i = 0; i < 200; ++i) ASSERT_EQ(tick(start.tool[14] - 1.5e-5 * i), "ok");
  const double deep = pose[14], felt = force[2];
  EXPECT_GT(felt, 0.3);
  EXPECT_EQ(tick(NAN), "pose-invalid");
  EXPECT_EQ(force[2], 0);
  EXPECT_EQ(tick(deep), "ok");
  EXPECT_LT(force[2], 0.5 * felt);
  EXPECT_EQ(info_of(servo).faults, 1u);
  EXPECT_EQ(info_of(servo).ticks, 202u);

  // The same holds without a pose, and without an array for the force or the torque.
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(tick(deep), "ok");
  const double again = force[2];
  ASSERT_GT(again, 0.3);
  for (int missing = 0; missing < 3; ++missing) {
    EXPECT_EQ(
        name(ist_servo_on_tick(servo, missing == 0 ? nullptr : pose.data(),
                               missing == 1 ? nullptr : force, missing == 2 ? nullptr : torque)),
        "null-argument");
    EXPECT_EQ(tick(deep), "ok");
    EXPECT_LT(force[2], 0.1 * again);
  }
  EXPECT_EQ(info_of(servo).faults, 4u);
  EXPECT_EQ(name(ist_servo_free(servo)), "ok");
}

// A box of 6 mm, 1 mm above a box of 20 mm whose upper face is at z = 3 mm.
std::string text_of_boxes() {
  return R"(unit = "mm"
rate = 500
[fixed]
shape = "box"
size = [20, 20, 6]
[held]
shape = "box"
size = [6, 6, 6]
translation = [0, 0, 7]
[device]
kind = "null"
damping = 3
[effects.contact]
)";
}

ist_servo_state state_of(ist_servo* servo) {
  auto state = sized<ist_servo_state>();
  EXPECT_EQ(name(ist_servo_get_state(servo, &state)), "ok") << ist_last_error_message();
  return state;
}

TEST_F(CServo, GivesTheStateOfTheLastTick) {
  ist_servo* servo = open(IST_UNIT_MM);
  EXPECT_EQ(state_of(servo).known, 0);
  EXPECT_EQ(state_of(servo).tool[15], 0);

  std::array<double, 16> pose;
  std::copy_n(info_of(servo).tool, 16, pose.begin());
  double force[3], torque[3];
  std::int64_t begin = 0;
  for (std::uint64_t tick = 0; tick < kTicks; ++tick) {
    pose[14] -= 0.02;
    ASSERT_EQ(name(ist_servo_on_tick(servo, pose.data(), force, torque)), "ok");
    const ist_servo_state state = state_of(servo);
    const ist_servo_info info = info_of(servo);
    EXPECT_EQ(state.known, 1);
    EXPECT_EQ(state.device_known, 1);
    EXPECT_EQ(state.tick, tick);
    for (std::size_t i = 0; i < 16; ++i) {
      EXPECT_DOUBLE_EQ(state.device[i], pose[i]) << i;
      EXPECT_EQ(state.tool[i], info.tool[i]) << i;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(state.force[i], force[i]);
      EXPECT_EQ(state.torque[i], torque[i]);
    }
    EXPECT_EQ(state.fault + state.held, 0);
    EXPECT_GT(state.begin_ns, begin);
    EXPECT_GE(state.execution_ns, 0);
    begin = state.begin_ns;
  }
  EXPECT_GT(force[2], 0.3);

  pose[14] = NAN;
  EXPECT_EQ(name(ist_servo_on_tick(servo, pose.data(), force, torque)), "pose-invalid");
  const ist_servo_state state = state_of(servo);
  EXPECT_EQ(state.tick, std::uint64_t{kTicks});
  EXPECT_EQ(state.fault, 1);
  EXPECT_EQ(state.device_known, 0);
  EXPECT_EQ(state.force[2], 0);
  EXPECT_EQ(name(ist_servo_free(servo)), "ok");
}

TEST_F(CServo, GivesTheContactsInTheUnitOfThePoses) {
  for (const std::int32_t unit : {IST_UNIT_MM, IST_UNIT_M}) {
    const double scale = unit == IST_UNIT_MM ? 1 : 1e-3;
    ist_servo* servo = open(unit, text_of_boxes());
    std::array<double, 16> pose;
    std::copy_n(info_of(servo).tool, 16, pose.begin());
    double force[3], torque[3];
    for (int tick = 0; tick < 400; ++tick) {
      if (tick < 150) pose[14] -= 0.02 * scale;
      ASSERT_EQ(name(ist_servo_on_tick(servo, pose.data(), force, torque)), "ok");
      if (tick == 0) {
        EXPECT_EQ(state_of(servo).contact_count, 0u);
      }
    }
    const ist_servo_state state = state_of(servo);
    ASSERT_GE(state.contact_count, 1u);
    ASSERT_LE(state.contact_count, std::uint64_t{IST_MOST_SERVO_CONTACTS});
    EXPECT_GE(state.steps, 1);
    double borne = 0;
    for (std::size_t i = 0; i < state.contact_count; ++i) {
      const ist_servo_contact& contact = state.contacts[i];
      EXPECT_NEAR(contact.position[2], 3 * scale, 1e-6 * scale);
      EXPECT_LE(std::abs(contact.position[0]), 3.01 * scale);
      EXPECT_NEAR(contact.normal[2], 1, 1e-9);
      EXPECT_GT(contact.gap, 0);
      EXPECT_LT(contact.gap, 0.1 * scale);
      EXPECT_EQ(contact.fixed, 0u);
      EXPECT_EQ(contact.held, 1u);
      borne += contact.force[2];
    }
    EXPECT_GT(borne, 0.5);
    EXPECT_NEAR(borne, force[2], 0.01) << "at rest the contacts bear the hand's force";
    const ist_servo_contact none{};
    for (std::size_t i = state.contact_count; i < IST_MOST_SERVO_CONTACTS; ++i) {
      EXPECT_EQ(std::memcmp(&state.contacts[i], &none, sizeof none), 0) << i;
    }
    EXPECT_EQ(name(ist_servo_free(servo)), "ok");
  }
}

// The scene's bodies intersect: the tool starts elsewhere, with a warning.
TEST_F(CServo, TellsWhatBuildingWarnedOf) {
  ist_servo* servo =
      open(IST_UNIT_MM,
           scene_text("open = \"z\"\n").replace(scene_text().find("0, 0, 8"), 7, "0, 0, 5"));
  const char* warning = ist_servo_warning(servo, 0);
  ASSERT_NE(warning, nullptr);
  EXPECT_NE(std::string(warning).find("held.open"), std::string::npos) << warning;
  EXPECT_EQ(ist_servo_warning(servo, 100), nullptr);
  EXPECT_EQ(name(ist_servo_free(servo)), "ok");
}

// A plate, a ball of radius 4 that the hand holds, and a piece beside it that it may take.
std::string text_of_bodies() {
  std::string text = scene_text();
  const auto replace = [&](const std::string& part, const std::string& by) {
    text.replace(text.find(part), part.size(), by);
  };
  replace("[fixed]", "[[fixed]]\nname = \"plate\"");
  replace("[held]", R"([[fixed]]
name = "piece"
shape = "box"
size = [4, 4, 4]
voxel_size = 1
translation = [9, 0, 8]
attachable = true
[held]
name = "tool")");
  return text;
}

ist_servo_body body_of(ist_servo* servo, std::size_t index) {
  auto body = sized<ist_servo_body>();
  EXPECT_EQ(name(ist_servo_get_body(servo, index, &body)), "ok") << ist_last_error_message();
  return body;
}

TEST_F(CServo, TakesAndReleasesBodies) {
  ist_servo* servo = open(IST_UNIT_MM, text_of_bodies());
  ASSERT_EQ(info_of(servo).bodies, 3u);
  EXPECT_STREQ(body_of(servo, 0).name, "plate");
  EXPECT_STREQ(body_of(servo, 1).name, "piece");
  EXPECT_EQ(body_of(servo, 1).held, 0);
  EXPECT_EQ(body_of(servo, 2).held, 1);
  EXPECT_EQ(body_of(servo, 1).pose[12], 9);
  EXPECT_EQ(body_of(servo, 1).pose[14], 8);

  const auto refused = [&](ist_status status, const char* by, const char* what) {
    EXPECT_EQ(name(status), by);
    EXPECT_NE(std::string(ist_last_error_message()).find(what), std::string::npos)
        << ist_last_error_message();
  };
  refused(ist_servo_attach(servo, "plate"), "change-refused", "attachable = true");
  refused(ist_servo_release(servo, "piece"), "change-refused", "there already");
  refused(ist_servo_attach(servo, "peace"), "argument-invalid", "no body called peace");
  refused(ist_servo_attach(servo, nullptr), "null-argument", "body");
  auto beyond = sized<ist_servo_body>();
  refused(ist_servo_get_body(servo, 3, &beyond), "argument-invalid", "3 bodies");

  // Along x to the piece, and pressed on it.
  double pose[16], force[3], torque[3];
  std::copy_n(info_of(servo).tool, 16, pose);
  const double start = pose[12];
  for (int tick = 0; tick < 600; ++tick) {
    pose[12] = start + std::min(5.0, 0.01 * tick);
    ASSERT_EQ(name(ist_servo_on_tick(servo, pose, force, torque)), "ok");
  }
  EXPECT_LT(force[0], -0.2);
  refused(ist_servo_attach(servo, "piece"), "change-refused", "something touches piece");
  for (int tick = 0; tick < 600; ++tick) {
    pose[12] = start + std::max(1.0, 5 - 0.01 * tick);
    ASSERT_EQ(name(ist_servo_on_tick(servo, pose, force, torque)), "ok");
  }
  ASSERT_EQ(name(ist_servo_attach(servo, "piece")), "ok") << ist_last_error_message();
  EXPECT_EQ(body_of(servo, 1).held, 1);
  pose[13] += 2;
  for (int tick = 0; tick < 600; ++tick) {
    ASSERT_EQ(name(ist_servo_on_tick(servo, pose, force, torque)), "ok");
  }
  EXPECT_NEAR(body_of(servo, 1).pose[13], 2, 1e-3) << "it goes with the tool";
  ASSERT_EQ(name(ist_servo_release(servo, "piece")), "ok");
  EXPECT_EQ(body_of(servo, 1).held, 0);
  EXPECT_EQ(ist_servo_free(servo), IST_OK);
}

}  // namespace
}  // namespace ist::test
