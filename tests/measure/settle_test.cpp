#include "ist/measure/settle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "measure/body_pair.h"
#include "measure/settle_shapes.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/random.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;
using Pose = Eigen::Isometry3d;
using SettleStatus = Settlement::Status;
constexpr double kDegree = std::numbers::pi / 180;
const Vector kDown(0, 0, -1);

SphereTree tree_of(const TriangleMesh& mesh) { return build_tree(mesh); }

struct Rig {
  Rig(const TriangleMesh& a, const TriangleMesh& b)
      : fixed(tree_of(a)), moving(tree_of(b)), query(fixed, moving) {}
  [[nodiscard]] Settlement settle(const Pose& pose, const SettleOptions& options) {
    return ist::settle(query, pose, options);
  }
  SphereTree fixed, moving;
  Query query;
};

bool rests(const Settlement& settled) {
  return settled.status == SettleStatus::kRests || settled.status == SettleStatus::kRestsLevel;
}

// The pose, moved by a motion of the load point and about it.
Pose moved_by(const Settlement& settled, const Vector6& motion) {
  const Vector turn = motion.tail<3>();
  const double angle = turn.norm();
  const Pose pose = settled.pose();
  const Vector load = pose * settled.load_point;
  const Pose turned = angle > 0 ? turn_about(load, turn, angle) * pose : pose;
  return Eigen::Translation3d(Vector(motion.head<3>())) * turned;
}

// Tries free motions no longer than `reach`: none closes by more than what is proven.
void expect_no_farther(Rig& rig, const Settlement& settled, const Vector& closing, int tries,
                       std::uint64_t seed) {
  Random random(seed);
  int free = 0;
  double farthest = -HUGE_VAL;
  for (int i = 0; i < tries; ++i) {
    Vector6 motion;
    for (double& number : motion) number = random.uniform(-1, 1) + random.uniform(-1, 1);
    // Most motions close, by more or less.
    Vector way = motion.head<3>();
    if (way.dot(closing) < 0) way -= 2 * way.dot(closing) * closing;
    if (i % 2 == 0) way -= random.uniform(0, 1) * way.dot(closing) * closing;
    motion.head<3>() = way;
    motion *= settled.reach * std::pow(random.uniform(0, 1), 2) / motion.norm();
    motion.tail<3>() /= settled.radius;
    if (rig.query.intersects(moved_by(settled, motion)).answer != Answer::kNo) continue;
    ++free;
    farthest = std::max(farthest, motion.head<3>().dot(closing));
  }
  EXPECT_LE(farthest, settled.remaining + settled.second_order);
  EXPECT_GT(free, 0);
}

// The load and the forces of the contacts are in balance, about the load point.
void expect_balance(const Settlement& settled, const Vector& closing) {
  Vector force = closing, moment(0, 0, 0);
  const Vector load = settled.pose() * settled.load_point;
  for (const SettleContact& contact : settled.contacts) {
    EXPECT_GE(contact.force, 0);
    EXPECT_NEAR(contact.normal.norm(), 1, 1e-9);
    force += contact.force * contact.normal;
    moment += contact.force * (contact.point - load).cross(contact.normal);
  }
  EXPECT_LT(force.norm(), 2e-3);
  EXPECT_LT(moment.norm(), 2e-3 * settled.radius);
}

struct ThreeBalls : Rig {
  static constexpr double kBall = 2, kCircle = 20;
  static TriangleMesh grooves() {
    TriangleMesh mesh;
    for (int i = 0; i < 3; ++i)
      mesh = joined(mesh, turned(moved(v_groove(4, 6), {kCircle, 0, 0}), third(i)));
    return mesh;
  }
  static TriangleMesh balls(int level) {
    TriangleMesh mesh;
    for (int i = 0; i < 3; ++i) {
      mesh = joined(mesh, turned(moved(icosphere(level, kBall), {kCircle, 0, 0}), third(i)));
    }
    return mesh;
  }
  static Eigen::Matrix3d third(int i) {
    return Eigen::AngleAxisd(2 * std::numbers::pi * i / 3, Vector::UnitZ()).toRotationMatrix();
  }
  explicit ThreeBalls(int level = 4) : Rig(grooves(), balls(level)) {}
  // A start some 0.7 mm above the rest.
  static Pose start(Random& random) {
    return turn_about({0, 0, 0}, random.direction(), random.uniform(0, 1.2 * kDegree)) *
           place(Vector(0, 0, std::sqrt(2.0) * kBall + 0.8) + random.point(-0.3, 0.3));
  }
};

