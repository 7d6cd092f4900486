#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "ist/scene.h"
#include "loop/haptics/bodies/tool_contact_query.h"
#include "query/pair_cache/kept_answers.h"
#include "query/pair_cache/motions.h"
#include "query/test_clocks.h"
#include "simd/targets.h"
#include "support/data_dir.h"
#include "support/effort.h"

namespace ist::test {
namespace {

// Whatever a query kept from the poses before, it answers as one that has just been made: bit by
// bit, for leaf pairs in a span or a stream, and contacts.

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

// A recorded hand closes two jaws, slides them and opens them. The cache answers most ticks, and
// each answer equals the answer of a new query.

class RecordedHand : public ::testing::TestWithParam<SpherePolicy> {};

INSTANTIATE_TEST_SUITE_P(Policies, RecordedHand, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

TEST_P(RecordedHand, IsAnsweredAsByAFreshQuery) {
  IST_SLOW();
  ist::Scene file = read_scene(std::string(IST_SCENES) + "/jaws.toml");
  file.workers = 1;
  file.contact.reset();
  file.friction.reset();
  file.springs = SpringsSettings{};
  file.fixed.front().voxel_size = file.held.front().voxel_size = 0.5;
  file.fixed.front().spheres = file.held.front().spheres = GetParam();
  BuiltScene built = build_scene(file);
  const BodyFrames frames{file.unit,
                          {file.fixed.front().rotation, file.unit * file.fixed.front().translation},
                          built.origin};
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < 6000; ++i) {
    poses.push_back(frames.query_pose(built.simulation->tool_pose()));
    const Tick tick = built.simulation->tick(built.device->read(), {});
    built.device->write(tick.wrench, built.simulation->dt());
  }
  const Scene scene{"recorded", *built.trees.front().contact, *built.trees.back().contact,
                    poses.front()};
  Random random(4000);
  for (int round = 0; round < samples(2); ++round) {
    QueryOptions options = options_of(GetParam(), "", 1 + round % 2);
    options.front_pairs = round == 0 ? 1 << 16 : std::size_t{1} << (8 + random.below(10));
    KeptAnswers answers(scene, options);
    for (std::size_t i = 0; i < poses.size() && !HasFailure(); ++i) {
      if (i % 100 == 0) answers.choose(random);
      SCOPED_TRACE("round " + std::to_string(round) + ", tick " + std::to_string(i));
      answers.check(poses[i], random);
    }
    if (round > 0) continue;
    const KeptCounts& counts = answers.counts();
    EXPECT_GT(counts.kept, counts.ticks / 4);
    EXPECT_GT(counts.clear, counts.ticks / 100);
    EXPECT_LT(counts.fresh, counts.ticks / 20);
    EXPECT_GT(counts.pairs, 30 * counts.ticks);
  }
}

// A query with a cache and a budget. If the clock ends the query, the answer is incomplete and
// holds a part of the pairs. If a number of tests ends it, the answer and its tests equal a fresh
// query's.

// A query that keeps a cache, whose clock is late at a look of the test's choice, and a fresh one.
class KeptWithinADeadline {
 public:
  explicit KeptWithinADeadline(const Scene& scene, const QueryOptions& options)
      : kept_(scene.fixed, scene.moving, with_cache(options)),
        fresh_(scene.fixed, scene.moving, options),
        points_(scene.fixed, scene.moving, *options.policy),
        others_(scene.fixed, scene.moving, *options.policy) {}

