// A world is as quiet as its queries.
#include <gtest/gtest.h>

#include <vector>

#include "query/quiet/allocations.h"
#include "query/quiet/locks.h"
#include "query/quiet/world_ticks.h"

namespace ist::test {
namespace {

TEST(Allocations, AWorldMakesNone) {
  World world = row_of_balls();
  std::vector<LeafPair> leaves(1 << 10);
  std::vector<TrianglePair> triangles(1 << 10);
  const std::uint64_t before = allocations();
  const std::uint64_t found = ask_everything(world, leaves, triangles);
  EXPECT_EQ(allocations() - before, 0u);
  EXPECT_GT(found, 10000u);
}

TEST(Locks, AWorldAsksForNone) {
  World world = row_of_balls();
  std::vector<LeafPair> leaves(1 << 10);
  std::vector<TrianglePair> triangles(1 << 10);
  const std::uint64_t before = locks();
  static_cast<void>(ask_everything(world, leaves, triangles));
  EXPECT_EQ(locks() - before, 0u);
}

}  // namespace
}  // namespace ist::test
