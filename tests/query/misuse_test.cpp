#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "ist/base/pose.h"
#include "ist/query/query.h"
#include "ist/query/reference/reference_query.h"
#include "ist/query/world/world.h"
#include "query/every_verb.h"
#include "query/query_cases.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

SphereTree ball(double voxel_size, bool triangles = false) {
  return build_tree(icosphere(2, 2), {.voxel_size = voxel_size, .keep_triangles = triangles});
}

// The text of the kArgumentInvalid that `action` throws.
template <typename Action>
std::string refusal(const Action& action) {
  const std::optional<Error> error = error_of(action);
  EXPECT_TRUE(error && error->code() == ErrorCode::kArgumentInvalid);
  return error ? error->what() : "";
}

class Misuse : public ::testing::Test {
 protected:
  const SphereTree tree_ = ball(0.25), other_ = ball(0.5);
  const Eigen::Isometry3d pose_ = shift({3.5, 0, 0});
};

TEST_F(Misuse, OfWorkersThrows) {
  for (const int workers : {-1, 0, 3, 7}) {
    const std::string text = refusal([&] { Query(tree_, tree_, {.workers = workers}); });
    EXPECT_NE(text.find(std::to_string(workers)), std::string::npos) << text;
    EXPECT_NE(text.find("give 1 or 2"), std::string::npos) << text;
  }
}

TEST_F(Misuse, OfTreesInDifferentFramesThrows) {
  TriangleMesh mesh = icosphere(2, 2);
  const auto in = [&](PatientFrame frame) {
    mesh.frame = frame;
    return build_tree(mesh, {.voxel_size = 0.5});
  };
  const SphereTree ras = in(PatientFrame::kRas), lps = in(PatientFrame::kLps);
  const std::string text = refusal([&] { Query(ras, lps); });
  EXPECT_NE(text.find("frame ras"), std::string::npos) << text;
  EXPECT_NE(text.find("in lps"), std::string::npos) << text;
  EXPECT_EQ(error_name([&] { Query(ras, ras), Query(ras, tree_), Query(tree_, lps); }), "none");
}

TEST_F(Misuse, OfTreesInDifferentUnitsThrows) {
  TriangleMesh mesh = icosphere(2, 2);
  const auto in = [&](LengthUnit unit) {
    mesh.unit = unit;
    return build_tree(mesh, {.voxel_size = 0.5});
  };
  const SphereTree mm = in(LengthUnit::kMillimetre), inch = in(LengthUnit::kInch);
  const std::string text = refusal([&] { Query(mm, inch); });
  EXPECT_NE(text.find("the fixed tree is in mm, and the moving tree is in inch: convert"),
            std::string::npos)
      << text;
  EXPECT_EQ(error_name([&] { Query(mm, mm), Query(mm, tree_), Query(tree_, inch); }), "none");
}

TEST_F(Misuse, OfTreesThatContradictEachOtherThrowsInAReferenceQuery) {
  TriangleMesh mesh = icosphere(2, 2);
  const auto in = [&](LengthUnit unit, PatientFrame frame) {
    mesh.unit = unit;
    mesh.frame = frame;
    return build_tree(mesh, {.voxel_size = 0.5});
  };
  const SphereTree mm = in(LengthUnit::kMillimetre, PatientFrame::kRas),
                   inch = in(LengthUnit::kInch, PatientFrame::kRas),
                   lps = in(LengthUnit::kMillimetre, PatientFrame::kLps);
  const auto asked = [](const SphereTree& fixed, const SphereTree& moving) {
    return [&] { ReferenceQuery(fixed, moving, SpherePolicy::kSlab); };
  };
  EXPECT_NE(refusal(asked(mm, inch)).find("is in mm, and the moving tree is in inch: convert"),
            std::string::npos);
  EXPECT_NE(refusal(asked(lps, mm)).find("in the frame lps"), std::string::npos);
  EXPECT_EQ(error_name(asked(mm, mm)), "none");
}

TEST_F(Misuse, OfManifoldOptionsThrows) {
  const auto made = [&](const ManifoldOptions& options) {
    return refusal([&] { ContactManifold(tree_, tree_, SpherePolicy::kSlab, options); });
  };
  for (const double margin : {-0.1, 2.1, kNotANumber, HUGE_VAL}) {
    EXPECT_NE(made({.margin = margin}).find("margin"), std::string::npos) << margin;
  }
  for (const double reach : {-0.1, 1.1, kNotANumber, HUGE_VAL}) {
    EXPECT_NE(made({.reach = reach}).find("reach"), std::string::npos) << reach;
  }
}