  // Returns whether the answer is complete.
  bool list(const Eigen::Isometry3d& pose, const Budget& budget = {}) {
    const FoundPairs wanted = ask(fresh_, pose);
    std::vector<LeafPair> out(wanted.leaf_pairs.size());
    const QueryResult made = kept_.leaf_pairs(pose, out, budget);
    count(made);
    const auto found =
        static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(made.leaf_pairs, out.size()));
    EXPECT_TRUE(std::equal(out.begin(), out.begin() + found, wanted.leaf_pairs.begin()));
    if (made.complete) {
      expect_same_answer(made, wanted.result);
    } else {
      EXPECT_LE(made.leaf_pairs, wanted.leaf_pairs.size());
      EXPECT_GT(made.level, 0);
    }
    return made.complete;
  }
  bool touch(const Eigen::Isometry3d& pose, const Budget& budget = {}) {
    const FoundContacts wanted = find_contacts(fresh_, others_, pose);
    const QueryResult made = kept_.contacts(pose, points_, budget);
    count(made);
    if (made.complete) {
      expect_same_answer(made, wanted.result);
      EXPECT_TRUE(
          same({points_.sums(), {points_.points().begin(), points_.points().end()}, made}, wanted));
    } else {
      EXPECT_TRUE(points_.points().empty());
      EXPECT_GT(made.level, 0);
      EXPECT_LE(made.leaf_pairs, wanted.result.leaf_pairs);
    }
    return made.complete;
  }

  int cut = 0, kept_answers = 0, cut_answers_kept = 0;

 private:
  static QueryOptions with_cache(QueryOptions options) {
    options.front_pairs = 1 << 15;
    return options;
  }
  void count(const QueryResult& result) {
    EXPECT_EQ(result.status, QueryStatus::kDone);
    cut += result.complete ? 0 : 1;
    kept_answers += result.complete && result.found == Found::kKept ? 1 : 0;
    cut_answers_kept += !result.complete && result.found == Found::kKept ? 1 : 0;
  }

