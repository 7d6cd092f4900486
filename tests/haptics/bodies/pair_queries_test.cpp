#include "loop/haptics/bodies/pair_queries.h"

#include <gtest/gtest.h>

#include <numeric>

#include "haptics/bodies/body_cases.h"
#include "ist/haptics/simulation.h"
#include "loop/haptics/tool.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

constexpr double kMillimetre = 1e-3;
constexpr ToolContactOptions kOptions{.policy = SpherePolicy::kSlab, .margin = 0.5};

SphereTree tree_of(const TriangleMesh& mesh) {
  BuildOptions options;
  options.voxel_size = 0.5;
  return build_tree(mesh, options);
}

// A ball in a corner of three boxes, whose faces are x = 0, y = 0 and z = 0.
class Corner : public ::testing::Test {
 protected:
  // The boxes in an order; the ball is the last body.
  struct Setting {
    HandBodies bodies;
    PairQueries queries;
  };
  [[nodiscard]] Setting setting(const std::vector<std::size_t>& order,
                                const ToolContactOptions& options = kOptions) const {
    std::vector<BodyPart> parts;
    for (const std::size_t i : order) {
      parts.push_back({std::to_string(i), Placement(), boxes_[i].origin(), radius_of(boxes_[i])});
    }
    parts.push_back({"ball", Placement(), ball_.origin(), radius_of(ball_), true});
    Setting made{HandBodies(kMillimetre, home(), std::move(parts)), PairQueries()};
    for (std::size_t i = 0; i < order.size(); ++i) {
      made.queries.add({i, order.size()},
                       std::make_unique<ToolContactQuery>(
                           boxes_[order[i]], ball_, made.bodies.frames(i, order.size()), options));
    }
    return made;
  }
  [[nodiscard]] Placement home() const {
    return {Eigen::Matrix3d::Identity(), kMillimetre * ball_.origin()};
  }
  // The ball's centre so far from the three faces, mm.
  [[nodiscard]] Placement pressed(const Vector3d& depth) const {
    return {Eigen::Matrix3d::Identity(),
            home().translation + kMillimetre * (Vector3d::Constant(5) - depth)};
  }
  static double radius_of(const SphereTree& tree) { return kMillimetre * surface_radius(tree); }

  const std::vector<SphereTree> boxes_ = [] {
    std::vector<SphereTree> boxes;
    for (int axis = 0; axis < 3; ++axis) {
      Vector3d min(-3, -3, -3), max(12, 12, 12);
      max[axis] = 0;
      min[axis] = -4;
      boxes.push_back(tree_of(box(min, max)));
    }
    return boxes;
  }();
  const SphereTree ball_ = tree_of(icosphere(4, 5));
};

ToolContacts contacts_for(const PairQueries& queries) { return ToolContacts(queries.size()); }

TEST_F(Corner, AllPairsTogetherAreTheSumOfEach) {
  Setting all = setting({0, 1, 2});
  Random random(3);
  for (int i = 0; i < samples(20); ++i) {
    const Placement tool = pressed(random.point(-1.5, 0.4));
    ToolContacts together = contacts_for(all.queries);
    const auto result = all.queries.find(all.bodies, tool, {}, together);
    ASSERT_TRUE(result && result->complete);
    ASSERT_EQ(together.pairs().size(), 3u);
    Vector6 spring = Vector6::Zero();
    double count = 0, nearest = 1e9, force_rate = 0, torque_rate = 0;
    std::uint64_t leaf_pairs = 0, tests = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      Setting one = setting({k});
      ToolContacts alone = contacts_for(one.queries);
      const auto single = one.queries.find(one.bodies, tool, {}, alone);
      ASSERT_TRUE(single && single->complete);
      spring += alone.spring;
      count += alone.count;
      force_rate += alone.rates.force;
      torque_rate += alone.rates.torque;
      leaf_pairs += single->leaf_pairs;
      tests += single->sphere_tests;
      nearest = std::min(nearest, single->distance->lower);
      const ContactPair& pair = together.pairs()[k];
      EXPECT_EQ(pair.number, k);
      const auto points = together.points(pair);
      ASSERT_EQ(points.size(), alone.points().size());
      for (std::size_t p = 0; p < points.size(); ++p) {
        EXPECT_EQ(points[p].arm, alone.points()[p].arm);
        EXPECT_EQ(points[p].normal, alone.points()[p].normal);
        EXPECT_EQ(points[p].depth, alone.points()[p].depth);
        EXPECT_EQ(points[p].stiffness_fraction, alone.points()[p].stiffness_fraction);
      }
    }
    EXPECT_EQ(together.spring, spring);
    EXPECT_EQ(together.count, count);
    EXPECT_EQ(together.rates.force, force_rate);
    EXPECT_EQ(together.rates.torque, torque_rate);
    EXPECT_EQ(result->leaf_pairs, leaf_pairs);
    EXPECT_EQ(result->distance->lower, nearest);
  }
}

