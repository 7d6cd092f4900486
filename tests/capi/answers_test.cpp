// The C interface gives what the C++ one gives, bit for bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "capi/c_bodies.h"
#include "ist/mesh/mesh_check.h"
#include "ist/query/collision_query.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/tree_builder.h"
#include "query/query_cases.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr double kVoxel = 0.07;

class CAnswers : public ::testing::Test {
 protected:
  CAnswers() {
    ist_tree* tree = c_tree(mesh_, kVoxel);
    c_query_ = c_query(tree);
  }
  ~CAnswers() override { EXPECT_EQ(name(ist_query_free(c_query_)), "ok"); }

  [[nodiscard]] static SphereTree build(const TriangleMesh& mesh) {
    BuildOptions options;
    options.voxel_size = kVoxel;
    options.keep_triangles = true;
    return build_tree(mesh, options);
  }

  // Apart, near, touching a little and a lot.
  [[nodiscard]] static std::vector<Eigen::Isometry3d> poses() {
    Random random(11);
    std::vector<Eigen::Isometry3d> poses;
    for (const double way : {2.6, 2.01, 1.96, 1.7, 0.9}) {
      for (int i = 0; i < 4; ++i) {
        poses.push_back(pose_of(random.rotation(), way * random.direction()));
      }
    }
    return poses;
  }

  const TriangleMesh mesh_ = icosphere(3, 1);
  const SphereTree tree_ = build(mesh_);
  CollisionQuery query_{tree_, tree_};
  ContactPoints points_{tree_, tree_, query_.policy()};
  ist_query* c_query_ = nullptr;
  std::vector<Contact> contacts_ = std::vector<Contact>(1 << 14);
  std::vector<ist_contact> c_contacts_ = std::vector<ist_contact>(1 << 14);
};

void expect_same(const ist_query_result& c, const QueryResult& result,
                 const CollisionQuery& query) {
  EXPECT_EQ(c.contacts, result.contacts);
  EXPECT_EQ(c.sphere_tests, result.sphere_tests);
  EXPECT_EQ(c.complete, result.complete ? 1 : 0);
  EXPECT_EQ(c.level, result.level);
  EXPECT_EQ(c.gap_known, result.gap ? 1 : 0);
  EXPECT_EQ(c.gap_lower, result.gap ? result.gap->lower : 0);
  EXPECT_EQ(c.gap_upper, result.gap ? result.gap->upper : 0);
  EXPECT_EQ(c.resolution, query.resolution(result));
}

TEST_F(CAnswers, AreTheSameContacts) {
  std::uint64_t contacts = 0;
  for (const Eigen::Isometry3d& pose : poses()) {
    for (const std::size_t room : {contacts_.size(), std::size_t{5}}) {
      const QueryResult result = query_.collide(pose, std::span(contacts_).first(room));
      auto c = sized<ist_query_result>();
      ASSERT_EQ(name(ist_query_collide(c_query_, pose.data(), c_contacts_.data(), room, &c)), "ok");
      expect_same(c, result, query_);
      EXPECT_EQ(c.truncated, result.truncated ? 1 : 0);
      ASSERT_EQ(c.written, std::min<std::uint64_t>(result.contacts, room));
      EXPECT_EQ(std::memcmp(contacts_.data(), c_contacts_.data(), c.written * sizeof(Contact)), 0);
      contacts += c.contacts;
    }
  }
  EXPECT_GT(contacts, 1000u);
}

TEST_F(CAnswers, AreTheSameWithABudget) {
  int incomplete = 0;
  for (const Eigen::Isometry3d& pose : poses()) {
    for (const std::uint64_t tests : {3u, 200u, 1'000'000u}) {
      const QueryResult result = query_.collide(pose, contacts_, {.sphere_tests = tests});
      const ist_budget budget{sizeof budget, tests, 0};
      auto c = sized<ist_query_result>();
      ASSERT_EQ(name(ist_query_collide_within(c_query_, pose.data(), &budget, c_contacts_.data(),
                                              c_contacts_.size(), &c)),
                "ok");
      expect_same(c, result, query_);
      incomplete += 1 - c.complete;
    }
  }
  EXPECT_GT(incomplete, 5);
}

// A budget of time: none of it is left at once, or there is more than a clock counts.
TEST_F(CAnswers, KeepABudgetOfTime) {
  const Eigen::Isometry3d pose = shift({1.7, 0, 0});
  const auto asked = [&](std::uint64_t nanoseconds) {
    const ist_budget budget{sizeof budget, 0, nanoseconds};
    auto c = sized<ist_query_result>();
    EXPECT_EQ(name(ist_query_collide_within(c_query_, pose.data(), &budget, c_contacts_.data(),
                                            c_contacts_.size(), &c)),
              "ok");
    return c;
  };
  EXPECT_EQ(asked(1).complete, 0);
  const ist_query_result all = asked(UINT64_MAX);
  EXPECT_EQ(all.complete, 1);
  EXPECT_EQ(all.contacts, query_.collide(pose, contacts_).contacts);
  EXPECT_EQ(asked(0).contacts, all.contacts);
}

