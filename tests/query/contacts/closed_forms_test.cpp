#include "query/contacts/closed_forms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ist/tree/tree_builder.h"
#include "query/contacts/contact_cases.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

constexpr double kVoxel = 0.3;  // mm
constexpr double kDegrees = 57.29577951308232;

SphereTree tree_of_solid(const Solid& solid, double voxel_size) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  return build_tree(solid.mesh(voxel_size), options);
}

// Of contact points, the depth in voxels, the normal in degrees.
struct Errors {
  std::size_t points = 0, smooth = 0;
  double depth = 0, depths = 0;    // the largest, and the sum of all
  double normal = 0, normals = 0;  // likewise
  double deepest = -2;

  void add(const Errors& other) {
    points += other.points;
    smooth += other.smooth;
    depth = std::max(depth, other.depth);
    depths += other.depths;
    normal = std::max(normal, other.normal);
    normals += other.normals;
  }
  [[nodiscard]] double mean_depth() const { return depths / static_cast<double>(smooth); }
  [[nodiscard]] double mean_normal() const { return normals / static_cast<double>(smooth); }
};

// What is true is what both surfaces are at the point, where they are smooth there; a depth is
// defined from -2s to s.
Errors errors_of(const ClosedForm& form, const SphereTree& fixed, const SphereTree& moving,
                 SpherePolicy policy, double depth, std::size_t most = 1 << 14) {
  const double s = fixed.lattice().voxel_size;
  const Eigen::Isometry3d pose = form.pose(depth * s);
  Errors errors;
  for (const ContactPoint& p : touched(fixed, moving, policy, pose, most).points) {
    ++errors.points;
    EXPECT_TRUE(p.position.allFinite() && p.normal.allFinite());
    EXPECT_TRUE(std::isfinite(p.depth) && std::isfinite(p.weight));
    errors.deepest = std::max(errors.deepest, p.depth / s);
    if (!form.fixed.smooth(p.position, 10 * s) ||
        !form.moving.smooth(pose.inverse() * p.position, 10 * s)) {
      continue;
    }
    const double truth = std::clamp(form.depth(pose, p.position), -2 * s, s);
    const double off = std::abs(p.depth - truth) / s;
    const double cosine = p.normal.dot(form.normal(pose, p.position));
    const double tilt = kDegrees * std::acos(std::min(1.0, cosine));
    errors.add({1, 1, off, off, tilt, tilt, 0});
    --errors.points;
  }
  return errors;
}

class ClosedForms : public ::testing::TestWithParam<std::size_t> {
 protected:
  const ClosedForm& form_ = closed_forms()[GetParam()];
  bool is_smooth_ = form_.name != "edge_on_box";
};

INSTANTIATE_TEST_SUITE_P(All, ClosedForms, ::testing::Range<std::size_t>(0, closed_forms().size()),
                         [](const auto& form) { return closed_forms()[form.param].name; });

// For overlaps up to a voxel, and for gaps.
TEST_P(ClosedForms, AreMetWithinAVoxelAndAHalfAndTenDegrees) {
  for (const double s : {kVoxel, kVoxel / 2}) {
    const SphereTree fixed = tree_of_solid(form_.fixed, s), moving = tree_of_solid(form_.moving, s);
    for (const SpherePolicy policy : kSpherePolicies) {
      for (const double depth : {-1.0, -0.5, 0.0, 0.25, 0.5, 0.75, 1.0}) {
        SCOPED_TRACE(::testing::Message() << to_string(policy) << ", " << s << " mm, " << depth);
        const Errors errors = errors_of(form_, fixed, moving, policy, depth);
        EXPECT_LE(errors.depth, is_implicit(policy) ? 1.5 : 0.25);
        EXPECT_LE(errors.normal, 10);
        // Tight roots may touch where surfaces do, and not before.
        if (depth > 0) {
          EXPECT_GT(errors.points, 0u);
          EXPECT_TRUE(!is_smooth_ || depth > 0.5 || errors.smooth > 0);
        }
        if (errors.points == 0) continue;
        if (depth >= 0) {
          EXPECT_NEAR(errors.deepest, depth, 1.5);
        }
        const Errors joined = errors_of(form_, fixed, moving, policy, depth, 64);
        EXPECT_LE(joined.points, 64u);
        EXPECT_LE(joined.depth, 1.5);
        EXPECT_NEAR(joined.deepest, errors.deepest, 1e-9);
        if (joined.smooth == joined.points) {  // else edges are joined to faces
          EXPECT_LE(joined.normal, 10);
        }
      }
    }
  }
}

// With voxels and triangles of half the size, errors are about half as large: a depth's is a part
// of a voxel that stays, a normal's halves, down to what a packed one is rounded to.
TEST_P(ClosedForms, AreMetTwiceAsWellWithVoxelsOfHalfTheSize) {
  constexpr double kRounded = 0.06;  // degrees
  const SphereTree fixed[] = {tree_of_solid(form_.fixed, kVoxel),
                              tree_of_solid(form_.fixed, kVoxel / 2)};
  const SphereTree moving[] = {tree_of_solid(form_.moving, kVoxel),
                               tree_of_solid(form_.moving, kVoxel / 2)};
  for (const SpherePolicy policy : {SpherePolicy::kTable, SpherePolicy::kSlab}) {
    SCOPED_TRACE(to_string(policy));
    Errors errors[2];
    for (const std::size_t i : {0u, 1u}) {
      for (const double depth : {-0.5, 0.0, 0.25, 0.5, 0.75}) {
        errors[i].add(errors_of(form_, fixed[i], moving[i], policy, depth));
      }
    }
    if (!is_smooth_) continue;
    ASSERT_GT(errors[0].smooth, 50u);
    const double floor = 0.002;  // voxels: what a slab's offset is rounded to
    EXPECT_LE(errors[1].mean_depth(), 1.25 * errors[0].mean_depth() + floor);
    EXPECT_LE(errors[1].mean_normal(), 0.65 * errors[0].mean_normal() + kRounded);
    EXPECT_LE(errors[1].normal, 0.75 * errors[0].normal + kRounded);
  }
}

}  // namespace
}  // namespace ist::test