// The ball slides, sinks and turns about its own centre and about points beside it, pressed on one
// box or on all: by steps that are much longer than rounding, and by steps of a few microns.
TEST_F(Corner, SpringsOfAllPairsChangeNoFasterThanTheirRates) {
  Setting all = setting({0, 1, 2});
  Random random(7);
  double force = 0, torque = 0;  // the steepest, in parts of the bound
  for (int i = 0; i < samples(60); ++i) {
    Vector3d depth = random.point(0, 0.4);
    if (i % 3 != 0) depth[i % 3] = -3;  // apart from one box, and once from the last
    const double step = kMillimetre * (i % 2 == 0 ? 0.05 : 0.005);
    const Vector3d along = step * random.direction();
    const Vector3d turn = i % 4 == 0 ? Vector3d(Vector3d::Zero()) : random.direction();
    Placement tool = pressed(depth);
    ToolContacts before = contacts_for(all.queries), after = before;
    ASSERT_TRUE(all.queries.find(all.bodies, tool, {}, before)->complete);
    for (int k = 0; k < 5; ++k) {
      Vector6 motion;
      const double angle = before.rates.lever > 0 ? step / before.rates.lever : 0;
      motion << along, angle * turn;
      tool = tool.moved(motion);
      ASSERT_TRUE(all.queries.find(all.bodies, tool, {}, after)->complete);
      const double way = motion.head<3>().norm() +
                         std::max(before.rates.lever, after.rates.lever) * motion.tail<3>().norm() +
                         std::max(before.rates.rounding, after.rates.rounding);
      const Vector6 change = after.spring - before.spring;
      const double most = (before.rates.force + after.rates.force) * way;
      const double most_torque = (before.rates.torque + after.rates.torque) * way;
      EXPECT_LE(change.head<3>().norm(), most);
      EXPECT_LE(change.tail<3>().norm(), most_torque);
      if (most > 0) force = std::max(force, change.head<3>().norm() / most);
      if (most_torque > 0) torque = std::max(torque, change.tail<3>().norm() / most_torque);
      std::swap(before, after);
    }
    EXPECT_GT(before.rates.force, 0);
  }
  // A sum's pairs never change all the same way at once: its bound is as far from what happens as
  // that of one pair of bodies (Policies/Lipschitz, loads).
  const double part = effort() < 1 ? 0.2 : 1;  // few samples may miss the steepest
  EXPECT_GT(force, part * 1e-3);
  EXPECT_GT(torque, part * 2e-4);
}

