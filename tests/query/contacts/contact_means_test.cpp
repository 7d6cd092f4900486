// Contacts and their sums are those of the leaf pairs, worked out pair by pair in double.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "ist/query/contacts/contact_reducer.h"
#include "ist/tree/sphere_tree.h"
#include "query/contacts/contact_cases.h"
#include "query/contacts/plain_contacts.h"
#include "query/scenes.h"
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

// In the place of each contact that weighs at least `least` there is one, and it is the same.
// Returns how many do.
std::size_t expect_contacts(const std::vector<Contact>& found,
                            const std::map<std::uint32_t, Contact>& wanted, double least,
                            double rounding) {
  const double tolerance = 10 * rounding;  // of the means of a contact's pairs
  std::size_t checked = 0;
  for (const auto& [leaf, contact] : wanted) {
    if (contact.weight < least) continue;
    SCOPED_TRACE("leaf " + std::to_string(leaf));
    const auto away = [&at = contact.position](const Contact& p) {
      return (p.position - at).norm();
    };
    const auto near =
        std::min_element(found.begin(), found.end(),
                         [&](const auto& p, const auto& q) { return away(p) < away(q); });
    if (near == found.end() || away(*near) > tolerance) {
      ADD_FAILURE() << "no contact at " << contact.position.transpose();
      continue;
    }
    EXPECT_NEAR(near->depth, contact.depth, tolerance);
    expect_close(near->normal, contact.normal, tolerance);
    EXPECT_NEAR(near->weight, contact.weight, 64 * tolerance);
    ++checked;
  }
  return checked;
}

// The query gives what its leaf pairs give in double, and one contact a fixed leaf.
TEST(ContactManifold, HasTheSumsAndContactsOfItsLeafPairsInDouble) {
  std::size_t pairs = 0, contacts = 0;
  double most = 0;
  for (const Scene& scene : small_scenes()) {
    for (const SpherePolicy policy : kSpherePolicies) {
      for (const double margin : {2.0, 0.5, 0.0}) {
        SCOPED_TRACE(scene.name + ", " + std::string(to_string(policy)));
        const ManifoldOptions options{.points = 1 << 14, .max_leaves = 1 << 20, .margin = margin};
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
        const double whole = detail::reducer_of(points).scale().area;
        contacts += expect_contacts(found.points, plain_points(wanted), 0.01 * whole, rounding);
      }
    }
  }
  EXPECT_GT(pairs, 5'000u);
  EXPECT_GT(contacts, 3'000u);
  EXPECT_GT(most, 0.01);  // the bound of rounding is not idle
}

// By leaf: the sums of one fixed leaf are its contact.
TEST(ContactManifold, HasTheMeansOfEachFixedLeaf) {
  const std::vector<Scene> scenes = small_scenes();
  for (const Scene* scene : {&scenes[0], &scenes[1], &scenes[2]}) {
    for (const SpherePolicy policy : kSpherePolicies) {
      SCOPED_TRACE(scene->name + ", " + std::string(to_string(policy)));
      Query query(scene->fixed, scene->moving, options_of(policy));
      ContactManifold points(scene->fixed, scene->moving, policy, {.points = 0, .margin = 2});
      const LinearOctree& octree = voxels_of(scene->fixed).octree;
      LeafSums leaves(octree, octree.leaf_count());
      detail::reducer_of(points).adder().stream = &leaves;
      static_cast<void>(query.contacts(scene->pose, points));
      leaves.close();
      const PlainContacts plain(scene->fixed, scene->moving, policy, {.margin = 2});
      const auto wanted = plain_points(plain.of(ask(query, scene->pose).leaf_pairs, scene->pose));
      const double whole = detail::reducer_of(points).scale().area,
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
        EXPECT_NEAR(leaf.depth / leaf.weight - 2 * detail::reducer_of(points).scale().size, p.depth,
                    1e3 * rounding);
        ++checked;
      }
      EXPECT_GT(checked, 5u);
    }
  }
}

}  // namespace
}  // namespace ist::test
