#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cmath>

#include "ist/base/error.h"
#include "ist/tree/sphere_tree.h"
#include "query/contacts/contact_cases.h"
#include "query/scenes.h"
#include "simd/targets.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

struct Moments {
  double weight = 0, depth = 0;
  Vector3d position = Vector3d::Zero();
};

Moments moments_of(std::span<const Contact> points) {
  Moments m;
  for (const Contact& p : points) {
    m.weight += p.weight;
    m.depth += p.weight * p.depth;
    m.position += p.weight * p.position;
  }
  return m;
}

void expect_near(const Moments& a, const Moments& b) {
  EXPECT_NEAR(a.weight, b.weight, 1e-12 * b.weight);
  EXPECT_NEAR(a.depth, b.depth, 1e-7 * b.weight);
  expect_close(a.position, b.position, 1e-11 * b.weight);
}

bool holds(std::span<const Contact> points, const Contact& wanted) {
  return std::any_of(points.begin(), points.end(),
                     [&](const Contact& p) { return same(p, wanted); });
}

// The deepest, then the least and greatest x, y and z.
std::vector<Contact> marked_of(const std::vector<Contact>& all) {
  const auto by = [&](const auto& value) {
    return *std::max_element(all.begin(), all.end(),
                             [&](const auto& a, const auto& b) { return value(a) < value(b); });
  };
  std::vector<Contact> marked{by([](const Contact& p) { return p.depth; })};
  for (const Eigen::Index axis : {0, 1, 2}) {
    for (const double sign : {-1, 1}) {
      marked.push_back(by([&](const Contact& p) { return sign * p.position[axis]; }));
    }
  }
  return marked;
}

TEST(ContactManifold, JoinsContactsToAsManyAsAreWanted) {
  for (const Scene& scene : Scenes{solids()[0], solids()[1], jaws()}) {
    for (const SpherePolicy policy : {SpherePolicy::kTable, SpherePolicy::kSlab}) {
      SCOPED_TRACE(scene.name + ", " + std::string(to_string(policy)));
      const FoundContacts all = find_contacts(scene.fixed, scene.moving, policy, scene.pose);
      ASSERT_GT(all.points.size(), 20u);
      const Moments whole = moments_of(all.points);
      EXPECT_NEAR(whole.weight, all.sums.weight, 1e-6 * whole.weight);
      const auto marked = marked_of(all.points);
      for (std::size_t most = 1; most <= 100; most += most < 16 ? 1 : 21) {
        SCOPED_TRACE(most);
        const FoundContacts some =
            find_contacts(scene.fixed, scene.moving, policy, scene.pose, most);
        EXPECT_TRUE(same(some.sums, all.sums));
        ASSERT_LE(some.points.size(), most);
        if (most >= 2) expect_near(moments_of(some.points), whole);
        EXPECT_NEAR(moments_of(some.points).weight, whole.weight, 1e-12 * whole.weight);
        EXPECT_EQ(some.points[0].depth, marked[0].depth);
        EXPECT_EQ(some.points[0].position, marked[0].position);
        for (std::size_t i = 0; i < marked.size() && i + 1 < most; ++i) {
          EXPECT_TRUE(holds(some.points, marked[i])) << "mark " << i;
        }
        for (const Contact& p : some.points) {
          EXPECT_NEAR(p.normal.norm(), 1, 1e-12);
          EXPECT_GT(p.weight, 0);
        }
        // No coarser than it must be: octree nodes have eight children at most.
        if (most > 8) {
          EXPECT_GE(some.points.size() - 7, (most - 7) / 8);
        }
      }
      EXPECT_TRUE(find_contacts(scene.fixed, scene.moving, policy, scene.pose, 0).points.empty());
    }
  }
}

TEST(ContactManifold, LosesNothingWhereThereIsNoRoom) {
  for (const Scene& scene : Scenes{solids()[0], solids()[2], shells()}) {
    for (const SpherePolicy policy : {SpherePolicy::kTable, SpherePolicy::kSlab}) {
      SCOPED_TRACE(scene.name + ", " + std::string(to_string(policy)));
      Query query(scene.fixed, scene.moving, options_of(policy));
      ContactManifold all(scene.fixed, scene.moving, policy, {1 << 14, 1 << 14, 2});
      const FoundContacts whole = find_contacts(query, all, scene.pose);
      for (const std::size_t room : {1u, 2u, 7u, 30u, 200u}) {
        ContactManifold few(scene.fixed, scene.moving, policy, {1 << 14, room, 2});
        if (room < scene.fixed.leaf_count()) {
          EXPECT_LT(few.bytes(), all.bytes());
        }
        const FoundContacts found = find_contacts(query, few, scene.pose);
        EXPECT_TRUE(same(found.sums, whole.sums));
        EXPECT_GE(found.points.size(), 1u);
        EXPECT_LE(found.points.size(), room);
        if (whole.points.size() > 8 * room) {
          EXPECT_GT(8 * found.points.size(), room);
        }
        expect_near(moments_of(found.points), moments_of(whole.points));
        EXPECT_TRUE(
            same(find_contacts(query, few, scene.pose), found));  // nothing is left of the last
        ContactManifold fewer(scene.fixed, scene.moving, policy, {3, room, 2});
        const FoundContacts joined = find_contacts(query, fewer, scene.pose);
        EXPECT_LE(joined.points.size(), 3u);
        EXPECT_NEAR(moments_of(joined.points).weight, whole.sums.weight, 1e-6 * whole.sums.weight);
      }
    }
  }
}

