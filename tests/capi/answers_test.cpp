// The C interface gives the same answers as the C++ interface, bit for bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "capi/c_bodies.h"
#include "ist/base/pose.h"
#include "ist/capi/ist_measure.h"
#include "ist/mesh/mesh.h"
#include "ist/query/query.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/sphere_tree.h"
#include "query/query_cases.h"
#include "support/shapes.h"
#include "support/temp_dir.h"

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

  // Apart, near, and with small and large intersections.
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
  Query query_{tree_, tree_};
  ContactManifold manifold_{tree_, tree_, query_.policy()};
  ist_query* c_query_ = nullptr;
  std::vector<LeafPair> leaf_pairs_ = std::vector<LeafPair>(1 << 14);
  std::vector<ist_leaf_pair> c_leaf_pairs_ = std::vector<ist_leaf_pair>(1 << 14);
};

void expect_same(const ist_query_result& c, const QueryResult& result) {
  EXPECT_EQ(c.leaf_pairs, result.leaf_pairs);
  EXPECT_EQ(c.sphere_tests, result.sphere_tests);
  EXPECT_EQ(c.complete, result.complete ? 1 : 0);
  EXPECT_EQ(c.level, result.level);
  EXPECT_EQ(c.distance_known, result.distance ? 1 : 0);
  EXPECT_EQ(c.distance_lower, result.distance ? result.distance->lower : 0);
  EXPECT_EQ(c.distance_upper, result.distance ? result.distance->upper : 0);
  EXPECT_EQ(c.resolution, result.resolution);
}

void expect_same(const ist_contact& c, const Contact& contact) {
  EXPECT_EQ(Eigen::Vector3d(c.position), contact.position);
  EXPECT_EQ(Eigen::Vector3d(c.normal), contact.normal);
  EXPECT_EQ(c.depth, contact.depth);
  EXPECT_EQ(c.weight, contact.weight);
}

void expect_same(const ist_contact_sums& c, const ContactSums& sums) {
  EXPECT_EQ(c.pairs, sums.pairs);
  EXPECT_EQ(c.weight, sums.weight);
  EXPECT_EQ(Eigen::Vector3d(c.pressure_force), sums.pressure.force);
  EXPECT_EQ(Eigen::Vector3d(c.pressure_torque), sums.pressure.torque);
  EXPECT_EQ(Eigen::Vector3d(c.spring_force), sums.spring.force);
  EXPECT_EQ(Eigen::Vector3d(c.spring_torque), sums.spring.torque);
  EXPECT_EQ(Eigen::Vector3d(c.about), sums.about);
}

void expect_same(const ist_near_pair& c, const NearPair& pair) {
  EXPECT_EQ((TrianglePair{c.fixed, c.moving}), pair.triangles);
  EXPECT_EQ(c.distance, pair.distance);
  EXPECT_EQ(Eigen::Vector3d(c.fixed_point), pair.fixed_point);
  EXPECT_EQ(Eigen::Vector3d(c.moving_point), pair.moving_point);
  EXPECT_EQ(Eigen::Vector3d(c.direction), pair.direction());
  EXPECT_EQ(c.fixed_part, static_cast<std::int32_t>(pair.fixed_part));
  EXPECT_EQ(c.moving_part, static_cast<std::int32_t>(pair.moving_part));
}

void expect_same(const ist_near_pairs_result& c, const NearPairsResult& result) {
  EXPECT_EQ(c.pairs, result.near_pairs);
  EXPECT_EQ(c.sphere_tests, result.sphere_tests);
  EXPECT_EQ(c.complete, result.complete ? 1 : 0);
  EXPECT_EQ(c.found, static_cast<std::int32_t>(result.found));
  EXPECT_EQ(c.pad, result.pad);
  EXPECT_EQ(c.rotation_error, result.rotation_error);
}

TEST_F(CAnswers, AreTheSameLeafPairs) {
  std::uint64_t leaf_pairs = 0;
  for (const Eigen::Isometry3d& pose : poses()) {
    for (const std::size_t room : {leaf_pairs_.size(), std::size_t{5}}) {
      const QueryResult result = query_.leaf_pairs(pose, std::span(leaf_pairs_).first(room));
      auto c = sized<ist_query_result>();
      ASSERT_EQ(name(ist_query_leaf_pairs(c_query_, pose.data(), nullptr, c_leaf_pairs_.data(),
                                          room, &c)),
                "ok");
      expect_same(c, result);
      EXPECT_EQ(c.truncated, result.truncated ? 1 : 0);
      ASSERT_EQ(c.written, std::min<std::uint64_t>(result.leaf_pairs, room));
      EXPECT_EQ(std::memcmp(leaf_pairs_.data(), c_leaf_pairs_.data(), c.written * sizeof(LeafPair)),
                0);
      leaf_pairs += c.leaf_pairs;
    }
  }
  EXPECT_GT(leaf_pairs, 1000u);
}