TEST_F(Misuse, OfAManifoldMadeForOthersIsAStatus) {
  Query query(tree_, other_, {.policy = SpherePolicy::kSlab});
  ContactManifold right(tree_, other_, SpherePolicy::kSlab);
  ContactManifold swapped(other_, tree_, SpherePolicy::kSlab),
      loose(tree_, other_, SpherePolicy::kTight);
  ASSERT_EQ(query.contacts(pose_, right).status, QueryStatus::kDone);
  ASSERT_FALSE(right.points().empty());
  // It is emptied, whatever it held before.
  Query of_swapped(other_, tree_);
  ASSERT_EQ(of_swapped.contacts(pose_, swapped).status, QueryStatus::kDone);
  ASSERT_FALSE(swapped.points().empty());
  for (ContactManifold* wrong : {&swapped, &loose}) {
    const QueryResult result = query.contacts(pose_, *wrong);
    EXPECT_EQ(result.status, QueryStatus::kManifoldMismatch);
    EXPECT_FALSE(result.complete);
    EXPECT_TRUE(wrong->points().empty());
    EXPECT_EQ(wrong->sums().pairs, 0u);
    EXPECT_TRUE(wrong->wrench(1).force.isZero(0));
  }
}

TEST_F(Misuse, OfTrianglesThatAreNotThereIsAStatus) {
  const SphereTree exact = ball(0.25, true);
  for (const auto& [fixed, moving] : {std::pair{&tree_, &exact}, {&exact, &tree_}}) {
    Query query(*fixed, *moving);
    EXPECT_FALSE(query.has_triangles());
    EXPECT_EQ(query.triangle_pairs(pose_, {}).status, QueryStatus::kNoTriangles);
    EXPECT_EQ(query.intersects(pose_).answer, Answer::kNear);
  }
}

TEST_F(Misuse, OfVoxelsThatAreNotThereIsAStatus) {
  const SphereTree alone = build_tree(icosphere(2, 2)), exact = ball(0.25, true);
  struct Counter final : LeafPairStream {
    bool take(std::span<const LeafPair>) noexcept override { return ++takes < 0; }
    int takes = 0;
  };
  for (const auto& [fixed, moving] :
       {std::pair{&alone, &alone}, {&alone, &exact}, {&exact, &alone}}) {
    Query query(*fixed, *moving, {.front_pairs = 1 << 10});
    EXPECT_TRUE(query.has_triangles());
    EXPECT_EQ(query.policy(), SpherePolicy::kSimple);
    Counter counter;
    ContactManifold manifold(exact, exact, SpherePolicy::kSlab);
    for (const QueryResult& result :
         {query.leaf_pairs(pose_, {}), query.leaf_pairs(pose_, {}, {.tests = 10}),
          query.leaf_pairs(pose_, counter), query.contacts(pose_, manifold)}) {
      EXPECT_EQ(result.status, QueryStatus::kNoVoxels);
      EXPECT_FALSE(result.complete);
      EXPECT_EQ(result.leaf_pairs, 0u);
    }
    EXPECT_EQ(counter.takes, 0);
    EXPECT_STREQ(to_string(QueryStatus::kNoVoxels), "no-voxels");
    query.forget();
    EXPECT_EQ(query.intersects(pose_).answer, Answer::kYes);

    const auto no_manifold =
        error_of([&] { ContactManifold(*fixed, *moving, SpherePolicy::kSimple); });
    ASSERT_TRUE(no_manifold);
    EXPECT_EQ(no_manifold->code(), ErrorCode::kVoxelsMissing);
    EXPECT_NE(std::string(no_manifold->what()).find("build it with a voxel size"),
              std::string::npos);
    for (const SpherePolicy policy : kSpherePolicies) {
      const auto no_spheres = error_of([&] { Query(*fixed, *moving, {.policy = policy}); });
      ASSERT_TRUE(no_spheres);
      EXPECT_EQ(no_spheres->code(), ErrorCode::kPolicyMissing);
      EXPECT_NE(std::string(no_spheres->what()).find("build it with a voxel size"),
                std::string::npos);
      EXPECT_EQ(error_name([&] { ReferenceQuery(*fixed, *moving, policy); }), "policy-missing");
    }
  }
  EXPECT_EQ(error_name([&] { Query(alone, tree_); }), "voxels-missing");
  EXPECT_EQ(error_name([&] { Query(tree_, alone); }), "voxels-missing");
}