TEST(Settle, ThreeBallsInGrooves_SixEqualForces) {
  ThreeBalls bodies;
  Random random(1);
  for (int i = 0; i < samples(20); ++i) {
    const Settlement settled =
        bodies.settle(ThreeBalls::start(random), {.closing = kDown, .load_point = Vector(0, 0, 0)});
    ASSERT_EQ(settled.status, SettleStatus::kRests) << i;
    ASSERT_EQ(settled.contacts.size(), 6u) << i;
    for (const SettleContact& contact : settled.contacts) {
      EXPECT_NEAR(contact.force, 1 / (6 * std::sqrt(0.5)), 0.01 * 0.2357) << i;
    }
    // A faceted ball sinks by r (1 - cos) at most, here by 0.0031, as seen along the slope.
    EXPECT_NEAR(settled.pose().translation()[2], std::sqrt(2.0) * ThreeBalls::kBall, 0.0062) << i;
    EXPECT_GT(settled.margin, 8) << i;
    EXPECT_FALSE(settled.rocks);
    EXPECT_TRUE(settled.level.empty());
    expect_balance(settled, kDown);
    expect_no_farther(bodies, settled, kDown, samples(500), 7 + static_cast<std::uint64_t>(i));
  }
}

TEST(Settle, OfASettledPoseIsThePose) {
  ThreeBalls bodies(3);
  Random random(2);
  for (int i = 0; i < samples(10); ++i) {
    const SettleOptions options{.closing = kDown, .load_point = Vector(0, 0, 0)};
    const Settlement once = bodies.settle(ThreeBalls::start(random), options);
    const Settlement twice = bodies.settle(once.pose(), options);
    ASSERT_TRUE(rests(once) && rests(twice)) << i;
    EXPECT_LT((once.pose().matrix() - twice.pose().matrix()).cwiseAbs().maxCoeff(), 2e-8) << i;
  }
}

TEST(Settle, OtherFramesGiveTheSameRest) {
  ThreeBalls bodies(3);
  Random random(3);
  for (int i = 0; i < samples(10); ++i) {
    const Pose start = ThreeBalls::start(random);
    const Settlement plain =
        bodies.settle(start, {.closing = kDown, .load_point = Vector(0, 0, 0)});
    Pose fixed_frame = Pose::Identity(), moving_frame = Pose::Identity();
    fixed_frame.linear() = random.rotation();
    fixed_frame.translation() = random.point(-50, 50);
    moving_frame.linear() = random.rotation();
    moving_frame.translation() = random.point(-50, 50);
    const auto placed = [](TriangleMesh mesh, const Pose& by) {
      for (Vector& vertex : mesh.vertices) vertex = by * vertex;
      return mesh;
    };
    Rig other(placed(ThreeBalls::grooves(), fixed_frame),
              placed(ThreeBalls::balls(3), moving_frame));
    const Settlement settled = other.settle(
        fixed_frame * start * moving_frame.inverse(),
        {.closing = fixed_frame.linear() * kDown, .load_point = moving_frame * Vector(0, 0, 0)});
    ASSERT_TRUE(rests(plain) && rests(settled)) << i;
    const Pose back = fixed_frame.inverse() * settled.pose() * moving_frame;
    // The ball's facets have several rests nearby: the height is always that of one of them.
    if ((back.translation() - plain.pose().translation()).norm() > 1e-3) continue;
    EXPECT_LT((back.matrix() - plain.pose().matrix()).cwiseAbs().maxCoeff(), 5e-8) << i;
  }
}

