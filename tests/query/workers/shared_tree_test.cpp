#include <gtest/gtest.h>

#include <atomic>
#include <barrier>
#include <thread>
#include <vector>

#include "query/scenes.h"
#include "query/triangles/triangle_tree.h"
#include "support/effort.h"
#include "support/shapes.h"
#include "support/stability.h"

namespace ist::test {
namespace {

using Eigen::Isometry3d;

// All that a query can be asked at one pose.
struct Everything {
  FoundPairs leaf_pairs;
  DistanceInterval gap;
  std::vector<TrianglePair> triangles;
  double weight, spring;

  [[nodiscard]] bool operator==(const Everything& other) const {
    return same(leaf_pairs, other.leaf_pairs) && gap.lower == other.gap.lower &&
           gap.upper == other.gap.upper && triangles == other.triangles && weight == other.weight &&
           spring == other.spring;
  }
};

class Asker {
 public:
  Asker(const SphereTree& tree, int workers)
      : query_(tree, tree, options_of(SpherePolicy::kSlab, "", workers)),
        points_(tree, tree, SpherePolicy::kSlab),
        triangles_(1 << 14) {}

  [[nodiscard]] Everything at(const Isometry3d& pose) {
    Everything all{ask(query_, pose), query_.distance(pose, 0.01).distance, {}, 0, 0};
    const TrianglePairsResult exact = query_.triangle_pairs(pose, triangles_);
    all.triangles.assign(triangles_.begin(),
                         triangles_.begin() + static_cast<std::ptrdiff_t>(exact.triangle_pairs));
    static_cast<void>(query_.contacts(pose, points_));
    all.weight = points_.sums().weight;
    all.spring = points_.sums().spring.force.norm();
    return all;
  }

 private:
  Query query_;
  ContactManifold points_;
  std::vector<TrianglePair> triangles_;
};

// One tree, which both bodies are, and eight queries that begin together: half of them share the
// resident worker too.
TEST(SharedTreeThread, ServesAQueryOnEachThread) {
  constexpr int kThreads = 8;
  const SphereTree tree = triangle_tree(icosphere(3, 1), 16);
  std::vector<Isometry3d> poses;
  for (const double z : {2.2, 1.9, 1.4, 0.3}) poses.push_back(shift({0.1, 0.05, z}));
  std::vector<Everything> expected;
  Asker serial(tree, 1);
  for (const Isometry3d& pose : poses) expected.push_back(serial.at(pose));
  EXPECT_TRUE(expected.front().leaf_pairs.leaf_pairs.empty());
  EXPECT_GT(expected.back().leaf_pairs.leaf_pairs.size(), 1000u);

  const int rounds = samples(2);
  std::atomic<int> wrong = 0;
  std::barrier together(kThreads);
  std::vector<std::jthread> threads;
  for (int thread = 0; thread < kThreads; ++thread) {
    threads.emplace_back([&, thread] {
      Asker asker(tree, 1 + thread % 2);
      together.arrive_and_wait();
      for (int i = 0; i < rounds * static_cast<int>(poses.size()); ++i) {
        const std::size_t at = static_cast<std::size_t>(i + thread) % poses.size();
        if (!(asker.at(poses[at]) == expected[at])) ++wrong;
      }
    });
  }
  threads.clear();
  StabilityCase answers("load", "8 threads, 8 queries, one tree", "wrong answers");
  answers.samples_of(static_cast<std::uint64_t>(kThreads * rounds) * poses.size(), wrong, 0);
}

}  // namespace
}  // namespace ist::test
