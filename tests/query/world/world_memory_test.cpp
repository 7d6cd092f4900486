// What a world asks for before it reserves it, and what it refuses.
#include <gtest/gtest.h>

#include <limits>

#include "query/triangles/triangle_tree.h"
#include "query/world/world_cases.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

class WorldMemory : public ::testing::Test {
 protected:
  // Balls of three sizes of voxels, one without triangles.
  static const std::vector<SphereTree>& trees() {
    static const std::vector<SphereTree> made = {
        triangle_tree(icosphere(3, 1), 20), triangle_tree(icosphere(2, 1), 7),
        without_triangles(triangle_tree(icosphere(2, 1), 12))};
    return made;
  }
  static World world_of_trees(const WorldOptions& options) {
    World world(options);
    double x = 0;
    for (const SphereTree& tree : trees()) world.add(tree, shift({x += 1.5, 0, 0}));
    return world;
  }
};

TEST_F(WorldMemory, IsAskedForBeforeItIsReserved) {
  for (const SpherePolicy policy : kSpherePolicies) {
    for (const std::size_t front_pairs : {0u, 1000u, 4097u}) {
      for (const std::size_t frontier_pairs : {1u, 300u, 65536u}) {
        for (const std::size_t points : {0u, 5u}) {
          WorldOptions options;
          options.query.policy = policy;
          options.query.front_pairs = front_pairs;
          options.query.frontier_pairs = frontier_pairs;
          options.manifold.points = points;
          World world = world_of_trees(options);
          const std::uint64_t needed = world.bytes_needed();
          EXPECT_EQ(world.bytes(), 0u);
          for (BodyIndex a = 0; a < 3; ++a) {
            for (BodyIndex b = a + 1; b < 3; ++b) {
              const Query query(trees()[a], trees()[b], options.query);
              const ContactManifold manifold(trees()[a], trees()[b], policy, options.manifold);
              EXPECT_EQ(world.bytes_for(b, a), query.bytes() + manifold.bytes());
            }
          }
          world.prepare();
          EXPECT_EQ(world.bytes(), needed);
          EXPECT_EQ(world.bytes_needed(), needed);
        }
      }
    }
  }
}

TEST_F(WorldMemory, WithoutVoxelsIsThatOfTheQueryAlone) {
  const SphereTree alone = build_tree(icosphere(3, 1));
  World world;
  world.add(trees()[0], shift({0, 0, 0}));
  world.add(alone, shift({1.5, 0, 0}));
  world.add(alone, shift({3, 0, 0}));
  EXPECT_EQ(world.bytes_for(0, 1), Query(trees()[0], alone).bytes());
  EXPECT_EQ(world.bytes_for(1, 2), Query(alone, alone).bytes());
  const std::uint64_t needed = world.bytes_needed();
  world.prepare();
  EXPECT_EQ(world.bytes(), needed);
}