TEST_F(CAnswers, AreTheSameWithABudget) {
  int incomplete = 0;
  for (const Eigen::Isometry3d& pose : poses()) {
    for (const std::uint64_t tests : {3u, 200u, 1'000'000u}) {
      const QueryResult result = query_.leaf_pairs(pose, leaf_pairs_, {.tests = tests});
      const ist_budget budget{sizeof budget, tests, 0};
      auto c = sized<ist_query_result>();
      ASSERT_EQ(name(ist_query_leaf_pairs(c_query_, pose.data(), &budget, c_leaf_pairs_.data(),
                                          c_leaf_pairs_.size(), &c)),
                "ok");
      expect_same(c, result);
      incomplete += 1 - c.complete;
    }
  }
  EXPECT_GT(incomplete, 5);
}

// Time limits of 1 ns, of more than the clock can count, and of 0, which is no limit.
TEST_F(CAnswers, KeepABudgetOfTime) {
  const Eigen::Isometry3d pose = shift({1.7, 0, 0});
  const auto asked = [&](std::uint64_t nanoseconds) {
    const ist_budget budget{sizeof budget, 0, nanoseconds};
    auto c = sized<ist_query_result>();
    EXPECT_EQ(name(ist_query_leaf_pairs(c_query_, pose.data(), &budget, c_leaf_pairs_.data(),
                                        c_leaf_pairs_.size(), &c)),
              "ok");
    return c;
  };
  EXPECT_EQ(asked(1).complete, 0);
  const ist_query_result all = asked(UINT64_MAX);
  EXPECT_EQ(all.complete, 1);
  EXPECT_EQ(all.leaf_pairs, query_.leaf_pairs(pose, leaf_pairs_).leaf_pairs);
  EXPECT_EQ(asked(0).leaf_pairs, all.leaf_pairs);
}

// A budget without limits changes no answer, and makes the distance known.
TEST_F(CAnswers, AreTheSameWithoutAndWithAnEmptyBudget) {
  int unknown = 0;
  std::vector<ist_contact> contacts(32), same_contacts(32);
  std::vector<ist_leaf_pair> same_pairs(c_leaf_pairs_.size());
  for (const Eigen::Isometry3d& pose : poses()) {
    const auto none = sized<ist_query_result>();
    auto without = none;
    ASSERT_EQ(name(ist_query_leaf_pairs(c_query_, pose.data(), nullptr, c_leaf_pairs_.data(),
                                        c_leaf_pairs_.size(), &without)),
              "ok");
    auto sums = sized<ist_contact_sums>();
    auto without_sums = sums;
    auto contacts_without = none;
    ASSERT_EQ(name(ist_query_contacts(c_query_, pose.data(), nullptr, contacts.data(), 32,
                                      &without_sums, &contacts_without)),
              "ok");
    unknown += 1 - without.distance_known;
    for (const auto& [tests, nanoseconds] : {std::pair<std::uint64_t, std::uint64_t>{0, 0},
                                             {UINT64_MAX, 0},
                                             {0, UINT64_MAX},
                                             {UINT64_MAX, UINT64_MAX}}) {
      const ist_budget budget{sizeof budget, tests, nanoseconds};
      auto with = none;
      ASSERT_EQ(name(ist_query_leaf_pairs(c_query_, pose.data(), &budget, same_pairs.data(),
                                          same_pairs.size(), &with)),
                "ok");
      EXPECT_EQ(with.leaf_pairs, without.leaf_pairs);
      EXPECT_EQ(with.written, without.written);
      EXPECT_EQ(with.sphere_tests, without.sphere_tests);
      EXPECT_EQ(with.complete, 1);
      EXPECT_EQ(with.distance_known, 1);
      EXPECT_EQ(std::memcmp(same_pairs.data(), c_leaf_pairs_.data(),
                            without.written * sizeof(ist_leaf_pair)),
                0);

      auto contacts_with = none;
      ASSERT_EQ(name(ist_query_contacts(c_query_, pose.data(), &budget, same_contacts.data(), 32,
                                        &sums, &contacts_with)),
                "ok");
      EXPECT_EQ(std::memcmp(&sums, &without_sums, sizeof sums), 0);
      EXPECT_EQ(std::memcmp(&contacts_with, &contacts_without, sizeof contacts_with), 0);
      EXPECT_EQ(contacts_with.distance_known, 1);
      EXPECT_EQ(std::memcmp(same_contacts.data(), contacts.data(),
                            contacts_with.written * sizeof(ist_contact)),
                0);
    }
  }
  EXPECT_GT(unknown, 3);
}

