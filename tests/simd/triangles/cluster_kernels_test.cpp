#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <set>

#include "ist/mesh/triangles_meet.h"
#include "ist/query/triangles/triangle_distance.h"
#include "ist/query/triangles/triangle_visitors.h"
#include "simd/dispatch.h"
#include "simd/targets.h"
#include "simd/triangles/cluster_cases.h"

namespace ist::test {
namespace {

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

// Room for what the kernels find.
struct Room {
  static constexpr std::size_t kLength = FoundTriangles::kRoom + kClusterWidth;
  std::vector<std::uint32_t> ids = std::vector<std::uint32_t>(4 * kLength);
  std::vector<float> squares = std::vector<float>(kLength);
  TriangleBatch batch;
  FoundTriangles found{{ids.data(), ids.data() + kLength},
                       {ids.data() + 2 * kLength, ids.data() + 3 * kLength},
                       squares.data()};
};

// Two zeros are equal, whatever their signs.
std::vector<float> numbers_of(const TurnedBlock& block) {
  std::vector<float> numbers(sizeof block / sizeof(float));
  std::memcpy(numbers.data(), &block, sizeof block);
  return numbers;
}

using Codes = std::vector<std::uint32_t>;

// All nodes of a level, each with a lane, and room behind them that kernels may read.
Codes all(std::uint32_t count, std::uint32_t lane) {
  Codes codes(count + kClusterWidth, 0xBAD);
  for (std::uint32_t node = 0; node < count; ++node) codes[node] = kClusterWidth * node + lane;
  return codes;
}

LaneNodes list(const Codes& codes) { return {codes.data(), codes.size()}; }
LaneNodes first(const Codes& codes, std::size_t count) { return {codes.data(), count}; }

// What the node tests of some kernels find: bits, pairs of a lane and a node, and of a child.
struct NodesFound {
  Codes bits, near, deeper;