// No memory is reserved for leaf pairs that cannot be asked for.
TEST_F(Misuse, OfVoxelsThatAreNotThereTakesLessMemory) {
  const SphereTree alone = build_tree(icosphere(2, 2)), exact = ball(0.25, true);
  for (const int workers : {1, 2}) {
    const QueryOptions options{.workers = workers, .front_pairs = 1 << 12};
    const std::size_t with = Query(exact, exact, options).bytes();
    for (const auto& [fixed, moving] :
         {std::pair{&alone, &alone}, {&alone, &exact}, {&exact, &alone}}) {
      const std::size_t front = options.front_pairs * sizeof(LeafPair);
      EXPECT_LT(Query(*fixed, *moving, options).bytes() + front, with) << workers;
    }
  }
}

TEST_F(Misuse, OfAPoseIsAStatusOfEveryVerb) {
  const SphereTree exact = ball(0.25, true);
  Query query(exact, exact);
  VerbRoom room(query);
  Eigen::Isometry3d bad = pose_;
  bad.translation().x() = kNotANumber;
  for (const Budget& budget : {Budget{}, Budget{.tests = 10}}) {
    ask_every_verb(query, bad, room, budget, [](const auto& result) {
      EXPECT_EQ(result.status, QueryStatus::kInvalidPose);
      EXPECT_FALSE(result.complete);
    });
  }
  EXPECT_EQ(query.intersects(bad).answer, Answer::kUnknown);
  EXPECT_EQ(query.distance(bad, 0.1).distance.upper, HUGE_VAL);
  EXPECT_STREQ(to_string(query.leaf_pairs(bad, {}).status), "invalid-pose");
}

// So does a result at a pose that is refused.
TEST_F(Misuse, OfARoughPoseSaysHowFarItWas) {
  const SphereTree exact = ball(0.25, true);
  Query query(exact, exact), without(tree_, tree_);
  VerbRoom room(query);
  for (const double skew : {0.0, 1e-7, 4e-4, 0.1}) {
    Eigen::Isometry3d rough = pose_;
    rough(0, 1) = skew;
    const bool is_rigid = skew < 1e-3;
    const auto expect_of = [&](const auto& result) {
      EXPECT_EQ(result.status, is_rigid ? QueryStatus::kDone : QueryStatus::kInvalidPose) << skew;
      EXPECT_EQ(result.rotation_error, rotation_error(rough)) << skew;
      EXPECT_NEAR(result.rotation_error, std::max(skew, skew * skew), 1e-15);
    };
    ask_every_verb(query, rough, room, {}, expect_of);
    ask_every_verb(query, rough, room, {.tests = 10}, expect_of);
    expect_of(without.intersects(rough));
    expect_of(without.distance(rough, 0.1));
    expect_of(ReferenceQuery(exact, exact, SpherePolicy::kSlab).leaf_pairs(rough, {}));
    EXPECT_EQ(query.intersects(rough).answer, is_rigid ? Answer::kYes : Answer::kUnknown);
  }
}

TEST_F(Misuse, AResultWithoutAnAnswerIsUnknown) {
  EXPECT_EQ(IntersectionResult().answer, Answer::kUnknown);
  EXPECT_FALSE(IntersectionResult().complete);
  EXPECT_EQ(DistanceResult().distance.lower, 0);
  EXPECT_EQ(DistanceResult().distance.upper, HUGE_VAL);
  EXPECT_EQ(Answer{}, Answer::kUnknown);  // so is memory of zeros
  EXPECT_STREQ(to_string(Answer::kUnknown), "unknown");
  EXPECT_STREQ(to_string(Answer::kNo), "no");
  EXPECT_STREQ(to_string(Answer::kNear), "near");
  EXPECT_STREQ(to_string(Answer::kYes), "yes");
}