TEST(Settle, BallInACone_CentreAboveTheApex) {
  constexpr double kRadius = 2, kHalf = std::numbers::pi / 5;
  constexpr int kSides = 64;
  Rig bodies(conical_pit(kHalf, 8, kSides), icosphere(4, kRadius));
  const double height = kRadius / std::sin(kHalf);
  // Facets of the ball are 0.0031 inside it, and those of the cone r (1 - cos) inside the pit.
  const double facets =
      (0.0031 + kRadius * (1 - std::cos(std::numbers::pi / kSides))) / std::sin(kHalf);
  Random random(4);
  for (int i = 0; i < samples(10); ++i) {
    const Pose start = place(Vector(0, 0, height + 0.9) + random.point(-0.4, 0.4));
    const Settlement settled =
        bodies.settle(start, {.closing = kDown, .load_point = Vector(0, 0, 0)});
    EXPECT_TRUE(rests(settled) || settled.status == SettleStatus::kLeftTheBox)
        << i << ' ' << to_string(settled.status);
    EXPECT_NEAR(settled.pose().translation()[2], height, facets + 2e-4) << i;
    EXPECT_TRUE(settled.free);
    double up = 0;
    for (const SettleContact& contact : settled.contacts) up += contact.force * contact.normal[2];
    if (rests(settled)) {
      EXPECT_NEAR(up, 1, 2e-3) << i;
      expect_no_farther(bodies, settled, kDown, samples(500), 9);
    }
  }
}

TEST(Settle, BoxOnAPlane_LevelInThreeFreedoms) {
  Rig bodies(box({-20, -20, -2}, {20, 20, 0}), box({-5, -5, 0}, {5, 5, 10}));
  Random random(5);
  for (int i = 0; i < samples(20); ++i) {
    const Pose start = turn_about({0, 0, 0}, random.direction(), random.uniform(0, kDegree)) *
                       place(Vector(0, 0, 0.6) + random.point(-0.3, 0.3));
    const Settlement settled =
        bodies.settle(start, {.closing = kDown, .load_point = Vector(3, 2, 5)});
    ASSERT_EQ(settled.status, SettleStatus::kRestsLevel) << i;
    EXPECT_EQ(settled.level.size(), 3u) << i;
    for (const Vector6& level : settled.level) {  // along the plane, or about its normal
      EXPECT_NEAR(level[2], 0, 1e-6);
      EXPECT_NEAR(level[3], 0, 1e-6);
      EXPECT_NEAR(level[4], 0, 1e-6);
    }
    EXPECT_NEAR(settled.margin, 2, 1e-3) << i;
    EXPECT_FALSE(settled.rocks);
    EXPECT_LE(settled.distance.lower, 2e-4);
    EXPECT_GT(settled.distance.upper, 0);
    expect_balance(settled, kDown);
    expect_no_farther(bodies, settled, kDown, samples(500), 11);
  }
}

TEST(Settle, BoxWithItsLoadBesideIt_Tips) {
  Rig bodies(box({-20, -20, -2}, {20, 20, 0}), box({-5, -5, 0}, {5, 5, 10}));
  const Settlement settled =
      bodies.settle(place({0, 0, 0.5}), {.closing = kDown, .load_point = Vector(7, 0, 5)});
  EXPECT_EQ(settled.status, SettleStatus::kLeftTheBox);
  EXPECT_TRUE(settled.free);
  EXPECT_NEAR(settled.moved[4], 3 * kDegree, 1e-9);  // about y, to the border
  EXPECT_LT(settled.margin, 0);
  EXPECT_TRUE(settled.rocks);
}

// A cylinder across another one rolls off if its load is higher above the contact than its own
// radius. It cannot slide along its own axis here, else it would always slide off.
TEST(Settle, CrossedCylinders_RestAsTheRadiiSay) {
  constexpr double kLower = 6, kUpper = 4, kLength = 20;
  const auto lying = [](double radius, const Vector& axis) {
    TriangleMesh mesh = moved(cylinder(48, radius, kLength), {0, 0, -kLength / 2});
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond::FromTwoVectors(Vector::UnitZ(), axis.normalized());
    return turned(mesh, turn.toRotationMatrix());
  };
  Rig bodies(lying(kLower, Vector::UnitX()), lying(kUpper, Vector::UnitY()));
  struct Case {
    double height;  // of the load above the contact
    bool is_stable;
  };
  for (const Case& each : {Case{1, true}, Case{3, true}, Case{5, false}, Case{8, false}}) {
    const Vector load(0, 0, each.height - kUpper);
    const Pose start =
        turn_about({0, 0, 0}, {0.1, 1, 0}, 0.15) * place({0, 0, kLower + kUpper + 0.6});
    const Settlement settled =
        bodies.settle(start, {.closing = kDown,
                              .load_point = load,
                              .held = {false, true, false, false, false, true},
                              .largest_way = 4,
                              .largest_turn = 20 * kDegree});
    EXPECT_TRUE(settled.free);
    EXPECT_EQ(rests(settled), each.is_stable) << each.height << ' ' << to_string(settled.status);
    if (!each.is_stable) {
      EXPECT_EQ(settled.status, SettleStatus::kLeftTheBox);
    }
    // One place holds it, as wide as the cylinders are within 10 µm of each other.
    EXPECT_LT(settled.margin, std::sqrt(2 * kLower * 0.01));
  }
}

