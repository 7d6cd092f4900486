#include "query/contacts/closed_forms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "ist/mesh/mesh.h"
#include "ist/query/contacts/contact_reducer.h"
#include "ist/tree/implicit_ball.h"
#include "ist/tree/sphere_tree.h"
#include "query/contacts/contact_cases.h"
#include "query/scenes.h"
#include "support/data_dir.h"
#include "support/effort.h"

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
        // Tight roots may touch only if the surfaces touch.
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

// With voxels and triangles of half the size, errors are about half as large. The error of a depth
// stays the same in voxels. The error of a normal halves, down to the rounding of a packed normal.
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
    const double floor = 0.002;  // voxels: the rounding of a slab's offset
    EXPECT_LE(errors[1].mean_depth(), 1.25 * errors[0].mean_depth() + floor);
    EXPECT_LE(errors[1].mean_normal(), 0.65 * errors[0].mean_normal() + kRounded);
    EXPECT_LE(errors[1].normal, 0.75 * errors[0].normal + kRounded);
  }
}

using Eigen::Isometry3d;
using Eigen::Vector3d;

// A wrench on the moving body as one on the fixed body, in the moving body's coordinates about
// `about`, from about `before`.
Wrench mirrored(const Wrench& wrench, const Isometry3d& pose, const Vector3d& before,
                const Vector3d& about) {
  const Wrench moved = wrench.about(pose * about - before);
  const Eigen::Matrix3d back = pose.linear().transpose();
  return {-(back * moved.force), -(back * moved.torque)};
}

void expect_near(const Wrench& a, const Wrench& b, double part, double lever) {
  EXPECT_LE((a.force - b.force).norm(), part * b.force.norm());
  EXPECT_LE((a.torque - b.torque).norm(), part * (b.torque.norm() + lever * b.force.norm()));
}

// A query with swapped bodies finds the swapped leaf pairs, except for a few in the pad. Its
// wrenches are opposite.
void expect_mirrored(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                     const Isometry3d& pose) {
  QueryOptions options;
  options.policy = policy;
  Query there(fixed, moving, options), back(moving, fixed, options);
  std::vector<LeafPair> pairs = ask(there, pose).leaf_pairs,
                        others = ask(back, pose.inverse()).leaf_pairs;
  for (LeafPair& leaf_pair : others) std::swap(leaf_pair.fixed, leaf_pair.moving);
  std::sort(others.begin(), others.end());
  std::vector<LeafPair> differ;
  std::set_symmetric_difference(pairs.begin(), pairs.end(), others.begin(), others.end(),
                                std::back_inserter(differ));
  EXPECT_LE(differ.size(), 2 + pairs.size() / 200);

  ContactManifold points(fixed, moving, policy, {.margin = 2}),
      swapped(moving, fixed, policy, {.margin = 2});
  const ContactSums a = find_contacts(there, points, pose).sums,
                    b = find_contacts(back, swapped, pose.inverse()).sums;
  // A pair is the same seen from either side, but for the rounding in another frame.
  ContactManifold each(fixed, moving, policy, {.points = 0, .margin = 2});
  double part = 1e-6;
  const double rounding = rounding_of(fixed, points) + rounding_of(moving, swapped);
  part += points.rates().weight * rounding * static_cast<double>(b.pairs) / b.weight;
  if (!differ.empty()) {  // those that only one of them has are as good as none
    double weight = 0;
    for (const PairSums& pair : sums_by_pair(there, each, fixed, moving, pose)) {
      const auto in = [&](const std::vector<LeafPair>& list) {
        return std::binary_search(list.begin(), list.end(), pair.leaves);
      };
      if (in(differ)) weight += pair.sums.weight;
    }
    EXPECT_LE(weight, part * a.weight);
  }
  EXPECT_NEAR(a.weight, b.weight, part * b.weight);
  const double lever = moving.bounding_radius();
  expect_near(mirrored(a.pressure, pose, a.about, b.about), b.pressure, part, lever);
  expect_near(mirrored(a.spring, pose, a.about, b.about), b.spring, part, lever);
}

TEST(SwappedBodies, FeelTheOpposite) {
  for (const Scene& scene : Scenes{solids()[0], solids()[1], solids()[2], jaws()}) {
    for (const SpherePolicy policy : kSpherePolicies) {
      SCOPED_TRACE(scene.name + ", " + std::string(to_string(policy)));
      expect_mirrored(scene.fixed, scene.moving, policy, scene.pose);
    }
  }
}

// The rounding of the inverse pose moves a pair into the pad or out of it.
TEST(SwappedBodies, FeelTheOppositeWhereSurfacesAreKnown) {
  for (const ClosedForm& form : closed_forms()) {
    const auto tree = [](const Solid& solid) {
      BuildOptions options;
      options.voxel_size = 0.3;
      return build_tree(solid.mesh(0.3), options);
    };
    const SphereTree fixed = tree(form.fixed), moving = tree(form.moving);
    for (const SpherePolicy policy : {SpherePolicy::kTable, SpherePolicy::kSlab}) {
      SCOPED_TRACE(form.name + ", " + std::string(to_string(policy)));
      expect_mirrored(fixed, moving, policy, form.pose(0.15));
    }
  }
}

TEST(SwappedBodies, FeelTheOppositeInAHumanJaw) {
  IST_SLOW();
  const auto poses = data_dir() / "truth_human.json";
  if (!std::filesystem::exists(poses)) IST_SKIP(poses << " is not there");
  BuildOptions options;
  options.voxel_size = 0.8;
  const SphereTree fixed = build_tree(read_mesh(data_dir() / "human_maxilla.stl"), options);
  const SphereTree moving = build_tree(read_mesh(data_dir() / "human_mandible.stl"), options);
  std::size_t touching = 0;
  for (const nlohmann::json& item : nlohmann::json::parse(std::ifstream(poses))) {
    const auto numbers = item["pose"].get<std::vector<double>>();
    Isometry3d pose;
    std::copy(numbers.begin(), numbers.end(), pose.matrix().data());
    for (const SpherePolicy policy : {SpherePolicy::kTable, SpherePolicy::kSlab}) {
      SCOPED_TRACE(item["label"].get<std::string>() + ", " + std::string(to_string(policy)));
      const FoundContacts found = find_contacts(fixed, moving, policy, pose, 32);
      if (found.sums.pairs == 0) continue;
      ++touching;
      expect_mirrored(fixed, moving, policy, pose);
      EXPECT_LE(found.points.size(), 32u);
      for (const Contact& p : found.points) {
        EXPECT_NEAR(p.normal.norm(), 1, 1e-12);
        EXPECT_GE(p.depth, -1.6 - 1e-9);
        EXPECT_LE(p.depth, 0.8 + 1e-9);
      }
    }
  }
  EXPECT_GT(touching, 8u);
}

}  // namespace
}  // namespace ist::test
