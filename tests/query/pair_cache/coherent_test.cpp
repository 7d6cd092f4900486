// Whatever a query kept from the poses before, it answers as one that has just been made: bit by
// bit, for leaf pairs in a span or a stream, and contacts.

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "query/pair_cache/kept_answers.h"
#include "query/pair_cache/motions.h"
#include "simd/targets.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/skip.h"

namespace ist::test {
namespace {

constexpr int kTicksOfARun = 90;

// One of each, drawn.
template <class T, std::size_t N>
T drawn(Random& random, const T (&of)[N]) {
  return of[random.below(N)];
}

// `runs` runs, each with its own options and motions.
KeptCounts run(const std::vector<const Scene*>& scenes, SpherePolicy policy, int runs,
               std::uint64_t seed) {
  KeptCounts counts;
  const std::vector<std::string> targets = all_targets();
  for (int k = 0; k < runs && !::testing::Test::HasFailure(); ++k) {
    Random random(seed + static_cast<std::uint64_t>(k));
    const Scene& scene = *scenes[random.below(scenes.size())];
    // Half of them as they are used, the others with anything.
    QueryOptions options = options_of(policy);
    options.front_pairs = 1 << 15;
    if (k % 2 == 1) {
      constexpr std::size_t kCaches[] = {1, 100, 600, 2000, 10'000, 1 << 15, 1 << 17};
      constexpr std::size_t kFrontiers[] = {1, 64, 2000, 1 << 14, 1 << 16};
      options.front_pairs = drawn(random, kCaches);
      options.frontier_pairs = drawn(random, kFrontiers);
      options.target = targets[random.below(targets.size())];
    }
    if (k % 4 >= 2) options.workers = 2;
    SCOPED_TRACE("run " + std::to_string(k) + " of " + scene.name + ", " +
                 std::to_string(options.front_pairs) + " pairs, " +
                 std::to_string(options.workers) + " workers, " + options.target);
    KeptAnswers answers(scene, options);
    Motion motion(scene, random.below(1U << 31));
    if (random.below(3) > 0) motion.limit_step(0.1);
    for (int tick = 0; tick < kTicksOfARun && !::testing::Test::HasFailure(); ++tick) {
      if (tick % 30 == 0 || random.below(20) == 0) answers.choose(random);
      const Eigen::Isometry3d pose = motion.next();
      SCOPED_TRACE("tick " + std::to_string(tick) + ", move " +
                   std::to_string(static_cast<int>(motion.move())));
      answers.check(pose, random);
    }
    // How often a second worker is in time depends on the machine.
    if (options.workers == 1) counts.add(answers.counts());
  }
  std::cout << counts.ticks << " ticks: " << counts.kept << " kept, " << counts.clear << " clear, "
            << counts.fresh << " fresh, " << counts.pairs << " pairs\n";
  return counts;
}

class CoherentQuery : public ::testing::TestWithParam<SpherePolicy> {};

INSTANTIATE_TEST_SUITE_P(Policies, CoherentQuery, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

void expect_all_sorts(const KeptCounts& counts) {
  EXPECT_GT(counts.kept, counts.ticks / least(20u, 40u));
  EXPECT_GT(counts.clear, counts.ticks / least(50u, 200u));
  EXPECT_GT(counts.fresh, counts.ticks / least(20u, 40u));
  EXPECT_GT(counts.pairs, least(30u, 3u) * counts.ticks);
}

TEST_P(CoherentQuery, OfSolidsAnswersAsAFreshOne) {
  std::vector<const Scene*> scenes{&shells()};
  for (const Scene& scene : solids()) scenes.push_back(&scene);
  expect_all_sorts(run(scenes, GetParam(), samples(200), 1000));
}

TEST_P(CoherentQuery, OfJawsAnswersAsAFreshOne) {
  expect_all_sorts(run({&jaws()}, GetParam(), samples(60), 2000));
}

// Bodies that were scanned, with voxels as they are used.
TEST(CoherentQueryOfScans, AnswersAsAFreshOne) {
  IST_SLOW();
  const auto file = data_dir() / "human_maxilla.stl";
  if (!std::filesystem::exists(file)) IST_SKIP(file << " is not there");
  BuildOptions build;
  build.voxel_size = 0.4;
  build.spheres = SpherePolicy::kSlab;
  const Scene scene{"human", build_tree(read_mesh(file), build),
                    build_tree(read_mesh(data_dir() / "human_mandible.stl"), build),
                    Eigen::Isometry3d::Identity()};
  const KeptCounts counts = run({&scene}, SpherePolicy::kSlab, samples(40), 3000);
  EXPECT_GT(counts.kept, counts.ticks / least(20u, 100u));
  EXPECT_GT(counts.pairs, 0u);
}

}  // namespace
}  // namespace ist::test
