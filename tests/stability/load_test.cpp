#include <gtest/gtest.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ist/mesh/mesh.h"
#include "ist/query/query.h"
#include "query/query_cases.h"
#include "query/quiet/allocations.h"
#include "query/triangles/triangle_tree.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/stability.h"

namespace ist::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

struct LoadPair {
  const char *name, *fixed, *moving;
  Vector3d centre;  // mm; of the turns, amid the moving body
  // The answers' hash, by queries. Instruction sets, workers and builds make no difference.
  std::array<std::pair<int, std::uint64_t>, 2> golden;
};

constexpr int kFew = 5'000, kThousandTimes = 1'000 * kFew;

void PrintTo(const LoadPair& pair, std::ostream* out) { *out << pair.name; }

class Load : public ::testing::TestWithParam<LoadPair> {};

INSTANTIATE_TEST_SUITE_P(Pairs, Load,
                         ::testing::Values(LoadPair{"human",
                                                    "human_maxilla.stl",
                                                    "human_mandible.stl",
                                                    {0, -5, 45},
                                                    {{{kFew, 0xb2e4638c82992e8d},
                                                      {kThousandTimes, 0x7ade9aa1065b5707}}}},
                                           LoadPair{"spl",
                                                    "spl_cranium_face.stl",
                                                    "spl_mandible.stl",
                                                    {4, -22, -10},
                                                    {{{kFew, 0x5bed00682bbbeb6b},
                                                      {kThousandTimes, 0x003b2e396c1bae70}}}}),
                         [](const auto& pair) { return std::string(pair.param.name); });

// Mostly near where the jaws close, some anywhere, a few that are no rigid motion.
Isometry3d random_pose(Random& random, const Vector3d& centre) {
  const std::size_t kind = random.below(100);
  if (kind < 2) {
    Isometry3d bad = shift(random.point(-1, 1));
    bad.matrix()(static_cast<int>(random.below(4)), static_cast<int>(random.below(4))) =
        kind == 0 ? std::numeric_limits<double>::quiet_NaN() : 1e30;
    return bad;
  }
  const auto about = [&centre](const Eigen::Matrix3d& turn, const Vector3d& move) {
    return pose_of(turn, centre - turn * centre + move);
  };
  if (kind < 12) return about(random.rotation(), random.point(-150, 150));
  // A turn by some degrees: that of the quaternion (1, v), by arithmetic alone.
  const Vector3d v = random.point(-0.02, 0.02);
  const Eigen::Quaterniond q(1, v[0], v[1], v[2]);
  const double scale = 1 / std::sqrt(1 + v.squaredNorm());
  const Eigen::Quaterniond unit(q.w() * scale, q.x() * scale, q.y() * scale, q.z() * scale);
  return about(unit.toRotationMatrix(), random.point(-3, 3));
}

// Millions of answers, none of which allocates, is no number, or is other than it was last time.
TEST_P(Load, GivesTheSameAnswersAsLastTime) {
  const LoadPair& pair = GetParam();
  const auto path = [](const char* file) { return data_dir() / file; };
  if (!std::filesystem::exists(path(pair.fixed))) IST_SKIP(path(pair.fixed) << " is not there");
  const SphereTree fixed = tree_with_triangles(read_mesh(path(pair.fixed)), 0.8),
                   moving = tree_with_triangles(read_mesh(path(pair.moving)), 0.8);
  Query query(fixed, moving);
  ContactManifold points(fixed, moving, query.policy(), {.margin = 2});
  std::vector<LeafPair> leaf_pairs(1 << 17);
  std::vector<TrianglePair> triangles(1 << 14);
  Random random(7, 32);  // as the golden numbers were made
  std::uint64_t hash = 0, wrong = 0;
  const auto take = [&hash](const void* data, std::size_t bytes) {
    hash = XXH3_64bits_withSeed(data, bytes, hash);
  };
  const auto take_number = [&take](double number) { take(&number, sizeof(number)); };
  // What is asked besides contacts costs more, and is asked of some poses.
  const auto ask_for_gap = [&](const Isometry3d& pose) {
    const DistanceResult result = query.distance(pose, 0.1);
    const auto [lower, upper] = result.distance;
    wrong += result.status == QueryStatus::kDone &&
             !(0 <= lower && lower <= upper && std::isfinite(upper));
    take_number(lower), take_number(upper);
  };
  const auto ask_for_points = [&](const Isometry3d& pose) {
    static_cast<void>(query.contacts(pose, points));
    for (const Contact& point : points.points()) {
      const double sum = point.depth + point.weight;
      wrong += !(std::isfinite(sum) && point.weight >= 0);
      take_number(point.depth), take_number(point.weight);
    }
    const ContactSums& sums = points.sums();
    wrong += !std::isfinite(sums.weight + sums.spring.force.sum() + sums.spring.torque.sum());
    take_number(sums.weight), take_number(sums.spring.force[2]);
  };
  const auto ask_for_triangles = [&](const Isometry3d& pose) {
    const TrianglePairsResult result = query.triangle_pairs(pose, triangles);
    take(triangles.data(),
         std::min<std::size_t>(result.triangle_pairs, triangles.size()) * sizeof(TrianglePair));
  };

  StabilityCase allocated("load", std::string(pair.name) + ", memory asked for", "allocations");
  StabilityCase numbers("load", std::string(pair.name) + ", answers that are no numbers",
                        "answers");
  StabilityCase same("load", std::string(pair.name) + ", same bytes as last time", "hashes");
  const int count = std::max(kFew, samples(kFew));  // with fewer no hash is known
  const std::uint64_t allocations_before = allocations();
  std::array<std::uint64_t, 2> reached{};
  std::uint64_t touching = 0;
  for (int i = 1; i <= count; ++i) {
    const Isometry3d pose = random_pose(random, pair.centre);
    const QueryResult result = query.leaf_pairs(pose, leaf_pairs);
    wrong += result.truncated || !(result.pad >= 0);
    touching += result.leaf_pairs > 0;
    const std::array<std::uint64_t, 3> found = {static_cast<std::uint64_t>(result.status),
                                                result.leaf_pairs, result.sphere_tests};
    take(found.data(), sizeof(found));
    take(leaf_pairs.data(), result.leaf_pairs * sizeof(LeafPair));
    if (i % 500 == 0) ask_for_gap(pose);
    if (i % 500 == 150) ask_for_points(pose);
    if (i % 500 == 300) ask_for_triangles(pose);
    for (std::size_t k = 0; k < pair.golden.size(); ++k) {
      if (i == pair.golden[k].first) reached[k] = hash;
    }
  }
  const std::uint64_t allocations_after = allocations();
  for (std::size_t k = 0; k < pair.golden.size(); ++k) {
    const auto [queries, golden] = pair.golden[k];
    if (count < queries) continue;
    same.samples_of(static_cast<std::uint64_t>(queries), reached[k] == golden ? 0 : 1, 0);
    EXPECT_EQ(reached[k], golden) << "after " << queries << std::hex << ": 0x" << reached[k];
  }
  const auto tried = static_cast<std::uint64_t>(count);
  allocated.samples_of(tried, static_cast<double>(allocations_after - allocations_before), 0);
  numbers.samples_of(tried, static_cast<double>(wrong), 0);
  EXPECT_GT(touching, tried / 3);
  EXPECT_LT(touching, tried);
}

}  // namespace
}  // namespace ist::test