TEST_F(CAnswers, AreTheSameContactsAndSums) {
  std::vector<ist_contact> c_contacts(32);
  std::uint64_t made = 0;
  for (const Eigen::Isometry3d& pose : poses()) {
    for (const std::uint64_t tests : {std::uint64_t{0}, std::uint64_t{500}}) {
      const ist_budget budget{sizeof budget, tests, 0};
      auto sums = sized<ist_contact_sums>();
      auto c = sized<ist_query_result>();
      const bool all = tests == 0;
      const QueryResult result = all ? query_.contacts(pose, manifold_)
                                     : query_.contacts(pose, manifold_, {.tests = tests});
      ASSERT_EQ(name(ist_query_contacts(c_query_, pose.data(), all ? nullptr : &budget,
                                        c_contacts.data(), c_contacts.size(), &sums, &c)),
                "ok");
      expect_same(c, result);
      ASSERT_EQ(c.contacts, manifold_.points().size());
      ASSERT_EQ(c.written, c.contacts);
      made += c.contacts;
      for (std::size_t i = 0; i < c.written; ++i) {
        expect_same(c_contacts[i], manifold_.points()[i]);
      }
      expect_same(sums, manifold_.sums());

      double force[3], torque[3];
      for (const double stiffness : {0.0, 2.5, -1e3}) {
        ASSERT_EQ(name(ist_contact_sums_wrench(&sums, stiffness, force, torque)), "ok");
        EXPECT_EQ(Eigen::Vector3d(force), stiffness * manifold_.sums().spring.force);
        EXPECT_EQ(Eigen::Vector3d(torque), stiffness * manifold_.sums().spring.torque);
        EXPECT_EQ(Eigen::Vector3d(force), manifold_.wrench(stiffness).force);
        EXPECT_EQ(Eigen::Vector3d(torque), manifold_.wrench(stiffness).torque);
      }
    }
  }
  EXPECT_GT(made, 100u);
}

// Springs begin at the margin, as in a manifold.
TEST_F(CAnswers, AreTheSameWithAMargin) {
  ist_tree* tree = c_tree(mesh_, kVoxel);
  std::vector<ist_contact> c_contacts(32);
  std::vector<double> weights;
  for (const double margin : {2.0, 1.5, 0.25, 0.0}) {
    auto options = sized<ist_query_options>();
    options.margin = margin;
    ist_query* query = nullptr;
    ASSERT_EQ(name(ist_query_create(tree, tree, &options, &query)), "ok");
    ContactManifold manifold(tree_, tree_, query_.policy(), {.margin = margin});
    std::uint64_t made = 0;
    double weight = 0;
    for (const Eigen::Isometry3d& pose : poses()) {
      auto sums = sized<ist_contact_sums>();
      auto c = sized<ist_query_result>();
      const QueryResult result = query_.contacts(pose, manifold);
      ASSERT_EQ(name(ist_query_contacts(query, pose.data(), nullptr, c_contacts.data(),
                                        c_contacts.size(), &sums, &c)),
                "ok");
      expect_same(c, result);
      expect_same(sums, manifold.sums());
      ASSERT_EQ(c.written, manifold.points().size());
      for (std::size_t i = 0; i < c.written; ++i) {
        expect_same(c_contacts[i], manifold.points()[i]);
      }
      made += c.contacts;
      weight += sums.weight;
    }
    EXPECT_GT(made, 50u) << margin;
    weights.push_back(weight);
    EXPECT_EQ(name(ist_query_free(query)), "ok");
  }
  for (std::size_t i = 1; i < weights.size(); ++i) EXPECT_LT(weights[i], weights[i - 1]);
  EXPECT_EQ(name(ist_tree_free(tree)), "ok");
}