TEST(Settle, WedgeWithHeldFreedoms_KeepsThem) {
  // A ridge of 60 degrees in a groove of 90 can turn; held, it comes down on its edge.
  Rig bodies(v_groove(6, 10), box({-3, -2, -2}, {3, 2, 2}));
  Pose start = place({0.3, 0.2, 3.5});
  start.linear() = Eigen::AngleAxisd(std::numbers::pi / 4, Vector::UnitX()).toRotationMatrix();
  const SettleOptions options{.closing = kDown,
                              .load_point = Vector(0, 0, 0),
                              .held = {true, false, false, true, true, true}};
  const Settlement settled = bodies.settle(start, options);
  // The square's corner in the groove: its middle is 2 sqrt 2 above the bottom.
  ASSERT_TRUE(rests(settled)) << to_string(settled.status);
  EXPECT_NEAR(settled.pose().translation()[2], 2 * std::sqrt(2.0), 3e-4);
  EXPECT_NEAR(settled.pose().translation()[1], 0, 3e-4);
  EXPECT_EQ(settled.pose().translation()[0], 0.3);
  for (const int k : {0, 3, 4, 5}) EXPECT_EQ(settled.moved[k], 0) << k;
  EXPECT_LT((settled.pose().linear() - start.linear()).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_TRUE(settled.level.empty());
  EXPECT_FALSE(settled.rocks);  // it cannot turn
}

TEST(Settle, BodiesFarApart_LeaveTheBox) {
  Rig bodies(box({-20, -20, -2}, {20, 20, 0}), icosphere(2, 3));
  for (const Vector& at : {Vector(0, 0, 100), Vector(200, 0, 50), Vector(0, 0, -300)}) {
    const Settlement settled = bodies.settle(place(at), {.closing = kDown});
    EXPECT_EQ(settled.status, SettleStatus::kLeftTheBox);
    EXPECT_NEAR(settled.closed, 2, 1e-9);
    EXPECT_TRUE(settled.load_guessed);
    EXPECT_TRUE(settled.contacts.empty());
    EXPECT_TRUE(settled.rocks);
  }
}

TEST(Settle, SlidesPast_LeavesTheBox) {
  // The ball meets the block's edge with its side, and goes by.
  Rig bodies(box({-5, -5, -9}, {5, 5, 0}), icosphere(3, 2));
  const Settlement settled = bodies.settle(place({6.2, 0, 1}), {.closing = kDown});
  EXPECT_EQ(settled.status, SettleStatus::kLeftTheBox);
  EXPECT_TRUE(settled.free);
}

TEST(Settle, BallOnANeedle_RollsOff) {
  TriangleMesh needle = revolved({{0, -6}, {0.5, -6}, {0, 0}}, 12);
  Rig bodies(needle, icosphere(3, 2));
  const Settlement settled =
      bodies.settle(place({0.05, 0.02, 2.2}), {.closing = kDown, .load_point = Vector(0, 0, 0)});
  EXPECT_TRUE(settled.free);
  EXPECT_EQ(settled.status, SettleStatus::kLeftTheBox);
}

TEST(Settle, OpenMeshes_RestOnTheirTriangles) {
  TriangleMesh plate;
  plate.vertices = {{-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0}};
  plate.triangles = {{0, 1, 2}, {0, 2, 3}};
  Rig bodies(plate, box({-5, -5, 0}, {5, 5, 10}));
  const Settlement settled =
      bodies.settle(place({0, 0, 0.5}), {.closing = kDown, .load_point = Vector(0, 0, 5)});
  EXPECT_EQ(settled.status, SettleStatus::kRestsLevel);
  EXPECT_LT(settled.pose().translation()[2], 2e-4);
}

TEST(Settle, StartsInsideEachOther_OpensFirst) {
  Rig bodies(box({-20, -20, -2}, {20, 20, 0}), box({-5, -5, 0}, {5, 5, 10}));
  const SettleOptions options{.closing = kDown, .load_point = Vector(0, 0, 5)};
  const Settlement settled = bodies.settle(place({0, 0, -1.3}), options);
  EXPECT_EQ(settled.status, SettleStatus::kRestsLevel);
  EXPECT_TRUE(settled.opened);
  EXPECT_LT(std::abs(settled.pose().translation()[2]), 2e-4);
  EXPECT_EQ(bodies.settle(place({0, 0, -3}), options).status, SettleStatus::kNoFreePose);
  // Wholly inside: no triangles meet, and the pose is not free.
  Rig nested(box({-20, -20, -20}, {20, 20, 20}), box({-1, -1, -1}, {1, 1, 1}));
  EXPECT_EQ(nested.settle(place({0, 0, 0}), options).status, SettleStatus::kNoFreePose);
}

TEST(Settle, LengthsFollowTheUnit) {
  const auto scaled_to = [](TriangleMesh mesh, double by, LengthUnit unit) {
    for (Vector& vertex : mesh.vertices) vertex *= by;
    mesh.unit = unit;
    return mesh;
  };
  for (const auto& [unit, scale] :
       {std::pair(LengthUnit::kMetre, 1e-3), std::pair(LengthUnit::kMicrometre, 1e3)}) {
    Rig bodies(scaled_to(box({-20, -20, -2}, {20, 20, 0}), scale, unit),
               scaled_to(box({-5, -5, 0}, {5, 5, 10}), scale, unit));
    const Settlement settled = bodies.settle(
        place({0, 0, 1.5 * scale}), {.closing = kDown, .load_point = Vector(0, 0, 5 * scale)});
    EXPECT_EQ(settled.status, SettleStatus::kRestsLevel);
    EXPECT_FALSE(settled.unit_guessed);
    EXPECT_NEAR(settled.reach, 0.05 * scale, 1e-12 * scale);
    EXPECT_LE(settled.distance.lower, 2e-4 * scale);
    EXPECT_NEAR(settled.closed, 1.5 * scale, 2e-4 * scale);
  }
}

TEST(Settle, EarlyEnd_KeepsAFreePose) {
  ThreeBalls bodies(3);
  Random random(6);
  const Pose start = ThreeBalls::start(random);
  for (int steps = 0; steps < 12; ++steps) {
    SettleOptions options{.closing = kDown, .load_point = Vector(0, 0, 0)};
    options.steps = steps;
    const Settlement settled = bodies.settle(start, options);
    EXPECT_TRUE(settled.free);
    EXPECT_EQ(bodies.query.intersects(settled.pose()).answer, Answer::kNo);
    if (!rests(settled)) {
      EXPECT_EQ(settled.status, SettleStatus::kStopped);
    }
  }
  SettleOptions options{.closing = kDown};
  options.proceed = [](double) { return false; };
  EXPECT_EQ(bodies.settle(start, options).status, SettleStatus::kStopped);
}

TEST(Settle, RefusesOptionsOutOfRange) {
  Rig bodies(box({-20, -20, -2}, {20, 20, 0}), box({-5, -5, 0}, {5, 5, 10}));
  const auto refuses = [&](const SettleOptions& options) {
    return error_name([&] {
             static_cast<void>(bodies.settle(place({0, 0, 1}), options));
           }) == "argument-invalid";
  };
  EXPECT_TRUE(refuses({.closing = {0, 0, 0}}));
  EXPECT_TRUE(refuses({.closing = {0, NAN, 1}}));
  EXPECT_TRUE(refuses({.closing = kDown, .held = {false, false, true, false, false, false}}));
  EXPECT_TRUE(refuses({.closing = kDown, .load_point = Vector(0, 0, HUGE_VAL)}));
  EXPECT_TRUE(refuses({.closing = kDown, .largest_way = -1}));
  EXPECT_TRUE(refuses({.closing = kDown, .largest_turn = 2}));
  EXPECT_TRUE(refuses({.closing = kDown, .reach = NAN}));
  Pose mirror = place({0, 0, 1});
  mirror.linear()(0, 0) = -1;
  EXPECT_EQ(bodies.settle(mirror, {.closing = kDown}).status, SettleStatus::kInvalidPose);
}

}  // namespace
}  // namespace ist::test
