#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "ist/base/error.h"
#include "ist/query/contacts/contact_reducer.h"
#include "ist/tree/sphere_tree.h"
#include "query/contacts/contact_cases.h"
#include "query/contacts/plain_contacts.h"
#include "query/scenes.h"
#include "simd/targets.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

// Few enough leaves for all pairs of them: like voxels, and coarse against fine both ways round.
std::vector<Scene> small_scenes() {
  Random random(7);
  const TriangleMesh ball = icosphere(2, 1), block = box({-0.9, -0.7, -0.8}, {0.9, 0.7, 0.8});
  std::vector<Scene> scenes;
  const auto add = [&](const char* name, const TriangleMesh& a, double cells_a,
                       const TriangleMesh& b, double cells_b, const Vector3d& by) {
    scenes.push_back(
        {name, tree_of(a, cells_a), tree_of(b, cells_b), pose_of(random.rotation(), by)});
  };
  add("equal", ball, 12, block, 11, {1.2, 0.5, 0.3});
  add("coarse in fine", ball, 14, block, 3, {0.5, 0.5, 1.3});
  add("fine in coarse", ball, 3, block, 13, {-0.9, -1.2, 0.2});
  add("one leaf", ball, 14, box({0, 0, 0}, {0.3, 0.3, 0.3}), 1, {0.6, 0.5, 0.3});
  for (int i = 0; i < 12; ++i) {
    add("random", random_mesh(random), random.uniform(1, 12), random_mesh(random),
        random.uniform(1, 12), random.point(-1, 1));
  }
  return scenes;
}

void expect_near(const Vector3d& a, const Vector3d& b, double tolerance) {
  EXPECT_LE((a - b).norm(), tolerance) << a.transpose() << " and " << b.transpose();
}

void expect_near(const ContactSums& a, const ContactSums& b, double extent) {
  const double tolerance = 1e-10 * b.weight;
  EXPECT_NEAR(a.weight, b.weight, tolerance);
  expect_near(a.about, b.about, 1e-12 * extent);
  expect_near(a.pressure.force, b.pressure.force, tolerance);
  expect_near(a.pressure.torque, b.pressure.torque, extent * tolerance);
  expect_near(a.spring.force, b.spring.force, extent * tolerance);
  expect_near(a.spring.torque, b.spring.torque, extent * extent * tolerance);
}

double extent_of(const Scene& scene) {
  return scene.fixed.bounding_radius() + scene.moving.bounding_radius();
}

double mean_size(const Scene& scene) {
  return 0.5 * (scene.fixed.voxel_size() + scene.moving.voxel_size());
}