// Bounds alone say near where they overlap. A budget that ends before says nothing.
TEST_F(Misuse, OfABudgetWithoutTrianglesIsUnknownAndNeverNo) {
  Query query(tree_, tree_);
  bool unknown = false, near = false;
  for (std::uint64_t tests = 0; tests < 4000; tests += 1 + tests / 8) {
    const IntersectionResult found = query.intersects(pose_, {.tests = tests});
    EXPECT_EQ(found.answer, found.complete ? Answer::kNear : Answer::kUnknown) << tests;
    (found.complete ? near : unknown) = true;
  }
  EXPECT_TRUE(unknown && near);
}

TEST_F(Misuse, OfAToleranceCountsAsZero) {
  const SphereTree exact = ball(0.25, true);
  Query query(exact, exact);
  const DistanceResult zero = query.distance(shift({5, 0, 0}), 0);
  for (const double tolerance : {-1.0, kNotANumber, -HUGE_VAL}) {
    const DistanceResult found = query.distance(shift({5, 0, 0}), tolerance);
    EXPECT_EQ(found.distance.lower, zero.distance.lower) << tolerance;
    EXPECT_EQ(found.distance.upper, zero.distance.upper) << tolerance;
  }
}

TEST_F(Misuse, OfMemoryThrows) {
  constexpr std::size_t kHuge = std::numeric_limits<std::size_t>::max();
  for (const std::size_t many : {kHuge, kMostItems + 1}) {
    EXPECT_NE(refusal([&] { Query(tree_, tree_, {.front_pairs = many}); }).find("front_pairs"),
              std::string::npos);
    EXPECT_NE(refusal([&] {
                ContactManifold(tree_, tree_, SpherePolicy::kSlab, {.points = many});
              }).find("points"),
              std::string::npos);
  }
}

TEST_F(Misuse, OfAMeshIsAnErrorOfTheBuild) {
  TriangleMesh mesh = icosphere(1, 1);
  const auto build = [&] { static_cast<void>(build_tree(mesh, {.voxel_size = 0.1})); };
  mesh.triangles[3][1] = 100'000'000;
  EXPECT_EQ(error_name(build), "mesh-bad-index");
  mesh = icosphere(1, 1);
  mesh.vertices[5].y() = kNotANumber;
  EXPECT_EQ(error_name(build), "mesh-not-finite");
  mesh.vertices.clear();
  mesh.triangles.clear();
  EXPECT_EQ(error_name(build), "mesh-empty");
}

// Queries share a tree's content: it may move, and go away.
TEST(Query, OutlivesItsTrees) {
  const Eigen::Isometry3d pose = shift({3.5, 0, 0});
  auto tree = std::make_unique<SphereTree>(ball(0.25, true));
  Query query(*tree, *tree);
  ReferenceQuery reference(*tree, *tree, SpherePolicy::kTable);
  ContactManifold manifold(*tree, *tree, query.policy());
  const std::uint64_t pairs = query.leaf_pairs(pose, {}).leaf_pairs;
  const std::uint64_t published = reference.leaf_pairs(pose, {}).leaf_pairs;
  ASSERT_GT(pairs, 0u);
  ASSERT_EQ(query.contacts(pose, manifold).status, QueryStatus::kDone);
  const double weight = manifold.sums().weight;
  const SphereTree moved = std::move(*tree);
  tree.reset();
  EXPECT_EQ(query.leaf_pairs(pose, {}).leaf_pairs, pairs);
  EXPECT_EQ(reference.leaf_pairs(pose, {}).leaf_pairs, published);
  ASSERT_EQ(query.contacts(pose, manifold).status, QueryStatus::kDone);
  EXPECT_EQ(manifold.sums().weight, weight);
  // A manifold of the same content fits, wherever its tree lies.
  ContactManifold again(moved, moved, query.policy());
  EXPECT_EQ(query.contacts(pose, again).status, QueryStatus::kDone);
  EXPECT_EQ(query.intersects(pose).answer, Answer::kYes);
}

