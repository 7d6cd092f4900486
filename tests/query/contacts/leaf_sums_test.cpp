// Sums by fixed leaf: the same in whatever parts they come, and merged by the octree where there is
// no room.

#include "ist/query/contacts/leaf_sums.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>

#include "ist/tree/tree_parts.h"
#include "query/query_cases.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

struct Pair {
  std::uint32_t fixed;
  float numbers[8];
};

class LeafSumsTest : public ::testing::Test {
 protected:
  // Some pairs of every third leaf; one in five has no weight.
  LeafSumsTest() {
    Random random(5);
    for (std::uint32_t parent = 0; parent < octree_.node_count(1); ++parent) {
      for (int slot = 0; slot < octree_.child_count(1, parent); ++slot) {
        if (random.below(3) != 0) continue;
        for (std::size_t i = random.below(40); i > 0; --i) {
          Pair pair{8 * parent + static_cast<std::uint32_t>(slot), {}};
          for (float& x : pair.numbers) x = static_cast<float>(random.uniform(-1, 1));
          pair.numbers[0] *= pair.numbers[0];
          if (random.below(5) == 0) pair = {pair.fixed, {}};
          pairs_.push_back(pair);
        }
      }
    }
  }

  // Gives pairs [begin, end), at most `most` at a time.
  void give(LeafSums& to, std::size_t begin, std::size_t end, std::size_t most) const {
    const auto terms = std::make_unique<ContactTerms>();
    std::vector<std::uint32_t> fixed(kContactBatch);
    terms->fixed = fixed.data();
    while (begin < end) {
      terms->count = std::min(most, end - begin);
      for (std::size_t i = 0; i < terms->count; ++i) {
        const Pair& pair = pairs_[begin + i];
        float* const lanes[] = {terms->weight, terms->depth,   terms->x,       terms->y,
                                terms->z,      terms->force_x, terms->force_y, terms->force_z};
        for (std::size_t k = 0; k < 8; ++k) lanes[k][i] = pair.numbers[k];
        fixed[i] = pair.fixed;
      }
      begin += terms->count;
      to.take(*terms);
    }
  }
  [[nodiscard]] LeafSums all(std::size_t room) const {
    LeafSums sums(octree_, room);
    give(sums, 0, pairs_.size(), kContactBatch);
    sums.close();
    return sums;
  }

  static void expect_same(LeafSums& a, LeafSums& b) {
    ASSERT_EQ(a.nodes().size(), b.nodes().size());
    EXPECT_EQ(a.level(), b.level());
    for (std::size_t i = 0; i < a.nodes().size(); ++i) {
      const LeafSum &x = a.nodes()[i], &y = b.nodes()[i];
      ASSERT_TRUE(x.node == y.node && x.first == y.first && x.weight == y.weight &&
                  x.depth == y.depth && x.position == y.position && x.force == y.force)
          << i;
    }
  }

  const SphereTree tree_ = tree_of(icosphere(3, 1), 24);
  const LinearOctree& octree_ = voxels_of(tree_).octree;
  std::vector<Pair> pairs_;
};

TEST_F(LeafSumsTest, AreThoseOfEachLeaf) {
  std::map<std::uint32_t, double> weights, depths;
  for (const Pair& pair : pairs_) {
    if (!(pair.numbers[0] > 0)) continue;
    weights[pair.fixed] += pair.numbers[0];
    depths[pair.fixed] += double{pair.numbers[0]} * pair.numbers[1];
  }
  LeafSums sums = all(octree_.leaf_count());
  ASSERT_EQ(sums.nodes().size(), weights.size());
  EXPECT_EQ(sums.level(), 0);
  auto wanted = weights.begin();
  for (const LeafSum& leaf : sums.nodes()) {
    EXPECT_EQ(leaf.node, wanted->first);
    EXPECT_EQ(leaf.weight, wanted->second);
    EXPECT_EQ(leaf.depth, depths[leaf.node]);
    ++wanted;
  }
}

TEST_F(LeafSumsTest, DoNotDependOnBatches) {
  for (const std::size_t room : {100'000u, 50u, 3u, 1u}) {
    LeafSums whole = all(room);
    for (const std::size_t most : {1u, 7u, 100u}) {
      LeafSums parts(octree_, room);
      give(parts, 0, pairs_.size(), most);
      parts.close();
      expect_same(parts, whole);
    }
  }
}

// As a worker's are appended to the caller's: cut between two leaves.
TEST_F(LeafSumsTest, DoNotDependOnWhoTookThem) {
  for (const std::size_t room : {100'000u, 50u, 3u}) {
    LeafSums whole = all(room);
    for (std::size_t cut = 1; cut < pairs_.size(); cut += 97) {
      if (pairs_[cut].fixed == pairs_[cut - 1].fixed) continue;
      LeafSums first(octree_, room), second(100'000);
      give(first, 0, cut, 64);
      give(second, cut, pairs_.size(), 64);
      second.close();
      EXPECT_FALSE(second.is_short());
      first.append(second.nodes());
      first.close();
      expect_same(first, whole);
      if (HasFailure()) return;
    }
  }
}

// By ancestors found one by one; no coarser than one level that did not fit.
TEST_F(LeafSumsTest, AreMergedByCommonAncestor) {
  LeafSums leaves = all(octree_.leaf_count());
  int coarsest = 0;
  for (std::size_t room = leaves.nodes().size() - 1; room > 0; room = room * 3 / 5) {
    LeafSums merged = all(room);
    EXPECT_LE(merged.nodes().size(), room);
    ASSERT_GT(merged.level(), 0);
    coarsest = std::max(coarsest, merged.level());
    std::map<std::uint32_t, double> finer, weights;
    for (const LeafSum& leaf : leaves.nodes()) {
      std::uint32_t node = leaf.node / 8, below = leaf.node;
      for (int level = 1; level < merged.level(); ++level) {
        below = node;
        std::uint32_t parent = 0;
        while (octree_.nodes(level + 1)[parent + 1].first_child <= node) ++parent;
        node = parent;
      }
      finer[below] += leaf.weight;
      weights[node] += leaf.weight;
    }
    EXPECT_GT(finer.size(), room);
    ASSERT_EQ(merged.nodes().size(), weights.size());
    auto wanted = weights.begin();
    for (const LeafSum& node : merged.nodes()) {
      EXPECT_EQ(node.node, wanted->first);
      EXPECT_NEAR(node.weight, wanted->second, 1e-12 * wanted->second);
      ++wanted;
    }
  }
  EXPECT_EQ(coarsest, octree_.depth());
}

TEST_F(LeafSumsTest, SayWhatDoesNotFitWhereNothingMerges) {
  const std::size_t count = all(octree_.leaf_count()).nodes().size();
  for (const std::size_t room : {count - 1, count, count + 1}) {
    LeafSums list(room);
    give(list, 0, pairs_.size(), 100);
    list.close();
    EXPECT_EQ(list.is_short(), room < count);
    list.shorten(1);
    EXPECT_FALSE(list.is_short());
    EXPECT_EQ(list.nodes().size(), 1u);
  }
}

}  // namespace
}  // namespace ist::test