TEST_F(CAnswers, AreTheSamePointsAndSums) {
  std::vector<ist_contact_point> c_points(32);
  std::uint64_t made = 0;
  for (const Eigen::Isometry3d& pose : poses()) {
    for (const std::uint64_t tests : {UINT64_MAX, std::uint64_t{500}}) {
      const ist_budget budget{sizeof budget, tests, 0};
      auto sums = sized<ist_contact_sums>();
      auto c = sized<ist_query_result>();
      const bool all = tests == UINT64_MAX;
      const QueryResult result =
          all ? query_.contact_points(pose, points_)
              : query_.contact_points(pose, points_, {.sphere_tests = tests});
      ASSERT_EQ(
          name(all ? ist_query_contact_points(c_query_, pose.data(), c_points.data(),
                                              c_points.size(), &sums, &c)
                   : ist_query_contact_points_within(c_query_, pose.data(), &budget,
                                                     c_points.data(), c_points.size(), &sums, &c)),
          "ok");
      expect_same(c, result, query_);
      ASSERT_EQ(c.points, points_.points().size());
      ASSERT_EQ(c.written, c.points);
      made += c.points;
      for (std::size_t i = 0; i < c.written; ++i) {
        const ContactPoint& point = points_.points()[i];
        EXPECT_EQ(Eigen::Vector3d(c_points[i].position), point.position);
        EXPECT_EQ(Eigen::Vector3d(c_points[i].normal), point.normal);
        EXPECT_EQ(c_points[i].depth, point.depth);
        EXPECT_EQ(c_points[i].weight, point.weight);
      }
      EXPECT_EQ(sums.pairs, points_.sums().pairs);
      EXPECT_EQ(sums.weight, points_.sums().weight);
      EXPECT_EQ(Eigen::Vector3d(sums.pressure_force), points_.sums().pressure.force);
      EXPECT_EQ(Eigen::Vector3d(sums.pressure_torque), points_.sums().pressure.torque);
      EXPECT_EQ(Eigen::Vector3d(sums.spring_force), points_.sums().spring.force);
      EXPECT_EQ(Eigen::Vector3d(sums.spring_torque), points_.sums().spring.torque);
      EXPECT_EQ(Eigen::Vector3d(sums.about), points_.sums().about);
    }
  }
  EXPECT_GT(made, 100u);
}

TEST_F(CAnswers, AreTheSameCertainOnes) {
  std::vector<TrianglePair> pairs(1 << 12);
  std::vector<ist_triangle_pair> c_pairs(1 << 12);
  std::uint64_t met = 0;
  for (const Eigen::Isometry3d& pose : poses()) {
    auto gap = sized<ist_gap_result>();
    ASSERT_EQ(name(ist_query_gap(c_query_, pose.data(), 0.001, &gap)), "ok");
    const GapResult gap_result = query_.gap(pose, 0.001);
    EXPECT_EQ(gap.lower, gap_result.gap.lower);
    EXPECT_EQ(gap.upper, gap_result.gap.upper);
    EXPECT_EQ(gap.sphere_tests, gap_result.sphere_tests);

    std::int32_t touch = -1;
    ASSERT_EQ(name(ist_query_touches(c_query_, pose.data(), &touch)), "ok");
    EXPECT_EQ(touch, query_.touches(pose) == Touch::kYes ? IST_TOUCH_YES : IST_TOUCH_NO);

    auto exact = sized<ist_exact_result>();
    ASSERT_EQ(name(ist_query_exact(c_query_, pose.data(), c_pairs.data(), c_pairs.size(), &exact)),
              "ok");
    const ExactResult exact_result = query_.collide_exact(pose, pairs);
    EXPECT_EQ(exact.pairs, exact_result.triangle_pairs);
    EXPECT_EQ(exact.sphere_tests, exact_result.sphere_tests);
    ASSERT_EQ(exact.written, exact.pairs);
    EXPECT_EQ(std::memcmp(pairs.data(), c_pairs.data(), exact.written * sizeof(TrianglePair)), 0);
    met += exact.pairs;
  }
  EXPECT_GT(met, 100u);
}

// Without triangles leaves that touch say no more than that.
TEST(CAnswer, MayBePossibleWithoutTriangles) {
  ist_query* query = c_query(c_tree(icosphere(2, 1), 0.2, false));
  std::int32_t touch = -1;
  ASSERT_EQ(name(ist_query_touches(query, c_shift(1.8, 0, 0).data(), &touch)), "ok");
  EXPECT_EQ(touch, IST_TOUCH_POSSIBLE);
  auto exact = sized<ist_exact_result>();
  EXPECT_EQ(name(ist_query_exact(query, c_shift(1.8, 0, 0).data(), nullptr, 0, &exact)),
            "triangles-missing");
  EXPECT_EQ(name(ist_query_free(query)), "ok");
}

