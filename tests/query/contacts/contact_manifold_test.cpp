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
#include "query/contacts/pair_sums.h"
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

// Within what rounding may do to every pair; returns the largest part of it that it does.
double compare(const ContactSums& a, const ContactSums& b, const ContactRates& rates,
               double rounding) {
  const double all = rounding * static_cast<double>(std::max<std::uint64_t>(b.pairs, 1));
  EXPECT_EQ(a.about, b.about);
  const double most =
      std::max({std::abs(a.weight - b.weight) / rates.weight,
                (a.pressure.force - b.pressure.force).norm() / rates.pressure_force,
                (a.pressure.torque - b.pressure.torque).norm() / rates.pressure_torque,
                (a.spring.force - b.spring.force).norm() / rates.spring_force,
                (a.spring.torque - b.spring.torque).norm() / rates.spring_torque}) /
      all;
  EXPECT_LE(most, 1);
  return most;
}

// The query gives what its leaf pairs give in double, and one contact a fixed leaf.
TEST(ContactManifold, AreThoseOfEachLeafPairInDouble) {
  std::size_t pairs = 0;
  double most = 0;
  for (const Scene& scene : small_scenes()) {
    for (const SpherePolicy policy : kSpherePolicies) {
      for (const double least : {-2.0, -0.5}) {
        SCOPED_TRACE(scene.name + ", " + std::string(to_string(policy)));
        const ManifoldOptions options{
            .points = 1 << 14, .max_leaves = 1 << 20, .least_depth = least};
        Query query(scene.fixed, scene.moving, options_of(policy));
        ContactManifold points(scene.fixed, scene.moving, policy, options);
        const PlainContacts plain(scene.fixed, scene.moving, policy, options);
        const auto wanted = plain.of(ask(query, scene.pose).leaf_pairs, scene.pose);
        const FoundContacts found = find_contacts(query, points, scene.pose);
        const double rounding = rounding_of(scene.fixed, points);
        most = std::max(most, compare(found.sums, plain.sums(wanted), points.rates(), rounding));
        EXPECT_GE(found.sums.pairs, wanted.size());  // by pads
        EXPECT_LE(found.sums.pairs, wanted.size() + wanted.size() / 50 + 1);
        EXPECT_LE(found.sums.pairs, found.result.leaf_pairs);
        pairs += wanted.size();
        double weight = 0;
        for (const Contact& p : found.points) weight += p.weight;
        EXPECT_NEAR(weight, found.sums.weight,
                    rounding * points.rates().weight * static_cast<double>(found.sums.pairs));
      }
    }
  }
  EXPECT_GT(pairs, 5'000u);
  EXPECT_GT(most, 0.01);  // the bound of rounding is not idle
}

// By leaf: the sums of one fixed leaf are its contact.
TEST(ContactManifold, OfOneFixedLeafAreItsMeans) {
  const std::vector<Scene> scenes = small_scenes();
  for (const Scene* scene : {&scenes[0], &scenes[1], &scenes[2]}) {
    for (const SpherePolicy policy : kSpherePolicies) {
      SCOPED_TRACE(scene->name + ", " + std::string(to_string(policy)));
      Query query(scene->fixed, scene->moving, options_of(policy));
      ContactManifold points(scene->fixed, scene->moving, policy, {.points = 0});
      const LinearOctree& octree = scene->fixed.parts().octree;
      LeafSums leaves(octree, octree.leaf_count());
      points.reducer().adder().stream = &leaves;
      static_cast<void>(query.contacts(scene->pose, points));
      leaves.close();
      const PlainContacts plain(scene->fixed, scene->moving, policy);
      const auto wanted = plain_points(plain.of(ask(query, scene->pose).leaf_pairs, scene->pose));
      const double whole = points.reducer().scale().area,
                   rounding = rounding_of(scene->fixed, points);
      std::size_t checked = 0;
      for (const LeafSum& leaf : leaves.nodes()) {
        const auto point = wanted.find(octree.first_child(1, leaf.node / 8) + leaf.node % 8);
        const double weight = whole / kContactUnit * leaf.weight;
        const double of_pairs = 64 * points.rates().weight * rounding;
        ASSERT_TRUE(point != wanted.end() || weight <= of_pairs);
        if (weight < 0.01 * whole) continue;
        const Contact& p = point->second;
        EXPECT_NEAR(weight, p.weight, of_pairs);
        EXPECT_NEAR(leaf.depth / leaf.weight - 2 * points.reducer().scale().size, p.depth,
                    1e3 * rounding);
        ++checked;
      }
      EXPECT_GT(checked, 5u);
    }
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
  EXPECT_NEAR(a.depth, b.depth, 1e-7 * b.weight);
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

TEST(ContactManifold, LoseNothingWhereThereIsNoRoom) {
  for (const Scene& scene : Scenes{solids()[0], solids()[2], shells()}) {
    for (const SpherePolicy policy : {SpherePolicy::kTable, SpherePolicy::kSlab}) {
      SCOPED_TRACE(scene.name + ", " + std::string(to_string(policy)));
      Query query(scene.fixed, scene.moving, options_of(policy));
      ContactManifold all(scene.fixed, scene.moving, policy, {1 << 14, 1 << 14});
      const FoundContacts whole = find_contacts(query, all, scene.pose);
      for (const std::size_t room : {1u, 2u, 7u, 30u, 200u}) {
        ContactManifold few(scene.fixed, scene.moving, policy, {1 << 14, room});
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
        ContactManifold fewer(scene.fixed, scene.moving, policy, {3, room});
        const FoundContacts joined = find_contacts(query, fewer, scene.pose);
        EXPECT_LE(joined.points.size(), 3u);
        EXPECT_NEAR(moments_of(joined.points).weight, whole.sums.weight, 1e-6 * whole.sums.weight);
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
  const FoundContacts found = find_contacts(tree_of(pin, 1), tree_of(clamp, 8),
                                            SpherePolicy::kTable, Eigen::Isometry3d::Identity());
  EXPECT_GT(found.sums.weight, 0);
  EXPECT_LT(found.sums.pressure.force.norm(), 1e-6 * found.sums.weight);
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