TEST_F(CAnswers, SayHowFarThePoseWas) {
  Eigen::Isometry3d rough = poses().front();
  rough.linear() *= Eigen::Vector3d(1 + 1e-4, 1, 1 - 1e-4).asDiagonal();
  const double error = rotation_error(rough);
  EXPECT_GT(error, 1e-4);
  auto result = sized<ist_query_result>();
  ASSERT_EQ(name(ist_query_leaf_pairs(c_query_, rough.data(), nullptr, nullptr, 0, &result)), "ok");
  EXPECT_EQ(result.rotation_error, error);
  result = sized<ist_query_result>();
  ASSERT_EQ(name(ist_query_contacts(c_query_, rough.data(), nullptr, nullptr, 0, nullptr, &result)),
            "ok");
  EXPECT_EQ(result.rotation_error, error);
  auto distance = sized<ist_distance_result>();
  ASSERT_EQ(name(ist_query_distance(c_query_, rough.data(), 1, nullptr, &distance)), "ok");
  EXPECT_EQ(distance.rotation_error, error);
  auto met = sized<ist_triangle_pairs_result>();
  ASSERT_EQ(name(ist_query_triangle_pairs(c_query_, rough.data(), nullptr, nullptr, 0, &met)),
            "ok");
  EXPECT_EQ(met.rotation_error, error);
  auto depth = sized<ist_penetration>();
  ASSERT_EQ(
      name(ist_query_penetration(c_query_, rough.data(), 1, nullptr, nullptr, nullptr, &depth)),
      "ok");
  EXPECT_EQ(depth.rotation_error, error);
  auto motion = sized<ist_motion>();
  const Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  motion.from = start.data();
  motion.to = rough.data();
  auto contact = sized<ist_first_contact>();
  ASSERT_EQ(name(ist_query_first_contact(c_query_, &motion, 1, nullptr, nullptr, &contact)), "ok");
  EXPECT_EQ(contact.rotation_error, error);
  auto fixed = sized<ist_occlusion>(), moving = sized<ist_occlusion>();
  ASSERT_EQ(name(ist_query_occlusion(c_query_, rough.data(), nullptr, nullptr, nullptr, nullptr,
                                     &fixed, &moving)),
            "ok");
  EXPECT_EQ(fixed.rotation_error, error);
  EXPECT_EQ(moving.rotation_error, error);
  auto options = sized<ist_rows_options>();
  options.questions = IST_ASK_INTERSECTS;
  ist_row row;
  for (const double scale : {1, 3}) {
    rough.linear() *= scale;
    ASSERT_EQ(name(ist_query_rows(c_query_, rough.data(), 1, &options, &row)), "ok");
    EXPECT_EQ(row.rotation_error, rotation_error(rough));
    double alone = -1;
    ASSERT_EQ(name(ist_rotation_error(rough.data(), &alone)), "ok");
    EXPECT_EQ(alone, rotation_error(rough));
  }
  EXPECT_EQ(row.status, IST_POSE_INVALID);
}

TEST_F(CAnswers, NameAScale) {
  Eigen::Isometry3d scaled = Eigen::Isometry3d::Identity();
  scaled.linear() *= 1.0001;
  std::int32_t answer = IST_ANSWER_NO;
  EXPECT_EQ(name(ist_query_intersects(c_query_, scaled.data(), nullptr, &answer)), "pose-invalid");
  EXPECT_EQ(answer, IST_ANSWER_UNKNOWN);
  EXPECT_NE(std::string(ist_last_error_message()).find("scale"), std::string::npos)
      << ist_last_error_message();
}