// The query gives what all pairs of leaves give: no pair with a weight is missing in the answer,
// and none that the weight knows nothing of.
TEST(ContactManifold, AreThoseOfAllPairsOfLeaves) {
  std::size_t pairs = 0;
  for (const Scene& scene : small_scenes()) {
    for (const SpherePolicy policy : kSpherePolicies) {
      SCOPED_TRACE(scene.name + ", " + std::string(to_string(policy)));
      const auto plain = plain_pairs(scene.fixed, scene.moving, policy, scene.pose);
      const FoundContacts found = find_contacts(scene.fixed, scene.moving, policy, scene.pose);
      const double extent = extent_of(scene);
      expect_near(found.sums, plain_sums(plain, mean_size(scene), scene.fixed.origin()), extent);
      EXPECT_NEAR(static_cast<double>(found.sums.pairs), static_cast<double>(plain.size()), 1);
      EXPECT_LE(found.sums.pairs, found.result.leaf_pairs);
      pairs += plain.size();

      std::vector<Contact> expected, points = found.points;
      for (const auto& [leaf, point] : plain_points(plain)) expected.push_back(point);
      const auto before = [](const Contact& a, const Contact& b) { return a.weight < b.weight; };
      std::sort(expected.begin(), expected.end(), before);
      std::sort(points.begin(), points.end(), before);
      ASSERT_EQ(points.size(), expected.size());
      for (std::size_t i = 0; i < points.size(); ++i) {
        const double weight = expected[i].weight;
        EXPECT_NEAR(points[i].weight, weight, 1e-10 * found.sums.weight);
        if (weight < 1e-6 * found.sums.weight) continue;  // of rounding alone, or next to it
        expect_near(points[i].position, expected[i].position, 1e-8 * extent);
        EXPECT_NEAR(points[i].normal.norm(), 1, 1e-12);
      }
    }
  }
  EXPECT_GT(pairs, 5'000u);
}

// Unlike the test above, which has to sort by weight, this one knows which leaf a point is of.
TEST(ContactManifold, OfOneMovingLeafAreItsMeans) {
  const std::vector<Scene> scenes = small_scenes();
  const Scene& scene = scenes[0];
  for (const SpherePolicy policy : kSpherePolicies) {
    const auto plain = plain_pairs(scene.fixed, scene.moving, policy, scene.pose);
    const auto expected = plain_points(plain);
    ContactManifold points(scene.fixed, scene.moving, policy);
    std::size_t checked = 0;
    for (const auto& [leaf, point] : expected) {
      ASSERT_TRUE(points.reducer().begin(scene.pose));
      for (const PlainPair& pair : plain) {
        if (pair.moving == leaf)
          points.reducer().take(std::vector<LeafPair>{{pair.fixed, pair.moving}});
      }
      points.reducer().finish();
      ASSERT_EQ(points.points().size(), 1u);
      const Contact& found = points.points()[0];
      EXPECT_NEAR(found.weight, point.weight, 1e-12);
      if (point.weight < 1e-6) continue;
      expect_near(found.position, point.position, 1e-8);
      expect_near(found.normal, point.normal, 1e-7);
      EXPECT_NEAR(found.depth, point.depth, 1e-8);
      EXPECT_LE(found.depth, mean_size(scene));
      EXPECT_GE(found.depth, -2 * mean_size(scene));
      ++checked;
    }
    EXPECT_GT(checked, 20u);
  }
}

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
  EXPECT_NEAR(a.depth, b.depth, 1e-12 * b.weight);
  expect_near(a.position, b.position, 1e-11 * b.weight);
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

TEST(ContactManifold, AreJoinedToAsManyAsAreWanted) {
  for (const Scene& scene : Scenes{solids()[0], solids()[1], jaws()}) {
    for (const SpherePolicy policy : {SpherePolicy::kTable, SpherePolicy::kSlab}) {
      SCOPED_TRACE(scene.name + ", " + std::string(to_string(policy)));
      const FoundContacts all = find_contacts(scene.fixed, scene.moving, policy, scene.pose);
      ASSERT_GT(all.points.size(), 20u);
      const Moments whole = moments_of(all.points);
      EXPECT_NEAR(whole.weight, all.sums.weight, 1e-10 * whole.weight);
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

TEST(ContactManifold, LoseNothingWhereThereIsNoRoom) {
  for (const Scene& scene : Scenes{solids()[0], solids()[2], shells()}) {
    for (const SpherePolicy policy : {SpherePolicy::kTable, SpherePolicy::kSlab}) {
      SCOPED_TRACE(scene.name + ", " + std::string(to_string(policy)));
      Query query(scene.fixed, scene.moving, options_of(policy));
      ContactManifold all(scene.fixed, scene.moving, policy, {1 << 14, 1 << 14});
      const FoundContacts whole = find_contacts(query, all, scene.pose);
      for (const std::size_t room : {1u, 2u, 7u, 30u, 200u}) {
        ContactManifold few(scene.fixed, scene.moving, policy, {1 << 14, room});
        EXPECT_LT(few.bytes(), all.bytes());
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
        ContactManifold fewer(scene.fixed, scene.moving, policy, {3, room});
        const FoundContacts joined = find_contacts(query, fewer, scene.pose);
        EXPECT_LE(joined.points.size(), 3u);
        EXPECT_NEAR(moments_of(joined.points).weight, whole.sums.weight, 1e-10 * whole.sums.weight);
      }
    }
  }
}

TEST(ContactManifold, AreTheSameBitsHoweverTheyAreFound) {
  for (const Scene& scene : Scenes{solids()[0], shells()}) {
    for (const SpherePolicy policy : {SpherePolicy::kTable, SpherePolicy::kSlab}) {
      ContactManifold points(scene.fixed, scene.moving, policy);
      Query plain(scene.fixed, scene.moving, options_of(policy));
      const FoundContacts expected = find_contacts(plain, points, scene.pose);
      EXPECT_GT(expected.points.size(), 8u);
      for (const std::string& target : all_targets()) {
        for (const int workers : {1, 2}) {
          for (const std::size_t pairs : {65536u, 100u}) {
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
      const FoundPairs answer = ask(plain, scene.pose);
      for (const std::size_t part : {1u, 7u, 1000u, 1u << 30}) {
        ASSERT_TRUE(points.reducer().begin(scene.pose));
        for (std::span<const LeafPair> left = answer.leaf_pairs; !left.empty();) {
          const std::size_t count = std::min(part, left.size());
          EXPECT_TRUE(points.reducer().take(left.first(count)));
          left = left.subspan(count);
        }
        points.reducer().finish();
        EXPECT_TRUE(same(points.sums(), expected.sums));
        EXPECT_EQ(points.points().size(), expected.points.size());
      }
    }
  }
}

TEST(ContactManifold, OfNoRigidMotionAreNone) {
  const Scene& scene = solids()[0];
  Query query(scene.fixed, scene.moving);
  ContactManifold points(scene.fixed, scene.moving, query.policy());
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
  EXPECT_FALSE(points.reducer().take(ask(query, scene.pose).leaf_pairs));
  points.reducer().finish();
  EXPECT_EQ(points.points().size(), 0u);
  EXPECT_TRUE(same(find_contacts(query, points, scene.pose), before));

  const FoundContacts apart = find_contacts(query, points, shift({10, 0, 0}));
  EXPECT_EQ(apart.result.status, QueryStatus::kDone);
  EXPECT_EQ(apart.points.size(), 0u);
  EXPECT_EQ(apart.sums.weight, 0);
}

TEST(ContactManifold, NeedTheQuerysSpheres) {
  BuildOptions options;
  options.voxel_size = 0.5;
  options.spheres = SpherePolicy::kTable;
  const SphereTree table = build_tree(icosphere(1, 1), options);
  EXPECT_EQ(error_name([&] { ContactManifold(table, table, SpherePolicy::kSlab); }),
            to_string(ErrorCode::kPolicyMissing));
}

// The same numbers wherever the scene lies, and in whatever unit, with the unit's power.
TEST(ContactManifold, KnowNeitherPlaceNorUnit) {
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
    expect_near(there.sums.spring.torque, here.sums.spring.torque, 1e-6);
    ASSERT_FALSE(there.points.empty());
    expect_near(there.points[0].position - place, here.points[0].position, 1e-6);
  }
}

// Both sides of a plate thinner than a voxel cancel: nothing presses, and nothing is NaN.
TEST(ContactManifold, OfNormalsThatCancelHaveNoWeight) {
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
TEST(ContactManifold, HaveADirectionWhereNormalsBalance) {
  const TriangleMesh clamp = joined(box({-4, -4, -4}, {4, 4, -0.5}), box({-4, -4, 0.5}, {4, 4, 4}));
  const TriangleMesh pin = box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  const FoundContacts found = find_contacts(tree_of(clamp, 8), tree_of(pin, 1),
                                            SpherePolicy::kTable, Eigen::Isometry3d::Identity());
  EXPECT_GT(found.sums.weight, 0);
  EXPECT_LT(found.sums.pressure.force.norm(), 1e-9 * found.sums.weight);
  ASSERT_EQ(found.points.size(), 1u);
  EXPECT_NEAR(found.points[0].normal.norm(), 1, 1e-12);
  expect_near(found.points[0].position, {0, 0, 0}, 1e-12);
}

// A host may have set anything.
TEST(ContactManifold, KeepTheFloatEnvironment) {
  const Scene& scene = solids()[0];
  Query query(scene.fixed, scene.moving);
  ContactManifold points(scene.fixed, scene.moving, query.policy());
  const FoundContacts expected = find_contacts(query, points, scene.pose);
  const unsigned before = _mm_getcsr(), strange = 0x1F80 | 0x8040 | 0x6000;
  _mm_setcsr(strange);
  const FoundContacts found = find_contacts(query, points, scene.pose);
  const unsigned after = _mm_getcsr();
  _mm_setcsr(before);
  EXPECT_EQ(after, strange);
  EXPECT_TRUE(same(found, expected));
}

}  // namespace
}  // namespace ist::test