  NodesFound(const ClusterKernels& kernels, const TurnedBlock& turned, std::uint32_t lanes,
             const FixedNodes& parents, const FixedNodes& children, float reach) {
    const Codes nodes = all(parents.count, 3);
    const LaneNodes each = first(nodes, parents.count);
    bits.resize(nodes.size());
    kernels.meet_nodes(turned, lanes, parents, each, reach, bits.data());
    near.resize(kClusterWidth * nodes.size());
    near.resize(kernels.list_lanes(each, bits.data(), near.data()));
    bits.resize(parents.count);
    deeper.resize(kClusterWidth * std::size_t{children.count} + kClusterWidth);
    deeper.resize(kernels.meet_children(turned, children, list(near), reach, deeper.data()));
  }
};

class ClusterKernelsOf : public ::testing::TestWithParam<std::string> {
 protected:
  const ClusterKernels& kernels_ = select_kernels(GetParam()).clusters;
  static inline const ClusterKernels& kScalar = kScalarClusterKernels;
};
INSTANTIATE_TEST_SUITE_P(Targets, ClusterKernelsOf, ::testing::ValuesIn(all_targets()), name_of);

TEST_P(ClusterKernelsOf, TestNodesAsTheScalarForm) {
  std::size_t near = 0, tested = 0;
  for (const ClusterCase& c : cluster_cases()) {
    SCOPED_TRACE(c.name);
    for (int level = 0; level <= c.moving_clusters.root_level(); ++level) {
      const auto blocks = c.moving_clusters.bounds(level);
      for (std::uint32_t block = 0; block < blocks.size(); ++block) {
        TurnedBlock turned, wanted;
        kernels_.turn_nodes(blocks[block], c.step.pose, turned);
        kScalar.turn_nodes(blocks[block], c.step.pose, wanted);
        ASSERT_EQ(numbers_of(turned), numbers_of(wanted));
        const std::uint32_t lanes =
            std::min(kClusterWidth, c.moving_clusters.node_count(level) - kClusterWidth * block);
        const int fixed_level = std::min(level, c.fixed_clusters.root_level() - 1);
        const FixedNodes parents{c.fixed_clusters.bounds(fixed_level + 1).data(),
                                 c.fixed_clusters.node_count(fixed_level + 1)};
        const FixedNodes children{c.fixed_clusters.bounds(fixed_level).data(),
                                  c.fixed_clusters.node_count(fixed_level)};
        for (const float reach : {0.0F, 1e-3F, 0.4F}) {
          const NodesFound mine(kernels_, turned, lanes, parents, children, reach);
          const NodesFound theirs(kScalar, wanted, lanes, parents, children, reach);
          ASSERT_EQ(mine.bits, theirs.bits);
          ASSERT_EQ(mine.near, theirs.near);
          ASSERT_EQ(mine.deeper, theirs.deeper);
          near += mine.near.size();
          tested += lanes * parents.count;
        }
        alignas(64) float scores[16], scores_wanted[16];
        for (std::uint32_t lane = 0; lane < lanes; lane += 5) {
          kernels_.score_children(turned, lane, children.blocks[0], scores);
          kScalar.score_children(wanted, lane, children.blocks[0], scores_wanted);
          ASSERT_EQ(std::memcmp(scores, scores_wanted, sizeof scores), 0);
        }
      }
    }
  }
  EXPECT_GT(near, tested / 50);
  EXPECT_LT(near, tested / 2);
}

// The lists of an odd number of nodes, whose bits are of any lanes, and of none.
TEST_P(ClusterKernelsOf, ListLanesAsTheScalarForm) {
  for (const std::uint32_t count : {0U, 1U, 7U, 16U, 33U}) {
    const Codes nodes = all(count, 9);
    Codes bits(count + kClusterWidth, 0xFFFF);
    for (std::uint32_t k = 0; k < count; ++k) bits[k] = (k * 40503U + 7U * k * k) & 0xFFFFU;
    Codes mine(kClusterWidth * count + kClusterWidth), theirs = mine;
    mine.resize(kernels_.list_lanes(first(nodes, count), bits.data(), mine.data()));
    theirs.resize(kScalar.list_lanes(first(nodes, count), bits.data(), theirs.data()));
    EXPECT_EQ(mine, theirs);
    EXPECT_EQ(mine.empty(), count < 2);
  }
}

// Calls `ask` for each block of moving clusters, with all pairs of them and fixed clusters whose
// nodes may be within `reach`.
template <class Ask>
void each_block(const ClusterKernels& kernels, const ClusterCase& c, float reach, Ask ask) {
  const TriangleClusters &fixed = c.fixed_clusters, &moving = c.moving_clusters;
  const FixedNodes parents{fixed.bounds(1).data(), fixed.node_count(1)};
  const FixedNodes children{fixed.bounds(0).data(), fixed.node_count(0)};
  for (std::uint32_t block = 0; block < moving.node_count(1); ++block) {
    TurnedBlock turned;
    kernels.turn_nodes(moving.bounds(0)[block], c.step.pose, turned);
    const NodesFound found(kernels, turned, moving.child_count(0, block), parents, children, reach);
    ask(ClusterPairs{turned, kClusterWidth * block, list(found.deeper)});
  }
}

// What is certain is true, and what is true is certain or open.
TEST_P(ClusterKernelsOf, MissNoPairThatMeetsAndInventNone) {
  std::size_t meeting = 0, open = 0;
  for (const ClusterCase& c : cluster_cases()) {
    SCOPED_TRACE(c.name);
    Pairs certain, undecided;
    Room room;
    each_block(kernels_, c, c.step.pose.error, [&](const ClusterPairs& clusters) {
      for (std::size_t done = 0; done < clusters.pairs.count;) {
        done += kernels_.meet_clusters(
            c.step,
            {clusters.lanes, clusters.moving, clusters.pairs.part(done, clusters.pairs.count)},
            room.batch, room.found);
        kernels_.decide_triangles(room.batch, room.found);
        for (std::size_t k = 0; k < room.found.certain.count; ++k) {
          certain.insert({room.found.certain[k].fixed, room.found.certain[k].moving});
        }
        for (std::size_t k = 0; k < room.found.open.count; ++k) {
          undecided.insert({room.found.open[k].fixed, room.found.open[k].moving});
        }
        room.found.certain.count = room.found.open.count = 0;
      }
    });
    for (std::uint32_t f = 0; f < c.fixed.triangles.size(); ++f) {
      for (std::uint32_t m = 0; m < c.moving.triangles.size(); ++m) {
        const auto a = corners_of(c.fixed, f), b = corners_of(c.moving, m);
        const bool is_certain = certain.count({f, m}) > 0;
        if (box_distance_squared(a, b) > 0) {
          ASSERT_FALSE(is_certain) << f << ' ' << m;
          continue;
        }
        const bool meet = triangles_meet(a, b);
        meeting += meet ? 1U : 0U;
        if (is_certain) {
          ASSERT_TRUE(meet) << f << ' ' << m;
        } else if (meet) {
          ASSERT_TRUE(undecided.count({f, m}) > 0) << f << ' ' << m;
        }
      }
    }
    if (c.name != "on itself") open += undecided.size();
  }
  EXPECT_GT(meeting, 2000u);
  EXPECT_LT(open, meeting / 5);
}

// The nearest pair is never left out, and its lower bound is that distance.
TEST_P(ClusterKernelsOf, KeepTheNearestPair) {
  for (const ClusterCase& c : cluster_cases()) {
    SCOPED_TRACE(c.name);
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t f = 0; f < c.fixed.triangles.size() && least > 0; ++f) {
      for (std::uint32_t m = 0; m < c.moving.triangles.size() && least > 0; ++m) {
        const auto a = corners_of(c.fixed, f), b = corners_of(c.moving, m);
        if (box_distance_squared(a, b) > least) continue;
        least = triangles_meet(a, b) ? 0 : std::min(least, ist::distance_squared(a, b));
      }
    }
    if (least == 0) continue;
    const auto from = static_cast<float>(1.3 * std::sqrt(least));
    const float margin = 1e-6F * from + c.step.pose.error;
    Room room;
    Reach reach{from + margin, margin};
    double found = std::numeric_limits<double>::infinity();
    std::size_t kept = 0;
    each_block(kernels_, c, from + margin, [&](const ClusterPairs& clusters) {
      for (std::size_t done = 0; done < clusters.pairs.count;) {
        done += kernels_.near_clusters(
            c.step,
            {clusters.lanes, clusters.moving, clusters.pairs.part(done, clusters.pairs.count)},
            reach, room.batch, room.found);
        for (std::size_t k = 0; k < room.found.open.count; ++k) {
          const TriangleIds ids = room.found.open[k];
          const double squared = ist::distance_squared(corners_of(c.fixed, ids.fixed),
                                                       corners_of(c.moving, ids.moving));
          const double slack = 1e-6 * std::sqrt(least) + double{c.step.pose.error};
          ASSERT_LE(std::sqrt(double{room.found.squares[k]}), std::sqrt(squared) + slack);
          found = std::min(found, squared);
          ++kept;
        }
        room.found.open.count = 0;
      }
    });
    EXPECT_EQ(found, least);
    EXPECT_GE(double{reach.triangles} * reach.triangles, least);
    EXPECT_LT(kept, c.fixed.triangles.size() + c.moving.triangles.size());
  }
}

}  // namespace
}  // namespace ist::test