TEST_F(CAnswers, AreTheSameCertainOnes) {
  std::vector<TrianglePair> pairs(1 << 12);
  std::vector<ist_triangle_pair> c_pairs(1 << 12);
  std::uint64_t met = 0;
  auto budget = sized<ist_budget>();
  budget.tests = 300;
  bool cut = false;
  for (const Eigen::Isometry3d& pose : poses()) {
    ASSERT_EQ(name(ist_query_forget(c_query_)), "ok");
    query_.forget();
    auto distance = sized<ist_distance_result>();
    ASSERT_EQ(name(ist_query_distance(c_query_, pose.data(), 0.001, nullptr, &distance)), "ok");
    const DistanceResult wanted = query_.distance(pose, 0.001);
    EXPECT_EQ(distance.lower, wanted.distance.lower);
    EXPECT_EQ(distance.upper, wanted.distance.upper);
    EXPECT_EQ(distance.sphere_tests, wanted.sphere_tests);
    EXPECT_EQ(distance.complete, wanted.complete ? 1 : 0);
    EXPECT_EQ(distance.narrowest, wanted.narrowest);
    EXPECT_EQ(distance.rotation_error, wanted.rotation_error);
    ASSERT_TRUE(wanted.nearest.has_value());
    EXPECT_EQ(distance.nearest_known, 1);
    EXPECT_EQ(distance.nearest_triangles[0], wanted.nearest->triangles.fixed);
    EXPECT_EQ(distance.nearest_triangles[1], wanted.nearest->triangles.moving);
    EXPECT_EQ(Eigen::Vector3d(distance.nearest_fixed), wanted.nearest->fixed_point);
    EXPECT_EQ(Eigen::Vector3d(distance.nearest_moving), wanted.nearest->moving_point);
    EXPECT_EQ(Eigen::Vector3d(distance.direction), wanted.nearest->direction());
    ASSERT_EQ(name(ist_query_distance(c_query_, pose.data(), 9, nullptr, &distance)), "ok");
    EXPECT_EQ(distance.complete, 1);

    std::int32_t answer = -1;
    ASSERT_EQ(name(ist_query_intersects(c_query_, pose.data(), nullptr, &answer)), "ok");
    EXPECT_EQ(answer,
              query_.intersects(pose).answer == ist::Answer::kYes ? IST_ANSWER_YES : IST_ANSWER_NO);

    auto c = sized<ist_triangle_pairs_result>();
    ASSERT_EQ(name(ist_query_triangle_pairs(c_query_, pose.data(), nullptr, c_pairs.data(),
                                            c_pairs.size(), &c)),
              "ok");
    const TrianglePairsResult result = query_.triangle_pairs(pose, pairs);
    EXPECT_EQ(c.pairs, result.triangle_pairs);
    EXPECT_EQ(c.sphere_tests, result.sphere_tests);
    EXPECT_EQ(c.truncated, 0);
    ASSERT_EQ(c.written, c.pairs);
    EXPECT_EQ(std::memcmp(pairs.data(), c_pairs.data(), c.written * sizeof(TrianglePair)), 0);
    EXPECT_EQ(c.complete, 1);
    EXPECT_EQ(answer == IST_ANSWER_YES, c.pairs > 0);
    met += c.pairs;

    // And within a budget.
    ASSERT_EQ(name(ist_query_distance(c_query_, pose.data(), 0.001, &budget, &distance)), "ok");
    const DistanceResult some = query_.distance(pose, 0.001, {.tests = budget.tests});
    EXPECT_EQ(distance.lower, some.distance.lower);
    EXPECT_EQ(distance.upper, some.distance.upper);
    ASSERT_EQ(name(ist_query_intersects(c_query_, pose.data(), &budget, &answer)), "ok");
    const IntersectionResult asked = query_.intersects(pose, {.tests = budget.tests});
    EXPECT_EQ(answer, static_cast<std::int32_t>(asked.answer));
    ASSERT_EQ(name(ist_query_triangle_pairs(c_query_, pose.data(), &budget, nullptr, 0, &c)), "ok");
    const TrianglePairsResult first = query_.triangle_pairs(pose, {}, {.tests = budget.tests});
    EXPECT_EQ(c.pairs, first.triangle_pairs);
    EXPECT_EQ(c.complete, first.complete ? 1 : 0);
    cut = cut || !first.complete;
  }
  EXPECT_TRUE(cut);
  EXPECT_GT(met, 100u);
}