  Query kept_, fresh_;
  ContactManifold points_, others_;
};

class CoherentDeadline : public ::testing::TestWithParam<SpherePolicy> {};

INSTANTIATE_TEST_SUITE_P(Policies, CoherentDeadline,
                         ::testing::Values(SpherePolicy::kTable, SpherePolicy::kSlab),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

// From many poses on, at each look at the clock.
TEST_P(CoherentDeadline, ThatPassesAtAnyLookGivesAllOrAPart) {
  const ScopedBudgetClock clock(LateClock::now);
  const Scene& scene = shells();
  const double voxel = scene.fixed.voxel_size();
  int cut = 0, cut_kept = 0, all = 0;
  // Steps after which the cache is kept, made at once, and left behind.
  for (const double step : {0.002, 0.012, 0.05, 0.8}) {
    for (const bool lists : {true, false}) {
      KeptWithinADeadline query(scene, options_of(GetParam()));
      Eigen::Isometry3d pose = scene.pose;
      pose.translation()[0] += 12 * voxel;
      int way = 1;
      const auto go = [&](double voxels) {
        if (std::abs(pose.translation()[0] / voxel - 12) > 6)
          way = pose.translation()[0] > 12 * voxel ? -1 : 1;
        pose.translation()[0] += way * voxels * voxel;
      };
      const auto tick = [&](const Budget& budget) {
        return lists ? query.list(pose, budget) : query.touch(pose, budget);
      };
      bool late = true;
      for (int looks = 0; late && looks < 400; ++looks) {
        SCOPED_TRACE(std::to_string(step) + " voxels, look " + std::to_string(looks));
        for (int i = 0; i < 4; ++i) {
          go(0.004);
          ASSERT_TRUE(tick({}));
        }
        go(step);
        const bool complete = tick(LateClock::budget_of(looks));
        late = LateClock::looks > looks;
        ASSERT_TRUE(late || complete);
        ASSERT_TRUE(tick({}));  // the same pose, with time enough
        if (HasFailure()) return;
        ++all;
      }
      EXPECT_FALSE(late);
      cut += query.cut;
      cut_kept += query.cut_answers_kept;
    }
  }
  EXPECT_GT(cut, 60);
  // A cache of one part is never cut, and slabs keep few pairs.
  if (GetParam() == SpherePolicy::kTable) {
    EXPECT_GT(cut_kept, 5);
  }
  EXPECT_GT(all, 80);
}

TEST_P(CoherentDeadline, OnEveryTickGivesAllOrAPart) {
  const ScopedBudgetClock clock(LateClock::now);
  int cut = 0, kept = 0;
  for (int run = 0; run < samples(30); ++run) {
    Random random(static_cast<std::uint64_t>(run));
    const Scene& scene = run % 4 == 3 ? shells() : solids()[random.below(3)];
    KeptWithinADeadline query(scene, options_of(GetParam()));
    Motion motion(scene, random.below(1000));
    if (run % 3 > 0) motion.limit_step(0.05);
    for (int i = 0; i < 60; ++i) {
      SCOPED_TRACE("run " + std::to_string(run) + ", tick " + std::to_string(i));
      const Eigen::Isometry3d pose = motion.next();
      const Budget budget = random.below(3) == 0
                                ? Budget{}
                                : LateClock::budget_of(static_cast<int>(random.below(60)));
      random.below(2) == 0 ? query.list(pose, budget) : query.touch(pose, budget);
      if (HasFailure()) return;
    }
    cut += query.cut;
    kept += query.kept_answers;
  }
  EXPECT_GT(cut, least(50, 2));
  EXPECT_GT(kept, least(100, 4));
}

// A limit of tests makes every query a search of its own: the same tests, the same distance.
TEST_P(CoherentDeadline, OfTestsIsThatOfAFreshQuery) {
  int ended = 0, whole = 0, kept = 0;
  for (int run = 0; run < samples(20); ++run) {
    Random random(static_cast<std::uint64_t>(run));
    const Scene& scene = solids()[random.below(3)];
    QueryOptions options = options_of(GetParam(), "", 1 + run % 2);
    Query fresh(scene.fixed, scene.moving, options);
    options.front_pairs = 1 << 15;
    Query query(scene.fixed, scene.moving, options);
    ContactManifold points(scene.fixed, scene.moving, GetParam(), {.margin = 2}),
        others(scene.fixed, scene.moving, GetParam(), {.margin = 2});
    Motion motion(scene, random.below(1000));
    motion.limit_step(0.05);
    for (int i = 0; i < 60 && !HasFailure(); ++i) {
      SCOPED_TRACE("run " + std::to_string(run) + ", tick " + std::to_string(i));
      const Eigen::Isometry3d pose = motion.next();
      if (random.below(3) > 0) {
        const QueryResult result = query.contacts(pose, points);
        // How often a second worker is in time depends on the machine.
        kept += run % 2 == 0 && result.found == Found::kKept ? 1 : 0;
        expect_same_answer(result, fresh.contacts(pose, others));
        EXPECT_TRUE(same(points.sums(), others.sums()));
        continue;
      }
      const Budget budget{.tests = std::uint64_t{1} << random.below(18)};
      QueryResult made, wanted;
      if (random.below(2) == 0) {
        std::vector<LeafPair> pairs(1 << 16), wanted_pairs(1 << 16);
        made = query.leaf_pairs(pose, pairs, budget);
        wanted = fresh.leaf_pairs(pose, wanted_pairs, budget);
        EXPECT_TRUE(std::equal(pairs.begin(),
                               pairs.begin() + static_cast<std::ptrdiff_t>(made.leaf_pairs),
                               wanted_pairs.begin()));
      } else {
        made = query.contacts(pose, points, budget);
        wanted = fresh.contacts(pose, others, budget);
        EXPECT_TRUE(same(points.sums(), others.sums()));
        EXPECT_EQ(points.points().size(), others.points().size());
      }
      expect_same_answer(made, wanted);
      EXPECT_EQ(made.sphere_tests, wanted.sphere_tests);
      EXPECT_EQ(made.found, wanted.found);
      EXPECT_EQ(made.distance->lower, wanted.distance->lower);
      EXPECT_EQ(made.distance->upper, wanted.distance->upper);
      ++(made.complete ? whole : ended);
    }
  }
  EXPECT_GT(ended, least(30, 4));
  EXPECT_GT(whole, least(30, 4));
  EXPECT_GT(kept, least(100, 5));
}

}  // namespace
}  // namespace ist::test