TEST(ContactManifold, IsTheSameBitsHoweverItIsFound) {
  for (const Scene& scene : Scenes{solids()[0], shells()}) {
    for (const SpherePolicy policy : {SpherePolicy::kTable, SpherePolicy::kSlab}) {
      ContactManifold points(scene.fixed, scene.moving, policy, {.margin = 2});
      Query plain(scene.fixed, scene.moving, options_of(policy));
      const FoundContacts expected = find_contacts(plain, points, scene.pose);
      EXPECT_GT(expected.points.size(), 8u);
      for (const std::string& target : all_targets()) {
        for (const int workers : {1, 2}) {
          for (const std::size_t pairs : {65536u, 1000u, 1u}) {
            QueryOptions options = options_of(policy, target, workers);
            options.frontier_pairs = pairs;
            Query query(scene.fixed, scene.moving, options);
            for (int i = 0; i < 5; ++i) {
              EXPECT_TRUE(same(find_contacts(query, points, scene.pose), expected))
                  << target << ", " << workers << " workers, " << pairs;
            }
          }
        }
      }
    }
  }
}

TEST(ContactManifold, IsEmptyAtNoRigidMotionAndWhereBodiesAreApart) {
  const Scene& scene = solids()[0];
  Query query(scene.fixed, scene.moving);
  ContactManifold points(scene.fixed, scene.moving, query.policy(), {.margin = 2});
  const FoundContacts before = find_contacts(query, points, scene.pose);
  EXPECT_GT(before.points.size(), 0u);
  Eigen::Isometry3d bad = scene.pose;
  bad.linear() *= 2;
  const FoundContacts none = find_contacts(query, points, bad);
  EXPECT_EQ(none.result.status, QueryStatus::kInvalidPose);
  EXPECT_EQ(none.points.size(), 0u);
  EXPECT_EQ(none.sums.pairs, 0u);
  EXPECT_EQ(none.sums.weight, 0);
  EXPECT_EQ(none.sums.spring.force, Vector3d::Zero());
  EXPECT_TRUE(same(find_contacts(query, points, scene.pose), before));

  const FoundContacts apart = find_contacts(query, points, shift({10, 0, 0}));
  EXPECT_EQ(apart.result.status, QueryStatus::kDone);
  EXPECT_EQ(apart.points.size(), 0u);
  EXPECT_EQ(apart.sums.weight, 0);
}

TEST(ContactManifold, NeedsTheQuerysSpheres) {
  BuildOptions options;
  options.voxel_size = 0.5;
  options.spheres = SpherePolicy::kTable;
  const SphereTree table = build_tree(icosphere(1, 1), options);
  EXPECT_EQ(error_name([&] { ContactManifold(table, table, SpherePolicy::kSlab); }),
            to_string(ErrorCode::kPolicyMissing));
}

// The same numbers wherever the scene lies, and in whatever unit, with the unit's power.
TEST(ContactManifold, KnowsNeitherPlaceNorUnit) {
  const auto at = [](double unit, const Vector3d& place, SpherePolicy policy) {
    TriangleMesh ball = icosphere(2, 1), block = box({-1, -0.75, -0.75}, {1, 0.75, 0.75});
    for (Vector3d& v : ball.vertices) v = unit * v + place;
    for (Vector3d& v : block.vertices) v = unit * v - place;
    Eigen::Isometry3d pose = shift(unit * Vector3d(1.5, 0.5, 0.25) + 2 * place);
    return find_contacts(tree_of(ball, 12), tree_of(block, 16), policy, pose);
  };
  for (const SpherePolicy policy : {SpherePolicy::kTable, SpherePolicy::kSlab}) {
    const FoundContacts here = at(1, {0, 0, 0}, policy);
    EXPECT_GT(here.points.size(), 10u);
    for (const double unit : {0x1p-20, 0x1p13}) {
      const FoundContacts there = at(unit, {0, 0, 0}, policy);
      ASSERT_EQ(there.points.size(), here.points.size());
      EXPECT_EQ(there.sums.pairs, here.sums.pairs);
      EXPECT_EQ(there.sums.weight, unit * unit * here.sums.weight);
      EXPECT_EQ(there.sums.pressure.force, unit * unit * here.sums.pressure.force);
      EXPECT_EQ(there.sums.spring.force, unit * unit * unit * here.sums.spring.force);
      for (std::size_t i = 0; i < here.points.size(); ++i) {
        EXPECT_EQ(there.points[i].depth, unit * here.points[i].depth);
        EXPECT_EQ(there.points[i].normal, here.points[i].normal);
      }
    }
    const Vector3d place(0x1p20, -0x1p20, 0x1p19);  // vertices are rounded there
    const FoundContacts there = at(1, place, policy);
    EXPECT_NEAR(there.sums.weight, here.sums.weight, 1e-6 * here.sums.weight);
    expect_close(there.sums.spring.torque, here.sums.spring.torque, 1e-6);
    ASSERT_FALSE(there.points.empty());
    expect_close(there.points[0].position - place, here.points[0].position, 1e-6);
  }
}