// What is made of temporary trees shares their content after they are gone.
TEST(Query, OfTemporariesGivesTheSameAnswers) {
  const SphereTree tree = ball(0.25, true), other = ball(0.5, true);
  const Eigen::Isometry3d pose = shift({3.5, 0.1, 0}), apart = shift({5, 0.1, 0});
  const QueryOptions options{.front_pairs = 1 << 12};
  const SpherePolicy policy = SpherePolicy::kTable;
  Query lasting(tree, other, options), query(ball(0.25, true), ball(0.5, true), options);
  EXPECT_TRUE(same(ask(query, pose), ask(lasting, pose)));
  EXPECT_EQ(query.intersects(pose).answer, Answer::kYes);
  const auto triangle_pairs = [&](Query& asked) {
    std::vector<TrianglePair> pairs(1 << 12);
    pairs.resize(asked.triangle_pairs(pose, pairs).triangle_pairs);
    return pairs;
  };
  EXPECT_FALSE(triangle_pairs(query).empty());
  EXPECT_EQ(triangle_pairs(query), triangle_pairs(lasting));
  const DistanceInterval gap = query.distance(apart, 0).distance;
  EXPECT_EQ(gap.lower, lasting.distance(apart, 0).distance.lower);
  EXPECT_EQ(gap.upper, lasting.distance(apart, 0).distance.upper);
  EXPECT_EQ(query.inside(apart).status, QueryStatus::kDone);

  ReferenceQuery published(ball(0.25, true), ball(0.5, true), policy);
  EXPECT_EQ(published.leaf_pairs(pose, {}).leaf_pairs,
            ReferenceQuery(tree, other, policy).leaf_pairs(pose, {}).leaf_pairs);

  ContactManifold manifold(SphereTree(tree), SphereTree(other), lasting.policy()),
      alone(ball(0.25, true), ball(0.5, true), lasting.policy());
  ASSERT_EQ(lasting.contacts(pose, manifold).status, QueryStatus::kDone);
  EXPECT_GT(manifold.sums().weight, 0);
  EXPECT_EQ(lasting.contacts(pose, alone).status, QueryStatus::kManifoldMismatch);

  World world({.query = options});
  world.add(ball(0.25, true));
  world.add(ball(0.5, true), pose);
  world.reserve();
  const WorldAnswer answer = world.ask({.kind = WorldQuestion::kIntersects});
  ASSERT_EQ(answer.pairs.size(), 1u);
  EXPECT_EQ(answer.pairs[0].answer, Answer::kYes);
}

TEST(DistanceResult, SaysWhetherTheToleranceWasReached) {
  const SphereTree plain = ball(0.25), exact = ball(0.25, true);
  Query of_plain(plain, plain), of_exact(exact, exact);
  EXPECT_TRUE(of_exact.distance(shift({5, 0, 0}), 0.01).complete);
  EXPECT_FALSE(of_plain.distance(shift({5, 0, 0}), 1e-6).complete);
  EXPECT_TRUE(of_plain.distance(shift({5, 0, 0}), 10).complete);
  // Below what rounding allows, the interval is as narrow as it says.
  const DistanceResult sharp = of_exact.distance(shift({5, 0, 0}), 0);
  EXPECT_FALSE(sharp.complete);
  EXPECT_GT(sharp.narrowest, 0);
  EXPECT_LT(sharp.narrowest, 1e-6);
  EXPECT_LE(sharp.distance.upper - sharp.distance.lower, sharp.narrowest * (1 + 1e-3));
  EXPECT_TRUE(of_exact.distance(shift({5, 0, 0}), 1.01 * sharp.narrowest).complete);
  // Without triangles a tolerance below `narrowest` is reached where the bodies are near.
  for (const double x : {3.9, 4.0, 4.2, 5.0, 7.0}) {
    for (const double tolerance : {0.0, 0.5, 1.0, 3.0}) {
      const DistanceResult found = of_plain.distance(shift({x, 0, 0}), tolerance);
      EXPECT_LE(found.distance.upper - found.distance.lower,
                std::max(tolerance, found.narrowest) * (1 + 1e-3));
      EXPECT_EQ(found.complete, found.distance.upper - found.distance.lower <= tolerance);
    }
  }
  EXPECT_TRUE(of_plain.distance(shift({3.9, 0, 0}), 1).complete);
  EXPECT_GT(of_plain.distance(shift({3.9, 0, 0}), 1).narrowest, 1);
  const DistanceResult meeting = of_exact.distance(shift({1.9, 0.1, 0}), 0);
  EXPECT_TRUE(meeting.complete);
  EXPECT_EQ(meeting.narrowest, 0);
  // So far apart that floats cannot tell the leaves from each other.
  EXPECT_FALSE(of_exact.distance(shift({1e12, 0, 0}), 1e-3).complete);
}

