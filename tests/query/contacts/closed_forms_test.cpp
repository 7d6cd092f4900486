#include <gtest/gtest.h>

#include "ist/tree/implicit_ball.h"
#include "query/contacts/form_errors.h"

namespace ist::test {
namespace {

constexpr double kVoxel = 0.3;  // mm

class ClosedForms : public ::testing::TestWithParam<std::size_t> {
 protected:
  const ClosedForm& form_ = closed_forms()[GetParam()];
  bool is_smooth_ = form_.name != "edge_on_box";
};

INSTANTIATE_TEST_SUITE_P(All, ClosedForms, ::testing::Range<std::size_t>(0, closed_forms().size()),
                         [](const auto& form) { return closed_forms()[form.param].name; });

// For overlaps up to a voxel, and for gaps.
TEST_P(ClosedForms, AreMetWithinAFewVoxelsAndDegrees) {
  for (const double s : {kVoxel, kVoxel / 2}) {
    const SphereTree fixed = tree_of_solid(form_.fixed, s), moving = tree_of_solid(form_.moving, s);
    for (const SpherePolicy policy : kSpherePolicies) {
      for (const double depth : {-1.0, -0.5, 0.0, 0.25, 0.5, 0.75, 1.0}) {
        SCOPED_TRACE(::testing::Message() << to_string(policy) << ", " << s << " mm, " << depth);
        const FormErrors errors = form_errors(form_, fixed, moving, policy, depth);
        EXPECT_TRUE(errors.finite);
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
        const FormErrors joined = form_errors(form_, fixed, moving, policy, depth, 64);
        EXPECT_TRUE(joined.finite);
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
    FormErrors errors[2];
    for (const std::size_t i : {0u, 1u}) {
      for (const double depth : {-0.5, 0.0, 0.25, 0.5, 0.75}) {
        errors[i].add(form_errors(form_, fixed[i], moving[i], policy, depth));
      }
    }
    if (!is_smooth_) continue;
    EXPECT_TRUE(errors[0].finite && errors[1].finite);
    ASSERT_GT(errors[0].smooth, 50u);
    const double floor = 0.002;  // voxels: what a slab's offset is rounded to
    EXPECT_LE(errors[1].mean_depth(), 1.25 * errors[0].mean_depth() + floor);
    EXPECT_LE(errors[1].mean_normal(), 0.65 * errors[0].mean_normal() + kRounded);
    EXPECT_LE(errors[1].normal, 0.75 * errors[0].normal + kRounded);
  }
}

}  // namespace
}  // namespace ist::test
