// Scenes that a program makes, with effects of its own.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "ist/base/error.h"
#include "ist/haptics.h"
#include "scene/scene_case.h"
#include "support/errors.h"

namespace ist::test {
namespace {

constexpr double kPush = 0.25;  // N

// Counts the contacts of each tick and pushes the tool along x.
class Push final : public Effect {
 public:
  struct Seen {
    double contacts = 0;
    int ticks = 0, proximity = 0;
  };
  Push(const EffectNeeds& needs, Seen& seen) : needs_(needs), seen_(seen) {}

  [[nodiscard]] std::string_view name() const noexcept override { return "push"; }
  [[nodiscard]] EffectNeeds needs() const noexcept override { return needs_; }
  void respond(const EffectInput&, const Vector6&, Response& response) const noexcept override {
    response.wrench[0] += kPush;
  }
  void advance(const EffectInput& input, const Vector6&) noexcept override {
    ++seen_.ticks;
    seen_.contacts = std::max(seen_.contacts, input.contacts.count);
    seen_.proximity += input.proximity.points().empty() ? 0 : 1;
  }

 private:
  EffectNeeds needs_;
  Seen& seen_;
};

std::vector<std::unique_ptr<Effect>> push(const EffectNeeds& needs, Push::Seen& seen) {
  std::vector<std::unique_ptr<Effect>> own;
  own.push_back(std::make_unique<Push>(needs, seen));
  return own;
}

// A ball 6 mm above a box, which a hand presses on it.
Scene ball_on_box() {
  Scene scene{.unit = 1e-3};
  scene.fixed.front().source = BuiltInShape{.size = Eigen::Vector3d(40, 40, 10)};
  scene.fixed.front().voxel_size = 1;
  scene.held.front().source = BuiltInShape{.kind = BuiltInShape::Kind::kSphere, .radius = 5};
  scene.held.front().voxel_size = 0.5;
  scene.held.front().translation = {0, 0, 11};
  const Placement down{Eigen::Matrix3d::Identity(), {0, 0, -2e-3}};
  scene.device = HandSettings{.plan = {{0, {}}, {0.2, down}, {0.4, down}}};
  return scene;
}

Tick run(const BuiltScene& built, int ticks) {
  Tick tick;
  for (int i = 0; i < ticks; ++i) {
    tick = built.simulation->tick(built.device->read());
    built.device->write(tick.wrench, built.simulation->dt());
  }
  return tick;
}

TEST(MadeScene, RunsWithoutAFile) {
  Scene scene = ball_on_box();
  scene.springs = SpringsSettings{};
  const Scene copy = scene;  // a scene may be copied
  const BuiltScene built = build_scene(copy);
  const Tick tick = run(built, 400);
  EXPECT_GT(tick.leaf_pairs, 0);
  EXPECT_GT(tick.wrench[2], 0.1);
}

TEST(MadeScene, AnOwnEffectIsFeltAndTimed) {
  Push::Seen seen;
  const BuiltScene built = build_scene(ball_on_box(), push({}, seen));
  ASSERT_EQ(built.simulation->effects().size(), 1u);
  EXPECT_EQ(built.simulation->effects()[0].name, "push");
  EXPECT_EQ(built.trees.front().contact, nullptr);
  const Tick tick = run(built, 600);
  EXPECT_NEAR(tick.wrench[0], kPush, 1e-3);
  EXPECT_EQ(seen.ticks, 599);
  EXPECT_EQ(seen.contacts, 0);
  EXPECT_GT(built.simulation->effects()[0].time.count(), 0);
}

// What an effect of the caller's needs is built, and is its input.
TEST(MadeScene, TheNeedsOfAnOwnEffectAreBuilt) {
  Push::Seen seen;
  const BuiltScene built = build_scene(ball_on_box(), push({.normals = true, .depth = true}, seen));
  ASSERT_NE(built.trees.front().contact, nullptr);
  EXPECT_EQ(built.trees.front().near, nullptr);
  EXPECT_EQ(built.trees.front().contact->triangles(), nullptr);
  EXPECT_TRUE(run(built, 400).contacts);
  EXPECT_GT(seen.contacts, 1);

  const BuiltScene exact = build_scene(ball_on_box(), push({.triangles = true}, seen));
  ASSERT_NE(exact.trees.front().contact, nullptr);
  EXPECT_NE(exact.trees.front().contact->triangles(), nullptr);
}

TEST(MadeScene, AnOwnEffectMayNeedProximityWithItsTable) {
  Push::Seen seen;
  const std::optional<Error> error = error_of(
      [&] { static_cast<void>(build_scene(ball_on_box(), push({.proximity = true}, seen))); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
  EXPECT_NE(std::string(error->what()).find("effects.proximity: an effect needs proximity voxels"),
            std::string::npos)
      << error->what();
  Scene scene = ball_on_box();
  scene.proximity = ProximitySettings{.distance = 3e-3, .damping = 0};
  static_cast<void>(run(build_scene(scene, push({.proximity = true}, seen)), 400));
  EXPECT_GT(seen.proximity, 50);
}

TEST(MadeScene, ANullEffectIsRefused) {
  std::vector<std::unique_ptr<Effect>> own;
  own.emplace_back();
  const std::optional<Error> error =
      error_of([&] { static_cast<void>(build_scene(ball_on_box(), std::move(own))); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kArgumentInvalid);
}

TEST(MadeScene, ValuesOutOfRangeAreRefused) {
  const auto refusal = [](const std::function<void(Scene&)>& change) -> std::string {
    Scene scene = ball_on_box();
    change(scene);
    const std::optional<Error> error = error_of([&] { static_cast<void>(build_scene(scene)); });
    if (!error) return "fine";
    return error->what();
  };
  EXPECT_EQ(refusal([](Scene&) {}), "fine");
  EXPECT_EQ(refusal([](Scene& s) { s.unit = 0; }),
            "the scene's unit: it is 0 m: give a positive length");
  EXPECT_EQ(refusal([](Scene& s) { s.rate = std::nan(""); }),
            "the scene's rate: it is nan: give a number from 1 to 10000 Hz");
  EXPECT_EQ(refusal([](Scene& s) { s.workers = 3; }), "the scene's workers: it is 3: give 1 or 2");
  EXPECT_EQ(
      refusal([](Scene& s) {
        s.contact.reset();
        s.friction.reset();
        s.springs = SpringsSettings{};
        s.held.front().voxel_size.reset();
      }),
      "the scene's held.voxel_size: springs act between voxels: give the edge of a voxel, or write "
      "[effects.contact] in place of [effects.springs]");
  for (const auto& change : std::vector<std::function<void(Scene&)>>{
           [](Scene& s) { s.rate = 1e5; },
           [](Scene& s) { s.fixed.front().rotation *= 2; },
           [](Scene& s) { s.fixed.front().translation.x() = std::nan(""); },
           [](Scene& s) { s.device = HandSettings{}; },
           [](Scene& s) { s.device = ScriptSettings{}; },
           [](Scene& s) { s.device = NullSettings{{.damping = -1}}; },
           [](Scene& s) { s.coupling.stiffness = std::nan(""); },
           [](Scene& s) { s.safety.force_slew = 0; },
           [](Scene& s) { s.springs = SpringsSettings{.margin = 1}; },
           [](Scene& s) { s.springs = SpringsSettings{.margin = -1e-5}; },
           [](Scene& s) { s.springs = SpringsSettings{.full_area = std::nan("")}; },
           [](Scene& s) { s.springs = SpringsSettings{.stiffness = 1e3}; },
           [](Scene& s) { s.contact = ContactSettings{.skin = -1}; },
           [](Scene& s) { s.contact = ContactSettings{.trust = std::nan("")}; },
           [](Scene& s) { s.contact = ContactSettings{.steps = 0}; },
           [](Scene& s) { s.friction = FrictionSettings{}; },
           [](Scene& s) { s.damping = DampingSettings{}; },
           [](Scene& s) {
             s.contact = ContactSettings{};
             s.springs = SpringsSettings{};
           },
           [](Scene& s) { s.proximity = ProximitySettings{}; },
           [](Scene& s) { s.gravity = SceneGravity{}; },
           [](Scene& s) {
             s.contact = ContactSettings{};
             s.friction = FrictionSettings{.coefficient = -0.1};
           },
           [](Scene& s) {
             s.gravity = SceneGravity{.mass = 1};
             s.gravity->acceleration = {0, std::nan(""), 0};
           },
           [](Scene& s) { s.open = Eigen::Vector3d::Zero(); },
           [](Scene& s) { s.open = Eigen::Vector3d(0, 0, std::nan("")); },
           [](Scene& s) { s.snap = SnapSettings{}; }}) {
    EXPECT_TRUE(refusal(change).starts_with("the scene's ")) << refusal(change);
  }
}

}  // namespace
}  // namespace ist::test
