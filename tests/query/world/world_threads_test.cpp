// A world that several threads ask.
#include <gtest/gtest.h>

#include "query/workers/stall.h"
#include "query/world/world_cases.h"
#include "support/effort.h"

namespace ist::test {
namespace {

TEST(WorldThread, AnswersAsOneThreadDoes) {
  const Awake awake;
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{4}); ++seed) {
    Random random(seed);
    const std::vector<PlacedTree> bodies = scattered(random, 20, 5);
    WorldOptions options = small_world();
    options.query.front_pairs = seed % 2 == 0 ? 0 : 500;
    World alone = world_of(bodies, options);
    const WorldAnswers expected = answers_of(alone);
    EXPECT_GT(expected.pairs.size(), 10u);
    for (const std::size_t threads : {std::size_t{2}, std::size_t{3}, kMostThreads}) {
      options.threads = threads;
      World world = world_of(bodies, options);
      for (int turn = 0; turn < 20; ++turn) EXPECT_EQ(answers_of(world), expected);
    }
  }
}

// Each pair has its tests, and the sum is the same.
TEST(WorldThread, CountsTheSameTests) {
  const Awake awake;
  Random random(1);
  const std::vector<PlacedTree> bodies = scattered(random, 20, 5);
  WorldOptions options = small_world();
  World alone = world_of(bodies, options);
  options.threads = 4;
  World world = world_of(bodies, options);
  for (const WorldQuestion& question : {kIntersects, kContacts, distance_within(1e-3)}) {
    const WorldAnswer expected = alone.ask(question);
    const WorldAnswer found = world.ask(question);
    EXPECT_EQ(found.sphere_tests, expected.sphere_tests);
    ASSERT_EQ(found.pairs.size(), expected.pairs.size());
    for (std::size_t k = 0; k < found.pairs.size(); ++k) {
      EXPECT_EQ(found.pairs[k].sphere_tests, expected.pairs[k].sphere_tests);
      EXPECT_EQ(found.pairs[k].distance.lower, expected.pairs[k].distance.lower);
      EXPECT_EQ(found.pairs[k].distance.upper, expected.pairs[k].distance.upper);
    }
  }
}

}  // namespace
}  // namespace ist::test