TEST_F(WorldMemory, BeyondTheLimitNamesThePair) {
  WorldOptions options = small_world();
  World roomy(options);
  const char* const names[] = {"upper jaw", "lower jaw", "plate"};
  std::size_t at = 0;
  for (const SphereTree& tree : trees()) roomy.add(tree, shift({1.5, 0, 0}), names[at++]);
  const std::uint64_t all = roomy.bytes_needed();
  const BodyPair first_two[] = {{0, 1}, {2, 0}};
  const std::uint64_t two = roomy.bytes_needed(first_two);
  EXPECT_LT(two, all);
  for (const std::uint64_t limit : {all - 1, two, two - 1, std::uint64_t{0}}) {
    options.max_memory = limit;
    World world(options);
    at = 0;
    for (const SphereTree& tree : trees()) world.add(tree, shift({1.5, 0, 0}), names[at++]);
    const std::optional<Error> error = error_of([&] { world.prepare(); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ErrorCode::kMemoryLimit);
    const std::string text = error->what();
    const auto has = [&](const char* part) { return text.find(part) != std::string::npos; };
    EXPECT_TRUE(has("max_memory")) << text;
    if (limit == 0) {
      EXPECT_TRUE(has("answers of up to 3 pairs")) << text;
    } else {
      EXPECT_TRUE(has(limit >= two ? "'lower jaw' and 'plate'" : "'upper jaw' and 'plate'"))
          << text;
      EXPECT_TRUE(has(limit >= two ? "with 2 pairs before it" : "with 1 pair before it")) << text;
      EXPECT_TRUE(has("prepare fewer pairs")) << text;
    }
    // Nothing was made.
    EXPECT_EQ(world.bytes(), 0u);
    EXPECT_EQ(world.query(0, 1), nullptr);
    EXPECT_EQ(world.ask(kIntersects).status, QueryStatus::kNotPrepared);
    if (limit < two) continue;
    // What fits can be prepared; and what was there stays where more does not fit.
    world.prepare(first_two);
    EXPECT_EQ(world.bytes(), two);
    Query* const kept = world.query(0, 1);
    ASSERT_NE(kept, nullptr);
    EXPECT_EQ(error_name([&] { world.prepare(); }), "memory-limit");
    EXPECT_EQ(world.query(0, 1), kept);
    EXPECT_EQ(world.bytes(), two);
    EXPECT_EQ(world.ask(kIntersects).status, QueryStatus::kDone);
  }
}

// Queries are kept for reuse, with what they know; others go.
TEST_F(WorldMemory, OfAPairThatIsPreparedAgainIsKept) {
  World world = world_of_trees(small_world());
  const BodyPair some[] = {{0, 1}, {1, 2}}, others[] = {{0, 1}, {0, 2}};
  world.prepare(some);
  const Query* const kept = world.query(1, 0);
  ASSERT_NE(world.query(1, 2), nullptr);
  world.prepare(others);
  EXPECT_EQ(world.query(0, 1), kept);
  EXPECT_EQ(world.query(1, 2), nullptr);
  EXPECT_NE(world.query(0, 2), nullptr);
  world.add(trees()[0]);
  world.prepare(others);
  EXPECT_EQ(world.query(0, 1), kept);
  world.prepare({});
  EXPECT_EQ(world.query(0, 1), nullptr);
  EXPECT_EQ(world.ask(kNear).pairs[0].status, QueryStatus::kNotPrepared);
}

TEST_F(WorldMemory, IsAsItWasWhereItsCallerEndsThePreparation) {
  World world = world_of_trees(small_world());
  const BodyPair some[] = {{0, 1}};
  world.prepare(some);
  const Query* const kept = world.query(0, 1);
  const std::uint64_t bytes = world.bytes();
  int asked = 0, last = 0;
  const Proceed proceed = [&](double part) {
    EXPECT_EQ(part, asked / 3.0);
    return asked++ != last;
  };
  for (last = 0; last < 3; ++last) {
    asked = 0;
    EXPECT_EQ(error_name([&] { world.prepare(std::nullopt, proceed); }), "cancelled");
    EXPECT_EQ(asked, last + 1);
    EXPECT_EQ(world.query(0, 1), kept);
    EXPECT_EQ(world.query(0, 2), nullptr);
    EXPECT_EQ(world.bytes(), bytes);
  }
  asked = 0;
  world.prepare(std::nullopt, proceed);
  EXPECT_EQ(asked, 3);
  EXPECT_NE(world.query(1, 2), nullptr);
  world.prepare(some, {});
  EXPECT_EQ(world.query(0, 1), kept);
  EXPECT_EQ(world.query(1, 2), nullptr);
}

TEST_F(WorldMemory, OutlivesTheTreesAndMoves) {
  World first = [] {
    World world(small_world());
    for (int i = 0; i < 3; ++i) {
      const SphereTree short_lived = triangle_tree(icosphere(2, 1), 8);
      world.add(short_lived);
    }
    return world;
  }();
  first.prepare();
  World second = std::move(first);
  EXPECT_EQ(second.ask(kIntersects).pairs.size(), 3u);
  first = World();
  EXPECT_EQ(first.body_count(), 0u);
}

TEST_F(WorldMemory, MisuseThrows) {
  const SphereTree tree = trees()[1];
  const auto refusal = [](const auto& action) {
    const std::optional<Error> error = error_of(action);
    return error ? std::string(to_string(error->code())) + ": " + error->what() : "none";
  };
  const auto expect = [](const std::string& text, const char* code, const char* part) {
    EXPECT_EQ(text.find(code), 0u) << text;
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  WorldOptions options = small_world();
  options.query.workers = 2;
  expect(refusal([&] { World{options}; }), "argument-invalid", "workers is 2");
  options = small_world();
  for (const double reach : {-1.0, HUGE_VAL, std::numeric_limits<double>::quiet_NaN()}) {
    options.reach = reach;
    expect(refusal([&] { World{options}; }), "argument-invalid", "reach");
  }
  options = small_world();
  options.most_near = kMostItems + 1;
  expect(refusal([&] { World{options}; }), "argument-invalid", "most_near");
  options = small_world();
  options.query.target = "abacus";
  expect(refusal([&] { World{options}; }), "target-missing", "abacus");

  World world(small_world());
  EXPECT_EQ(world.add(tree, shift({0, 0, 0}), "jaw"), 0u);
  EXPECT_EQ(world.add(tree), 1u);
  EXPECT_EQ(world.name(0), "jaw");
  EXPECT_EQ(world.name(1), "body 1");
  EXPECT_EQ(world.name(2), "");
  expect(refusal([&] { world.ignore(0, 2); }), "argument-invalid", "body 2 is not there");
  expect(refusal([&] { world.ignore(0, 0); }), "argument-invalid", "'jaw'");
  expect(refusal([&] { static_cast<void>(world.bytes_for(7, 0)); }), "argument-invalid", "body 7");
  const BodyPair pair{1, 0}, wrong{0, 9};
  expect(refusal([&] { world.prepare({&wrong, 1}); }), "argument-invalid", "body 9");
  world.ignore(0, 1);
  expect(refusal([&] { world.prepare({&pair, 1}); }), "argument-invalid", "'jaw' and 'body 1'");
  Eigen::Isometry3d bad = shift({0, 0, 0});
  bad.linear() *= 2;
  expect(refusal([&] { world.add(tree, bad, "scaled"); }), "pose-invalid", "'scaled'");
  EXPECT_EQ(world.body_count(), 2u);
  EXPECT_EQ(world.set_pose(2, shift({0, 0, 0})), QueryStatus::kNoSuchBody);
  EXPECT_STREQ(to_string(QueryStatus::kNoSuchBody), "no-such-body");
  EXPECT_FALSE(world.pose_of(0, 2));
  EXPECT_EQ(world.query(0, 2), nullptr);

  const SphereTree loose =
      build_tree(icosphere(1, 1), {.voxel_size = 0.5, .spheres = SpherePolicy::kTable});
  options = small_world();
  options.query.policy = SpherePolicy::kSlab;
  World of_slabs(options);
  expect(refusal([&] {
           of_slabs.add(loose, shift({0, 0, 0}), "loose");
         }),
         "policy-missing", "loose");
  options = small_world();
  options.manifold.margin = 7;
  World margin(options);
  margin.add(tree);
  margin.add(tree);
  expect(refusal([&] { margin.prepare(); }), "argument-invalid", "margin");
}

TEST_F(WorldMemory, OfBodiesInDifferentFramesIsRefused) {
  const auto in = [](PatientFrame frame) {
    TriangleMesh mesh = icosphere(1, 1);
    mesh.frame = frame;
    return build_tree(mesh, {.voxel_size = 0.5});
  };
  const SphereTree upper = in(PatientFrame::kLps), plain = in(PatientFrame::kUnknown),
                   other = in(PatientFrame::kRas);
  World world;
  world.add(upper, Eigen::Isometry3d::Identity(), "upper");
  world.add(plain);
  const std::optional<Error> error = error_of([&] { world.add(other); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kArgumentInvalid);
  EXPECT_NE(std::string(error->what()).find("'upper' is in lps"), std::string::npos)
      << error->what();
}

TEST_F(WorldMemory, OfBodiesInDifferentUnitsIsRefused) {
  TriangleMesh mesh = icosphere(1, 1);
  mesh.unit = LengthUnit::kMetre;
  const SphereTree upper = build_tree(mesh, {.voxel_size = 0.5});
  World world;
  world.add(upper, Eigen::Isometry3d::Identity(), "upper");
  mesh.unit = LengthUnit::kInch;
  const SphereTree other = build_tree(mesh, {.voxel_size = 0.5});
  const std::optional<Error> error = error_of([&] { world.add(other); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kArgumentInvalid);
  EXPECT_NE(std::string(error->what()).find("is in inch, and 'upper' is in m:"), std::string::npos)
      << error->what();
}

TEST_F(WorldMemory, OfTooManyBodiesIsRefused) {
  const SphereTree tree = trees()[1];
  World world(small_world());
  for (BodyIndex i = 0; i < kMostBodies; ++i) world.add(tree);
  const std::optional<Error> error = error_of([&] {
    world.add(tree, shift({0, 0, 0}), "one more");
  });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kArgumentInvalid);
  EXPECT_NE(std::string(error->what()).find("'one more'"), std::string::npos);
  EXPECT_EQ(world.body_count(), kMostBodies);
}

}  // namespace
}  // namespace ist::test
