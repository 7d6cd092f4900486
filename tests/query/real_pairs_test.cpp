#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "ist/mesh/mesh.h"
#include "ist/query/query.h"
#include "ist/query/reference/reference_query.h"
#include "ist/tree/sphere_tree.h"
#include "query/query_cases.h"
#include "query/triangles/meeting_pairs.h"
#include "support/data_dir.h"
#include "support/effort.h"

namespace ist::test {
namespace {

struct RealPair {
  const char *name, *fixed, *moving;
  double voxel_size;
};

// Two scans at twelve poses, and what is true there.
class RealPairs : public ::testing::TestWithParam<RealPair> {
 protected:
  void SetUp() override {
    const auto file = data_dir() / (std::string("truth_") + GetParam().name + ".json");
    if (!std::filesystem::exists(file)) IST_SKIP(file << " is not there");
    truth_ = nlohmann::json::parse(std::ifstream(file));
    ASSERT_EQ(truth_.size(), 12u);
  }
  static SphereTree tree(const char* file, BuildOptions options) {
    options.voxel_size = GetParam().voxel_size;
    return build_tree(read_mesh(data_dir() / file), options);
  }
  static Eigen::Isometry3d pose_of(const nlohmann::json& item) {
    const auto numbers = item["pose"].get<std::vector<double>>();
    Eigen::Isometry3d pose;
    std::copy(numbers.begin(), numbers.end(), pose.matrix().data());
    return pose;
  }

  nlohmann::json truth_;
};

INSTANTIATE_TEST_SUITE_P(
    Pairs, RealPairs,
    ::testing::Values(RealPair{"human", "human_maxilla.stl", "human_mandible.stl", 0.4},
                      RealPair{"spl", "spl_cranium_face.stl", "spl_mandible.stl", 0.5}),
    [](const auto& pair) { return std::string(pair.param.name); });

// Contacts wherever triangles meet, none where the surfaces are farther apart than the resolution.
TEST_P(RealPairs, AgreeWithExactTriangles) {
  BuildOptions options;
  options.spheres = SpherePolicy::kSlab;
  const SphereTree fixed = tree(GetParam().fixed, options);
  const SphereTree moving = tree(GetParam().moving, options);
  std::vector<LeafPair> leaf_pairs(1 << 18);
  for (const SpherePolicy policy : kSpherePolicies) {
    ReferenceQuery query(fixed, moving, policy);
    int free = 0;
    for (const nlohmann::json& item : truth_) {
      SCOPED_TRACE(std::string(to_string(policy)) + ", " + item["label"].get<std::string>());
      const Eigen::Isometry3d pose = pose_of(item);
      const QueryResult result = query.leaf_pairs(pose, leaf_pairs);
      EXPECT_EQ(result.status, QueryStatus::kDone);
      EXPECT_FALSE(result.truncated);
      EXPECT_TRUE(result.leaf_pairs > 0 || item["triangle_pairs"] == 0);
      EXPECT_TRUE(result.leaf_pairs == 0 || item["distance"] <= result.resolution);
      free += result.leaf_pairs == 0;
    }
    EXPECT_GE(free, 1);
  }
}

// To the last pair of triangles, each decided in rational numbers, and the distance to within what
// the truth is rounded to.
TEST_P(RealPairs, HaveTheTrianglesThatMeet) {
  IST_SLOW();
  BuildOptions options;
  options.keep_triangles = true;
  const SphereTree fixed = tree(GetParam().fixed, options);
  const SphereTree moving = tree(GetParam().moving, options);
  Query query(fixed, moving);
  std::vector<TrianglePair> pairs(1 << 14);
  for (const nlohmann::json& item : truth_) {
    SCOPED_TRACE(item["label"].get<std::string>());
    const Eigen::Isometry3d pose = pose_of(item);
    const TrianglePairsResult result = query.triangle_pairs(pose, pairs);
    ASSERT_LE(result.triangle_pairs, pairs.size());
    EXPECT_EQ(result.triangle_pairs, item["triangle_pairs"]);
    if (result.triangle_pairs > 0) {  // of none the count tells all
      EXPECT_TRUE(std::ranges::equal(std::span(pairs).first(result.triangle_pairs),
                                     meeting_pairs(fixed, moving, pose)));
    }
    EXPECT_EQ(query.intersects(pose).answer,
              result.triangle_pairs > 0 ? ist::Answer::kYes : ist::Answer::kNo);
    const DistanceInterval gap = query.distance(pose, 1e-3).distance;
    EXPECT_LE(gap.lower, item["distance"].get<double>() + 1e-5);
    EXPECT_GE(gap.upper, item["distance"].get<double>() - 1e-5);
    EXPECT_LE(gap.upper - gap.lower, 1e-3 + 1e-5);
  }
}

}  // namespace
}  // namespace ist::test
