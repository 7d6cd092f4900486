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
          EXPECT_EQ(world.bytes(), 0u);
          std::uint64_t last = 0;
          for (const std::size_t near_pairs : {std::size_t{1}, std::size_t{2}, kAllPairs}) {
            const std::uint64_t needed = world.bytes_needed(near_pairs);
            world.reserve(near_pairs);
            EXPECT_EQ(world.bytes(), needed);
            EXPECT_GT(needed, last);
            last = needed;
          }
          EXPECT_EQ(world.bytes_needed(3), last);
          EXPECT_EQ(world.bytes_needed(0), world.bytes_needed(1));
        }
      }
    }
  }
}

// Leaves take memory only if two bodies have voxels.
TEST_F(WorldMemory, WithoutVoxelsIsOfTrianglesAlone) {
  const TriangleMesh ball = icosphere(3, 1);
  WorldOptions options = small_world();
  options.query.front_pairs = 1000;
  const auto world_with = [&](int voxels) {
    World world(options);
    for (int k = 0; k < 3; ++k) {
      world.add(k < voxels ? build_tree(ball, {.voxel_size = 0.1}) : build_tree(ball),
                shift({1.5 * k, 0, 0}));
    }
    const std::uint64_t needed = world.bytes_needed();
    world.reserve();
    EXPECT_EQ(world.bytes(), needed);
    return needed;
  };
  EXPECT_EQ(world_with(1), world_with(0));
  EXPECT_GT(world_with(2), world_with(1) + 2 * 1000 * 68);
  EXPECT_EQ(world_with(3), world_with(2));
}

// Neither voxels nor triangles answer the pair, unless the world never looks at it.
TEST_F(WorldMemory, PairWithNothingInCommonIsRefused) {
  World world(small_world());
  world.add(without_triangles(trees()[0]), shift({0, 0, 0}), "leaves");
  world.add(build_tree(icosphere(3, 1)), shift({1.5, 0, 0}), "mesh");
  world.add(trees()[1], shift({3, 0, 0}), "both");
  for (const bool reserves : {false, true}) {
    const std::optional<Error> error = error_of([&] {
      if (reserves) {
        world.reserve();
      } else {
        static_cast<void>(world.bytes_needed());
      }
    });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ErrorCode::kVoxelsMissing);
    const std::string text = error->what();
    EXPECT_NE(text.find("'mesh' has no voxels, and 'leaves' no triangles"), std::string::npos)
        << text;
  }
  world.ignore(0, 1);
  world.reserve();
  const WorldAnswer near = world.ask(kIntersects);
  ASSERT_EQ(near.pairs.size(), 1u);
  EXPECT_EQ(near.pairs[0].bodies, (BodyPair{1, 2}));
  EXPECT_EQ(near.pairs[0].answer, Answer::kYes);
  world.set_pose(2, shift({0, 0.5, 0}));
  const WorldAnswer both = world.ask(kIntersects);
  ASSERT_EQ(both.pairs.size(), 2u);
  EXPECT_EQ(both.pairs[0].answer, Answer::kNear);
  EXPECT_EQ(both.pairs[1].answer, Answer::kYes);
  const WorldAnswer felt = world.ask(kContacts);
  EXPECT_EQ(felt.pairs[0].status, QueryStatus::kDone);
  EXPECT_EQ(felt.pairs[1].status, QueryStatus::kNoVoxels);
  EXPECT_EQ(world.manifold(1, 2), nullptr);
  EXPECT_NE(world.manifold(0, 2), nullptr);
}

// One query a thread, whatever the number of bodies.
TEST_F(WorldMemory, GrowsWithThreadsAndPairCaches) {
  WorldOptions options = small_world();
  const auto needed = [&] { return world_of_trees(options).bytes_needed(3); };
  const std::uint64_t one = needed();
  options.threads = 3;
  const std::uint64_t three = needed();
  options.threads = 2;
  EXPECT_GT(needed(), one);
  EXPECT_EQ(three - needed(), needed() - one);
  options.threads = 1;
  options.query.front_pairs = 1000;
  options.pair_caches = 0;
  EXPECT_EQ(needed(), one);
  options.pair_caches = 2;
  EXPECT_GT(needed(), one + 2 * 1000 * 68);
}

TEST_F(WorldMemory, BeyondTheLimitIsRefused) {
  WorldOptions options = small_world();
  World world = world_of_trees(options);
  const std::uint64_t all = world.bytes_needed(), one = world.bytes_needed(1);
  EXPECT_LT(one, all);
  for (const std::uint64_t limit : {all - 1, one, one - 1, std::uint64_t{0}}) {
    options.max_memory = limit;
    World small = world_of_trees(options);
    const std::optional<Error> error = error_of([&] { small.reserve(); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ErrorCode::kMemoryLimit);
    const std::string text = error->what();
    for (const char* const part : {"3 near pairs", "max_memory", "reserve for fewer pairs"}) {
      EXPECT_NE(text.find(part), std::string::npos) << text;
    }
    // Names that C and Python have too, and small limits in bytes.
    EXPECT_NE(text.find("lower frontier_pairs, front_pairs or pair_caches"), std::string::npos);
    EXPECT_EQ(text.find("0.0 MB"), std::string::npos) << text;
    if (limit == 0) {
      EXPECT_NE(text.find("max_memory, 0 bytes:"), std::string::npos) << text;
    }
    // Nothing was made.
    EXPECT_EQ(small.bytes(), 0u);
    EXPECT_EQ(small.ask(kIntersects).status, QueryStatus::kNotPrepared);
    if (limit < one) continue;
    // Fewer pairs can be reserved for, and these stay where more do not fit.
    small.reserve(1);
    EXPECT_EQ(small.bytes(), one);
    EXPECT_EQ(error_name([&] { small.reserve(); }), "memory-limit");
    EXPECT_EQ(small.bytes(), one);
    EXPECT_EQ(small.ask(kIntersects).pairs.size(), 1u);
  }
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
  first.reserve();
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
  for (const std::size_t threads : {std::size_t{0}, kMostThreads + 1}) {
    options.threads = threads;
    expect(refusal([&] { World{options}; }), "argument-invalid", "threads is");
  }
  options = small_world();
  options.query.front_pairs = kMostItems + 1;
  expect(refusal([&] { World{options}; }), "argument-invalid", "front_pairs");
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
  Eigen::Isometry3d bad = shift({0, 0, 0});
  bad.linear() *= 2;
  expect(refusal([&] { world.add(tree, bad, "scaled"); }), "pose-invalid", "'scaled'");
  EXPECT_EQ(world.body_count(), 2u);
  EXPECT_EQ(world.set_pose(2, shift({0, 0, 0})), QueryStatus::kNoSuchBody);
  EXPECT_STREQ(to_string(QueryStatus::kNoSuchBody), "no-such-body");
  EXPECT_FALSE(world.pose_of(0, 2));

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
  expect(refusal([&] { margin.reserve(); }), "argument-invalid", "margin");
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