// A permutation of the bodies permutes the pairs; sums differ by their rounding alone.
TEST_F(Corner, PermutingBodiesPermutesTheAnswer) {
  std::vector<std::size_t> order{0, 1, 2};
  Setting plain = setting(order);
  const Placement tool = pressed({0.3, 0.2, 0.35});
  ToolContacts expected = contacts_for(plain.queries);
  ASSERT_TRUE(plain.queries.find(plain.bodies, tool, {}, expected)->complete);
  ASSERT_GT(expected.count, 3);
  while (std::next_permutation(order.begin(), order.end())) {
    Setting other = setting(order);
    ToolContacts found = contacts_for(other.queries);
    ASSERT_TRUE(other.queries.find(other.bodies, tool, {}, found)->complete);
    ASSERT_EQ(found.pairs().size(), order.size());
    EXPECT_NEAR((found.spring - expected.spring).norm(), 0, 1e-15);
    EXPECT_NEAR(found.count, expected.count, 1e-12);
    for (std::size_t i = 0; i < order.size(); ++i) {
      const auto points = found.points(found.pairs()[i]);
      const auto same = expected.points(expected.pairs()[order[i]]);
      ASSERT_EQ(points.size(), same.size());
      for (std::size_t p = 0; p < points.size(); ++p) EXPECT_EQ(points[p].arm, same[p].arm);
    }
  }
}

// A budget of as many tests as all pairs need is enough, however it is divided: what one does not
// need the others may spend. A tenth of it is not.
TEST_F(Corner, ABudgetIsDividedByWhatEachPairNeeds) {
  Setting all = setting({0, 1, 2});
  const Placement tool = pressed({0.3, -8, 0.1});  // the second is apart
  ToolContacts contacts = contacts_for(all.queries);
  const auto needed = all.queries.find(all.bodies, tool, {}, contacts)->sphere_tests;
  Budget budget;
  budget.tests = needed;
  for (int i = 0; i < 3; ++i) {
    const auto result = all.queries.find(all.bodies, tool, budget, contacts);
    EXPECT_TRUE(result->complete);
    EXPECT_LE(result->sphere_tests, budget.tests);
  }
  budget.tests = needed / 10;
  const auto stopped = all.queries.find(all.bodies, tool, budget, contacts);
  EXPECT_FALSE(stopped->complete);
  EXPECT_LE(stopped->sphere_tests, budget.tests + 3) << "the roots are always tested";
}

// If a few tests are missing, the first pair is left out and the later pairs get all tests that
// they need. Without caches a pose takes the same tests each time.
TEST_F(Corner, TheFirstPairLeavesWhatTheOthersNeed) {
  Setting all = setting({0, 1, 2}, {.policy = SpherePolicy::kSlab, .front_pairs = 0});
  const Placement tool = pressed({1.2, -0.3, -0.3});
  ToolContacts contacts = contacts_for(all.queries);
  const auto needed = all.queries.find(all.bodies, tool, {}, contacts);
  ASSERT_TRUE(needed->complete);
  Budget budget;
  budget.tests = needed->sphere_tests - 2;
  EXPECT_FALSE(all.queries.find(all.bodies, tool, budget, contacts)->complete);
  ASSERT_EQ(contacts.pairs().size(), 2u);
  EXPECT_EQ(contacts.pairs()[0].number, 1u);
  EXPECT_EQ(contacts.pairs()[1].number, 2u);
}

// The others are apart, and have their answer.
TEST_F(Corner, OnePairThatIsStoppedLeavesTheAnswerIncomplete) {
  for (const std::size_t deep : {0u, 1u, 2u}) {
    Setting all = setting({0, 1, 2});
    Vector3d depth(-8, -8, -8);
    depth[static_cast<Eigen::Index>(deep)] = 0.3;
    ToolContacts contacts = contacts_for(all.queries);
    ASSERT_TRUE(all.queries.find(all.bodies, pressed(depth), {}, contacts)->complete);
    Budget few;
    few.tests = 20;
    EXPECT_FALSE(all.queries.find(all.bodies, pressed(depth), few, contacts)->complete);
    EXPECT_EQ(contacts.pairs().size(), 2u);
    EXPECT_EQ(contacts.count, 0);
  }
}

