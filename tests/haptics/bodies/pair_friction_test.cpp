// Friction sticks pair by pair of bodies.

#include <gtest/gtest.h>

#include "haptics/bodies/body_cases.h"
#include "haptics/effects/effect_case.h"
#include "loop/haptics/effects/friction_effect.h"
#include "loop/haptics/simulation_parts.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

constexpr FrictionSettings kSticky{
    .static_coefficient = 1, .dynamic_coefficient = 0.8, .stiffness = 500};

SphereTree half_millimetre_voxels(const TriangleMesh& mesh) {
  return build_tree(mesh, {.voxel_size = 0.5});
}

// A ball that is pressed on a plate, z = 0, and on another one, x = 0, which moves along y by
// 0.02 mm from 0.5 s to 0.7 s.
class TwoPlates : public ::testing::Test {
 protected:
  TwoPlates() : simulation_(made()) {}

  Tick press(int ticks) {
    Tick tick{};
    for (int i = 0; i < ticks; ++i, ++ticks_) {
      const double part = std::min(1.0, ticks_ / 200.0);
      tick = simulation_.tick(moved_by(start_, part * Vector3d(3.5, 0, -3)));
      EXPECT_FALSE(tick.held || tick.fault);
    }
    return tick;
  }
  [[nodiscard]] const FrictionEffect& friction() const { return *friction_; }

 private:
  Simulation made() {
    const Placement home{Eigen::Matrix3d::Identity(), 1e-3 * Vector3d(-6.5, 0, 6)};
    start_ = {home.rotation, home.translation + 1e-3 * ball_.origin()};
    const Placement moved{Eigen::Matrix3d::Identity(), 1e-3 * Vector3d(0, 0.02, 0)};
    BodyPart side{.name = "side", .place = {}, .centre = side_.origin(), .radius = 0.04};
    side.script = Plan({{0, {}}, {0.5, {}}, {0.7, moved}});
    detail::SimulationParts parts{
        .bodies = HandBodies(1e-3, start_,
                             {{"floor", {}, floor_.origin(), 0.04},
                              std::move(side),
                              {"ball", home, ball_.origin(), 0.006, true}}),
        .max_step = 5e-4,
        .start = start_,
        .dt = 1e-3};
    for (const std::size_t fixed : {0u, 1u}) {
      parts.contacts.add({fixed, 2},
                         std::make_unique<ToolContactQuery>(
                             fixed == 0 ? floor_ : side_, ball_, parts.bodies.frames(fixed, 2),
                             ToolContactOptions{.policy = SpherePolicy::kSlab}));
    }
    auto contact = std::make_unique<ContactEffect>(ContactSettings{});
    auto friction = std::make_unique<FrictionEffect>(kSticky, *contact, parts.contacts.size());
    friction_ = friction.get();
    parts.effects.push_back(std::move(contact));
    parts.effects.push_back(std::move(friction));
    return detail::simulation_from(std::move(parts));
  }

  const SphereTree floor_ = half_millimetre_voxels(box({-20, -20, -4}, {4, 20, 0})),
                   side_ = half_millimetre_voxels(box({0, -20, 1}, {4, 20, 20})),
                   ball_ = half_millimetre_voxels(icosphere(4, 5));
  Placement start_;
  const FrictionEffect* friction_ = nullptr;
  Simulation simulation_;
  int ticks_ = 0;
};

TEST_F(TwoPlates, EachHoldByTheirOwnAnchor) {
  const Tick pressed = press(450);
  ASSERT_LT(pressed.wrench[0], -0.5);
  ASSERT_GT(pressed.wrench[2], 0.5);
  ASSERT_TRUE(friction().anchor(0) && friction().anchor(1));
  ASSERT_FALSE(friction().slides(0) || friction().slides(1));
  const Placement first = *friction().anchor(0), second = *friction().anchor(1);
  EXPECT_NE(first.translation, second.translation) << "they were touched one after the other";
  const Tick drawn = press(400);
  ASSERT_FALSE(friction().slides(0) || friction().slides(1));
  EXPECT_EQ(friction().anchor(0)->translation, first.translation) << "this one rests";
  EXPECT_EQ(friction().anchor(0)->rotation, first.rotation);
  const Vector3d way = friction().anchor(1)->translation - second.translation;
  EXPECT_NEAR(way.y(), 2e-5, 1e-12) << "as far as the plate went";
  EXPECT_NEAR(way.x(), 0, 1e-15);
  EXPECT_GT(drawn.tool.translation.y() - pressed.tool.translation.y(), 1e-6)
      << "the one draws the ball, the other holds it back";
  EXPECT_LT(drawn.tool.translation.y() - pressed.tool.translation.y(), 1.9e-5);
}

// Two points under the tool, each of a pair of its own.
void touch(EffectCase& at, std::initializer_list<std::size_t> pairs) {
  at.contacts.clear();
  for (const std::size_t pair : pairs) {
    at.contacts.begin_pair(pair);
    const double x = pair == 0 ? 0.01 : -0.01;
    at.add_contact({{x, 0, 0}, {0, 0, 1}, 1e-3, 1});
  }
}

// An effect for two pairs of bodies, and its tool.
struct TwoGrips {
  ContactEffect contact{{1000, 0.5}};
  FrictionEffect friction{kSticky, contact, 2};
  EffectCase at;

  TwoGrips() { at.contacts = ToolContacts(2); }
  void slide(double way) {
    const Vector6 motion = six({0, way, 0}, Vector3d::Zero());
    friction.advance(at.input(), motion);
    at.tool = at.tool.moved(motion);
  }
  [[nodiscard]] double force() const { return respond(friction, at).wrench[1]; }
};

// Each pulls from where it stuck, not from where the other did.
TEST(PairFriction, PullsFromEachAnchor) {
  TwoGrips grips;
  touch(grips.at, {0});
  grips.slide(1e-4);
  EXPECT_NEAR(grips.force(), -500 * 1e-4, 1e-12);
  EXPECT_FALSE(grips.friction.anchor(1));
  touch(grips.at, {0, 1});
  grips.slide(1e-4);
  EXPECT_NEAR(grips.force(), -500 * 2e-4 - 500 * 1e-4, 1e-12);
}

// The hand took the body: the pair is not asked, and begins anew where it is asked again.
TEST(PairFriction, OfAPairThatIsNotAskedIsForgotten) {
  for (const std::size_t lost : {0u, 1u}) {
    TwoGrips grips;
    touch(grips.at, {0, 1});
    grips.slide(1e-4);
    ASSERT_TRUE(grips.friction.anchor(0) && grips.friction.anchor(1));
    touch(grips.at, {1 - lost});
    grips.slide(1e-4);
    EXPECT_FALSE(grips.friction.anchor(lost));
    EXPECT_TRUE(grips.friction.anchor(1 - lost));
    EXPECT_NEAR(grips.force(), -500 * 2e-4, 1e-12);
    touch(grips.at, {0, 1});
    EXPECT_NEAR(grips.force(), -500 * 2e-4, 1e-12) << "nothing is left of what it held";
  }
}

}  // namespace
}  // namespace ist::test