// Options say what they say.
TEST(CAnswer, ComesOfTheOptionsThatAreGiven) {
  ist_tree* tree = c_tree(icosphere(2, 1), 0.2);
  auto options = sized<ist_query_options>();
  options.spheres = IST_SPHERES_TABLE;
  options.workers = 2;
  options.period_ns = -1;
  options.contact_points = 5;
  options.target = "scalar";
  ist_query* query = nullptr;
  ASSERT_EQ(name(ist_query_create(tree, tree, &options, &query)), "ok");
  auto info = sized<ist_query_info>();
  ASSERT_EQ(name(ist_query_get_info(query, &info)), "ok");
  EXPECT_EQ(info.spheres, IST_SPHERES_TABLE);
  EXPECT_EQ(info.workers, 2);
  EXPECT_EQ(info.contact_points, 5u);
  EXPECT_EQ(info.exact, 1);
  EXPECT_STREQ(info.target, "scalar");
  EXPECT_GT(info.bytes, 100'000u);
  auto result = sized<ist_query_result>();
  std::vector<ist_contact_point> points(8);
  ASSERT_EQ(name(ist_query_contact_points(query, c_shift(1.8, 0, 0).data(), points.data(), 8,
                                          nullptr, &result)),
            "ok");
  EXPECT_EQ(result.points, 5u);
  EXPECT_EQ(name(ist_query_free(query)), "ok");

  options.contact_points = -1;
  ASSERT_EQ(name(ist_query_create(tree, tree, &options, &query)), "ok");
  EXPECT_EQ(name(ist_query_contact_points(query, c_shift(1.8, 0, 0).data(), points.data(), 8,
                                          nullptr, &result)),
            "not-prepared");
  EXPECT_EQ(name(ist_query_free(query)), "ok");
  EXPECT_EQ(name(ist_tree_free(tree)), "ok");
}

// Floats are the doubles that they are.
TEST(CMesh, IsTheSameOfFloats) {
  const std::array<float, 9> floats = {0.1F, 0, 0, 1.3F, 0.2F, 0, 0, 2.7F, 0.4F};
  const std::array<std::uint32_t, 3> triangle = {0, 1, 2};
  ist_mesh* mesh = nullptr;
  ASSERT_EQ(name(ist_mesh_create_float(floats.data(), 3, triangle.data(), 1, &mesh)), "ok");
  auto info = sized<ist_mesh_info>();
  ASSERT_EQ(name(ist_mesh_get_info(mesh, &info)), "ok");
  EXPECT_EQ(info.box_max[0], double{1.3F});
  EXPECT_EQ(info.box_max[1], double{2.7F});
  EXPECT_EQ(info.box_max[2], double{0.4F});
  EXPECT_EQ(info.closed, 0);
  EXPECT_EQ(info.boundary_edges, 3u);
  EXPECT_EQ(info.components, 1u);
  EXPECT_EQ(name(ist_mesh_free(mesh)), "ok");
}

// What indices in answers are of.
TEST(CGeometry, IsWhatAnswersCount) {
  const TriangleMesh mesh = icosphere(2, 1);
  ist_mesh* c = c_mesh(mesh);
  std::vector<double> vertices(3 * mesh.vertices.size() + 1, 7);
  std::vector<std::uint32_t> triangles(3 * mesh.triangles.size() + 1, 7);
  ASSERT_EQ(name(ist_mesh_copy(c, vertices.data(), mesh.vertices.size(), triangles.data(),
                               mesh.triangles.size())),
            "ok");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(vertices[3 * i + static_cast<std::size_t>(axis)], mesh.vertices[i][axis]);
    }
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(triangles[3 * i + k], mesh.triangles[i][k]);
  }
  EXPECT_EQ(vertices.back(), 7);
  EXPECT_EQ(triangles.back(), 7u);
  // What there is room for, and no more than there is.
  std::vector<double> two(7, 5);
  ASSERT_EQ(name(ist_mesh_copy(c, two.data(), 2, nullptr, 0)), "ok");
  EXPECT_TRUE(std::equal(two.begin(), two.end() - 1, vertices.begin()));
  EXPECT_EQ(two.back(), 5);
  EXPECT_EQ(name(ist_mesh_free(c)), "ok");

  BuildOptions options;
  options.voxel_size = kVoxel;
  const SphereTree tree = build_tree(mesh, options);
  ist_tree* c_built = c_tree(mesh, kVoxel);
  const std::vector<Ball> cubes = level_spheres(tree, SpherePolicy::kSimple, 0);
  std::vector<double> centres(3 * cubes.size() + 3, 7);
  ASSERT_EQ(name(ist_tree_copy_leaf_centres(c_built, centres.data(), cubes.size() + 1)), "ok");
  for (std::size_t i = 0; i < cubes.size(); ++i) {
    const Eigen::Vector3d centre = tree.lattice().origin() + cubes[i].centre;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(centres[3 * i + static_cast<std::size_t>(axis)], centre[axis], 1e-15);
    }
  }
  EXPECT_EQ(centres[3 * cubes.size()], 7);
  EXPECT_EQ(name(ist_tree_free(c_built)), "ok");
}

}  // namespace
}  // namespace ist::test