// A limit above 2^53 is divided too, and no test is lost.
TEST_F(Corner, AnyLimitMayBeDivided) {
  Setting all = setting({0, 1, 2});
  ToolContacts contacts = contacts_for(all.queries);
  for (const std::uint64_t tests : {std::uint64_t{1} << 54, ~std::uint64_t{0} - 1}) {
    Budget budget;
    budget.tests = tests;
    budget.deadline = Budget::Clock::time_point::max() - std::chrono::nanoseconds(1);
    EXPECT_TRUE(all.queries.find(all.bodies, pressed({0.3, 0.2, 0.35}), budget, contacts)->complete)
        << tests;
  }
}

TEST_F(Corner, ADeadlineThatIsPastEndsEveryPair) {
  Setting all = setting({0, 1, 2});
  ToolContacts contacts = contacts_for(all.queries);
  Budget late;
  late.deadline = Budget::Clock::now() - std::chrono::seconds(1);
  EXPECT_FALSE(all.queries.find(all.bodies, pressed({0.3, 0.2, 0.35}), late, contacts)->complete);
  Budget enough;
  enough.deadline = Budget::Clock::now() + std::chrono::seconds(60);
  EXPECT_TRUE(all.queries.find(all.bodies, pressed({0.3, 0.2, 0.35}), enough, contacts)->complete);
}

// If the balls of a pair without a query overlap, the answer is incomplete.
TEST_F(Corner, APairThatWasNotExpectedToMeetHoldsTheTool) {
  Setting one = setting({0});
  one.queries = PairQueries();
  one.queries.add_far({0, 1});
  ToolContacts contacts = contacts_for(one.queries);
  const Placement near = pressed({0.1, 0, 0});
  const Placement far = pressed({-200, 0, 0});
  EXPECT_FALSE(one.queries.find(one.bodies, near, {}, contacts)->complete);
  EXPECT_TRUE(one.queries.find(one.bodies, far, {}, contacts)->complete);
  EXPECT_TRUE(contacts.pairs().empty());
}

TEST_F(Corner, WithoutPairsThereIsNoAnswer) {
  PairQueries none;
  ToolContacts contacts;
  EXPECT_FALSE(none.find(HandBodies(), Placement(), {}, contacts));
}

// A tick with one unfinished pair of bodies. All other pairs are finished.

bool is_same_place(const Placement& a, const Placement& b) {
  return a.rotation == b.rotation && a.translation == b.translation;
}

// The tool is pressed on the floor, and far from the walls and from the loose ball. A few tests are
// enough for these, and not for the floor, which is the first pair.
TEST(UnfinishedPair, HoldsTheTool) {
  const BuiltScene built = build_scene(five_bodies(Keeps::kSprings));
  Simulation& simulation = *built.simulation;
  const Placement start = simulation.tool_pose();
  Placement last = start;
  Tick tick{};
  const auto go_down = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      last = simulation.tool_pose();
      tick = simulation.tick(moved_by(start, {0, 0, -3 * std::min(1.0, i / 400.0)}));
      ASSERT_FALSE(tick.held);
    }
  };
  go_down(400);
  ASSERT_GT(tick.leaf_pairs, 1);
  ASSERT_GT(tick.wrench[2], 0.5);
  ASSERT_FALSE(is_same_place(tick.tool, last)) << "it moves";
  TickBudget few;
  few.contacts.tests = 20;
  for (int i = 0; i < 200; ++i) {
    const Tick held = simulation.tick(moved_by(start, {0, 0, -3}), few);
    ASSERT_TRUE(held.held) << i;
    ASSERT_FALSE(held.contacts->complete);
    ASSERT_TRUE(is_same_place(held.tool, last)) << "where all pairs were known last, tick " << i;
    ASSERT_GT(held.wrench[2], 0.5) << "it gives no way";
  }
  for (int i = 0; i < 300; ++i) tick = simulation.tick(moved_by(start, {0, 0, -3}));
  EXPECT_FALSE(tick.held);
  EXPECT_FALSE(is_same_place(tick.tool, last)) << "it moves again";
}

}  // namespace
}  // namespace ist::test
