// The rounding of the caller, and what becomes of its denormal numbers, change no answer on any
// platform that lets a program choose them: MXCSR of x86-64, FPCR of ARM64.

#include <gtest/gtest.h>

#include <cfenv>
#include <string>
#include <string_view>
#include <vector>

#include "golden/hasher.h"
#include "golden/host_arithmetic.h"
#include "ist/ist.h"
#include "query/scenes.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// A body with denormal coordinates; with so small a unit squares of lengths are nearly denormal
// floats.
constexpr double kUnit = 0x1p-37;
TriangleMesh small_body(int subdivisions) {
  TriangleMesh mesh = icosphere(subdivisions, kUnit);
  mesh.vertices[0] += Eigen::Vector3d(1e-310, -3e-320, 0);
  return mesh;
}

// Numbers that are exact in any arithmetic.
std::vector<Eigen::Isometry3d> poses() {
  Eigen::Matrix3d rotation;
  rotation << 1, 0, 0, 0, 0.6, -0.8, 0, 0.8, 0.6;
  std::vector<Eigen::Isometry3d> poses;
  for (const double distance : {1.5, 2.5, 0.0}) {
    poses.push_back(pose_of(rotation, {distance * kUnit, 1e-310, 0.25 * distance * kUnit}));
  }
  return poses;
}

// What the library says in the arithmetic of its caller, which nothing here depends on.
std::uint64_t hash_of_answers(const TriangleMesh& a, const TriangleMesh& b,
                              const std::vector<Eigen::Isometry3d>& at) {
  Hasher hasher;
  const BuildOptions options{.voxel_size = 0.25 * kUnit};
  const SphereTree fixed = build_tree(a, options), moving = build_tree(b, options);
  for (const SphereTree* tree : {&fixed, &moving}) {
    const std::vector<std::byte> bytes = tree_to_bytes(*tree);
    hasher.add(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  }
  Query query(fixed, moving, options_of(SpherePolicy::kSlab));
  ContactManifold manifold(fixed, moving, query.policy(), {.margin = 2});
  for (const Eigen::Isometry3d& pose : at) {
    const FoundPairs found = ask(query, pose);
    hasher.add(found.result.sphere_tests).add(found.result.resolution);
    for (const LeafPair& pair : found.leaf_pairs) hasher.add(pair.fixed).add(pair.moving);
    const DistanceInterval distance = query.distance(pose, 0).distance;
    hasher.add(distance.lower).add(distance.upper);
    hasher.add(static_cast<int>(query.intersects(pose).answer));
    hasher.add(query.contacts(pose, manifold).leaf_pairs);
    hasher.add(manifold.sums().spring.force).add(manifold.sums().spring.torque);
  }
  return hasher.value();
}

TEST(FloatEnvironment, OfTheCallerChangesNothing) {
  const TriangleMesh a = small_body(1), b = small_body(0);
  const std::vector<Eigen::Isometry3d> at = poses();
  const std::uint64_t expected = hash_of_answers(a, b, at);
  constexpr struct {
    int rounding;
    bool flushes;
  } kHosts[] = {
      {FE_TONEAREST, true}, {FE_UPWARD, false}, {FE_DOWNWARD, true}, {FE_TOWARDZERO, true}};
  for (const auto& [rounding, flushes] : kHosts) {
    SCOPED_TRACE("rounding " + std::to_string(rounding) + ", flushes " + std::to_string(flushes));
    std::uint64_t hash = 0;
    bool kept = false;
    {
      const HostArithmetic host(rounding, flushes);
      hash = hash_of_answers(a, b, at);
      kept = host.is_kept();
    }
    EXPECT_EQ(hash, expected);
    EXPECT_TRUE(kept);
  }
}

}  // namespace
}  // namespace ist::test