// Arrays with room for all pairs, for some of them and for none.
TEST_F(CAnswers, NearPairsAreThoseOfCpp) {
  constexpr double kMargin = 0.05;
  std::vector<NearPair> pairs(1 << 13);
  std::vector<ist_near_pair> c_pairs(1 << 13);
  std::uint64_t near = 0, cut = 0;
  for (const Eigen::Isometry3d& pose : poses()) {
    for (const std::size_t room : {pairs.size(), std::size_t{7}, std::size_t{0}}) {
      for (const std::uint64_t tests : {std::uint64_t{0}, std::uint64_t{700}}) {
        const ist_budget budget{sizeof budget, tests, 0};
        auto c = sized<ist_near_pairs_result>();
        ASSERT_EQ(name(ist_query_near_pairs(c_query_, pose.data(), kMargin, &budget,
                                            room > 0 ? c_pairs.data() : nullptr, room, &c)),
                  "ok");
        const NearPairsResult wanted =
            tests == 0
                ? query_.near_pairs(pose, kMargin, std::span(pairs).first(room))
                : query_.near_pairs(pose, kMargin, std::span(pairs).first(room), {.tests = tests});
        expect_same(c, wanted);
        EXPECT_EQ(c.truncated, wanted.truncated ? 1 : 0);
        ASSERT_EQ(c.written, std::min<std::uint64_t>(wanted.near_pairs, room));
        for (std::size_t i = 0; i < c.written; ++i) expect_same(c_pairs[i], pairs[i]);
        near += c.written;
        cut += 1 - static_cast<std::uint64_t>(c.complete);
      }
    }
  }
  EXPECT_GT(near, 500u);
  EXPECT_GT(cut, 0u);
}

TEST_F(CAnswers, NearPartsAreThoseOfCpp) {
  std::array<NearPair, Query::kMostNearParts> parts;
  std::array<ist_near_pair, IST_MOST_NEAR_PARTS> c_parts;
  std::uint64_t most = 0;
  for (const Eigen::Isometry3d& pose : poses()) {
    for (std::uint32_t k = 0; k < 20; ++k) {
      const NearPairsResult wanted = query_.near_parts(pose, {k, 3 * k}, 3, parts);
      for (const std::size_t room : {c_parts.size(), std::size_t{2}, std::size_t{0}}) {
        auto c = sized<ist_near_pairs_result>();
        ASSERT_EQ(name(ist_query_near_parts(c_query_, pose.data(), k, 3 * k, 3,
                                            room > 0 ? c_parts.data() : nullptr, room, &c)),
                  "ok");
        expect_same(c, wanted);
        ASSERT_EQ(c.written, std::min<std::uint64_t>(wanted.near_pairs, room));
        EXPECT_EQ(c.truncated, c.written < c.pairs ? 1 : 0);
        for (std::size_t i = 0; i < c.written; ++i) expect_same(c_parts[i], parts[i]);
        most = std::max(most, c.pairs);
      }
    }
  }
  EXPECT_GE(most, 8u);
}

TEST_F(CAnswers, WithoutVoxelsAreThoseOfTriangles) {
  ist_tree* tree = c_tree(mesh_, 0);
  auto info = sized<ist_tree_info>();
  ASSERT_EQ(name(ist_tree_get_info(tree, &info)), "ok");
  EXPECT_EQ(info.voxel_size, 0);
  EXPECT_EQ(info.leaves, 0u);
  EXPECT_EQ(info.depth, 0);
  EXPECT_EQ(info.spheres, IST_SPHERES_DEFAULT);
  EXPECT_EQ(info.triangles, mesh_.triangles.size());
  EXPECT_EQ(info.largest_leaf_radius, 0);
  double centre[3] = {7, 7, 7};
  EXPECT_EQ(name(ist_tree_copy_leaf_centres(tree, centre, 1)), "ok");
  EXPECT_EQ(centre[0], 7);
  ist_query* query = nullptr;
  auto options = sized<ist_query_options>();
  options.spheres = IST_SPHERES_SLAB;
  EXPECT_EQ(name(ist_query_create(tree, tree, &options, &query)), "policy-missing");
  query = c_query(tree);
  auto of_query = sized<ist_query_info>();
  ASSERT_EQ(name(ist_query_get_info(query, &of_query)), "ok");
  EXPECT_EQ(of_query.spheres, IST_SPHERES_DEFAULT);
  EXPECT_EQ(of_query.contacts, 0u);
  EXPECT_EQ(of_query.has_triangles, 1);
  EXPECT_LT(of_query.bytes, query_.bytes());

  for (const Eigen::Isometry3d& pose : poses()) {
    std::int32_t answer = IST_ANSWER_UNKNOWN;
    ASSERT_EQ(name(ist_query_intersects(query, pose.data(), nullptr, &answer)), "ok");
    EXPECT_EQ(answer, static_cast<std::int32_t>(query_.intersects(pose).answer));
    auto distance = sized<ist_distance_result>();
    ASSERT_EQ(name(ist_query_distance(query, pose.data(), 1e-3, nullptr, &distance)), "ok");
    const DistanceInterval wanted = query_.distance(pose, 1e-3).distance;
    EXPECT_LE(distance.lower, wanted.upper);
    EXPECT_GE(distance.upper, wanted.lower);
    auto pairs = sized<ist_triangle_pairs_result>();
    ASSERT_EQ(name(ist_query_triangle_pairs(query, pose.data(), nullptr, nullptr, 0, &pairs)),
              "ok");
    EXPECT_EQ(pairs.pairs, query_.triangle_pairs(pose, {}).triangle_pairs);

    const auto expect_missing = [](ist_status status) {
      EXPECT_EQ(name(status), "voxels-missing");
      EXPECT_EQ(status, IST_VOXELS_MISSING);
      EXPECT_TRUE(std::string(ist_last_error_message()).ends_with("with a voxel_size"))
          << ist_last_error_message();
    };
    auto result = sized<ist_query_result>();
    expect_missing(ist_query_leaf_pairs(query, pose.data(), nullptr, nullptr, 0, &result));
    expect_missing(ist_query_contacts(query, pose.data(), nullptr, nullptr, 0, nullptr, &result));
    auto rows = sized<ist_rows_options>();
    ist_row row;
    rows.questions = IST_ASK_CONTACTS;
    expect_missing(ist_query_rows(query, pose.data(), 1, &rows, &row));
    rows.questions = IST_ASK_LEAF_PAIRS;
    EXPECT_EQ(name(ist_query_rows(query, pose.data(), 1, &rows, &row)), "voxels-missing");
    rows.questions = IST_ASK_INTERSECTS;
    ASSERT_EQ(name(ist_query_rows(query, pose.data(), 1, &rows, &row)), "ok");
    EXPECT_EQ(row.intersects, answer);
  }
  EXPECT_EQ(name(ist_query_free(query)), "ok");
}

