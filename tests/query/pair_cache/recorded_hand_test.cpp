// A hand that closes two jaws, slides them and opens them: what a loop asks of it is answered from
// the cache for the most part, and as by a query that has just been made.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ist/haptics/bodies/tool_contact_query.h"
#include "ist/scene.h"
#include "query/pair_cache/kept_answers.h"
#include "support/effort.h"

namespace ist::test {
namespace {

class RecordedHand : public ::testing::TestWithParam<SpherePolicy> {};

INSTANTIATE_TEST_SUITE_P(Policies, RecordedHand, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

TEST_P(RecordedHand, IsAnsweredAsByAFreshQuery) {
  IST_SLOW();
  ist::Scene file = read_scene(std::string(IST_SCENES) + "/jaws.toml");
  file.workers = 1;
  file.fixed.front().spheres = file.held.front().spheres = GetParam();
  BuiltScene built = build_scene(file);
  const BodyFrames frames{file.unit,
                          {file.fixed.front().rotation, file.unit * file.fixed.front().translation},
                          built.trees.back().contact->origin()};
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

}  // namespace
}  // namespace ist::test