// Both sides of a plate thinner than a voxel cancel: nothing presses, and nothing is NaN.
TEST(ContactManifold, GivesNoWeightToNormalsThatCancel) {
  const SphereTree plate = tree_of(box({-1, -1, -0.01}, {1, 1, 0.01}), 8);
  for (const SpherePolicy policy : kSpherePolicies) {
    const FoundContacts found = find_contacts(plate, plate, policy, shift({0.05, 0.03, 0.1}));
    EXPECT_GT(found.result.leaf_pairs, 64u);
    EXPECT_TRUE(std::isfinite(found.sums.weight));
    EXPECT_TRUE(found.sums.spring.torque.allFinite());
    for (const Contact& p : found.points) {
      EXPECT_TRUE(p.position.allFinite());
      EXPECT_NEAR(p.normal.norm(), 1, 1e-12);
      EXPECT_GT(std::max(std::abs(p.position[0]), std::abs(p.position[1])), 0.6) << "not the rim";
    }
    const FoundContacts flat =
        find_contacts(plate, tree_of(icosphere(3, 1), 8), policy, shift({0, 0, 1}));
    EXPECT_GT(flat.sums.weight, 0);  // the ball's normals alone are known
    EXPECT_GT(flat.sums.pressure.force.normalized()[2], 0.99);
  }
}

// A leaf that is pressed from both sides has a sum of nothing, and one of both directions.
TEST(ContactManifold, HasADirectionWhereNormalsBalance) {
  const TriangleMesh clamp = joined(box({-4, -4, -4}, {4, 4, -0.5}), box({-4, -4, 0.5}, {4, 4, 4}));
  const TriangleMesh pin = box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  const FoundContacts found = find_contacts(tree_of(pin, 1), tree_of(clamp, 8),
                                            SpherePolicy::kTable, Eigen::Isometry3d::Identity());
  EXPECT_GT(found.sums.weight, 0);
  EXPECT_LT(found.sums.pressure.force.norm(), 1e-6 * found.sums.weight);
  ASSERT_EQ(found.points.size(), 1u);
  EXPECT_NEAR(found.points[0].normal.norm(), 1, 1e-12);
  expect_close(found.points[0].position, {0, 0, 0}, 1e-12);
}

// A host may have set anything.
TEST(ContactManifold, KeepsTheFloatEnvironment) {
  const Scene& scene = solids()[0];
  Query query(scene.fixed, scene.moving);
  ContactManifold points(scene.fixed, scene.moving, query.policy(), {.margin = 2});
  const FoundContacts expected = find_contacts(query, points, scene.pose);
  const unsigned before = _mm_getcsr(), strange = 0x1F80 | 0x8040 | 0x6000;
  _mm_setcsr(strange);
  const FoundContacts found = find_contacts(query, points, scene.pose);
  const unsigned after = _mm_getcsr();
  _mm_setcsr(before);
  EXPECT_EQ(after, strange);
  EXPECT_TRUE(same(found, expected));
}

// What counts as a contact besides bounds that touch.

// A plate a little above another. The reach decides its area and weight in the sums.
TEST(ContactReach, CountsPairsThatAreNoFartherApart) {
  constexpr double kSize = 0.25;
  BuildOptions build;
  build.voxel_size = kSize;
  const SphereTree lower = build_tree(box({-1, -1, -1}, {1, 1, 0}), build);
  const SphereTree upper = build_tree(box({-1, -1, 0}, {1, 1, 1}), build);
  Query query(lower, upper);
  ASSERT_EQ(query.policy(), SpherePolicy::kSlab);
  const auto sums_at = [&](double gap, double reach) {
    ManifoldOptions options;
    options.margin = 1;
    options.reach = reach;
    ContactManifold points(lower, upper, query.policy(), options);
    return find_contacts(query, points, pose_of(Eigen::Matrix3d::Identity(), {0, 0, gap * kSize}))
        .sums;
  };
  // Leaves at the plates' edges have thick slabs, and meet to a voxel's edge above each other.
  EXPECT_EQ(sums_at(0.9, 0).pairs, 0u);
  const ContactSums few = sums_at(0.9, 0.25), more = sums_at(0.9, 0.5);
  EXPECT_GT(few.pairs, 100u);
  EXPECT_GT(few.weight, 0);
  EXPECT_GT(more.pairs, few.pairs);
  EXPECT_GT(more.weight, 2 * few.weight);
  EXPECT_GT(more.pressure.force.z(), 0.9 * more.weight);
  // Those in their middle, which are flat, meet only by reach.
  EXPECT_GT(sums_at(0.3, 0.5).weight, 3 * sums_at(0.3, 0).weight);
}

}  // namespace
}  // namespace ist::test