TEST(CTrees, TellTheUnitOfTheirFile) {
  const TempDir folder;
  const std::string file = folder.path() / "unit.ist";
  for (std::int32_t unit = 0; unit <= 4; ++unit) {
    const MeshSource source{"ball.stl", 1, static_cast<LengthUnit>(unit)};
    write_tree(build_tree(icosphere(1, 1), {.voxel_size = 0.5, .source = source}), file);
    ist_tree* tree = nullptr;
    ASSERT_EQ(name(ist_tree_load(file.c_str(), nullptr, &tree)), "ok");
    auto info = sized<ist_tree_info>();
    EXPECT_EQ(name(ist_tree_get_info(tree, &info)), "ok");
    EXPECT_EQ(info.unit, unit);
    EXPECT_EQ(name(ist_tree_free(tree)), "ok");
  }
}

TEST(CTrees, TellTheFrameOfTheirFile) {
  const TempDir folder;
  const std::string file = folder.path() / "ball.stl";
  TriangleMesh ball = icosphere(1, 1);
  ball.frame = PatientFrame::kLps;
  write_stl(ball, file);
  ist_mesh* mesh = nullptr;
  ASSERT_EQ(name(ist_mesh_read(file.c_str(), nullptr, &mesh)), "ok");
  auto options = sized<ist_build_options>();
  options.voxel_size = 0.5;
  std::array<ist_tree*, 2> trees{};
  for (const std::int32_t frame : {IST_FRAME_UNKNOWN, IST_FRAME_RAS}) {
    options.frame = frame;
    ist_tree*& tree = trees[frame == IST_FRAME_RAS ? 1 : 0];
    ASSERT_EQ(name(ist_tree_build(mesh, &options, &tree)), "ok");
    auto info = sized<ist_tree_info>();
    EXPECT_EQ(name(ist_tree_get_info(tree, &info)), "ok");
    EXPECT_EQ(info.frame, frame == IST_FRAME_RAS ? IST_FRAME_RAS : IST_FRAME_LPS);
  }
  ist_query* query = nullptr;
  EXPECT_EQ(name(ist_query_create(trees[0], trees[1], nullptr, &query)), "argument-invalid");
  options.frame = 3;
  ist_tree* none = nullptr;
  EXPECT_EQ(name(ist_tree_build(mesh, &options, &none)), "argument-invalid");
  for (ist_tree* tree : trees) EXPECT_EQ(name(ist_tree_free(tree)), "ok");
  EXPECT_EQ(name(ist_mesh_free(mesh)), "ok");
}

}  // namespace
}  // namespace ist::test