TEST(Query, MovesWithItsAnswers) {
  static_assert(std::is_nothrow_move_constructible_v<Query> &&
                std::is_nothrow_move_assignable_v<Query> && !std::is_copy_constructible_v<Query>);
  static_assert(std::is_nothrow_move_constructible_v<ContactManifold> &&
                std::is_nothrow_move_constructible_v<ReferenceQuery> &&
                std::is_nothrow_move_constructible_v<SphereTree>);
  const SphereTree tree = ball(0.25);
  const Eigen::Isometry3d pose = shift({3.5, 0, 0});
  Query first(tree, tree, {.workers = 2});
  const std::uint64_t expected = first.leaf_pairs(pose, {}).leaf_pairs;
  ASSERT_GT(expected, 0u);
  Query second = std::move(first);
  EXPECT_EQ(second.leaf_pairs(pose, {}).leaf_pairs, expected);
  first = Query(tree, tree);
  EXPECT_EQ(first.leaf_pairs(pose, {}).leaf_pairs, expected);
}

TEST(ContactManifold, GivesTheWrenchOfAStiffness) {
  const SphereTree tree = ball(0.25);
  Query query(tree, tree);
  ContactManifold near(tree, tree, query.policy(), {.margin = 2}), deep(tree, tree, query.policy());
  ASSERT_EQ(query.contacts(shift({3.9, 0, 0}), near).status, QueryStatus::kDone);
  ASSERT_EQ(query.contacts(shift({3.9, 0, 0}), deep).status, QueryStatus::kDone);
  const Wrench wrench = near.wrench(2);
  EXPECT_EQ(wrench.force, Eigen::Vector3d(2 * near.sums().spring.force));
  EXPECT_EQ(wrench.torque, Eigen::Vector3d(2 * near.sums().spring.torque));
  EXPECT_GT(wrench.force.x(), 0);
  // Springs that begin where surfaces meet push less than those that begin before.
  EXPECT_GT(deep.wrench(2).force.x(), 0);
  EXPECT_LT(deep.wrench(2).force.x(), wrench.force.x());
}

// As far as voxels know it: to within a quarter of a voxel for bodies that curve little, and to
// within a voxel at sharp edges.
TEST(ContactManifold, PushesByDefaultFromWhereSurfacesMeet) {
  constexpr double kSize = 0.25;
  const auto tree_of = [](const TriangleMesh& mesh) {
    return build_tree(mesh, {.voxel_size = kSize});
  };
  const SphereTree ball = tree_of(icosphere(4, 3)), block = tree_of(box({-4, -4, -4}, {4, 4, 0}));
  const struct {
    const SphereTree &fixed, &moving;
    Eigen::Vector3d touching, away;
    double nearest;  // where nothing is felt, voxels
  } pairs[] = {{ball, ball, {6, 0, 0}, {1, 0, 0}, 0.25},
               {block, ball, {0.1, 0.2, 3}, {0, 0, 1}, 0.25},
               {block, block, {0.3, 0.1, 4}, {0, 0, 1}, 0.9}};  // by its sharp edges
  for (const auto& [fixed, moving, touching, away, nearest] : pairs) {
    Query query(fixed, moving);
    ContactManifold manifold(fixed, moving, query.policy());
    ASSERT_EQ(query.policy(), SpherePolicy::kSlab);
    for (const double gap : {nearest, 0.9, 1.4}) {
      const Eigen::Isometry3d pose = shift(touching + gap * kSize * away);
      EXPECT_EQ(query.intersects(pose).answer, Answer::kNo);
      EXPECT_TRUE(query.contacts(pose, manifold).complete);
      EXPECT_TRUE(manifold.points().empty()) << gap;
      EXPECT_EQ(manifold.wrench(1).force, Eigen::Vector3d(0, 0, 0)) << gap;
    }
    EXPECT_TRUE(query.contacts(shift(touching - 0.3 * kSize * away), manifold).complete);
    EXPECT_GT(manifold.wrench(1).force.dot(away), 0);
  }
}

}  // namespace
}  // namespace ist::test
