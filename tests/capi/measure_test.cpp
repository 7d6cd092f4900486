#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "c_bodies.h"
#include "ist/capi/ist_measure.h"
#include "ist/measure/comparison.h"
#include "ist/measure/escape.h"
#include "ist/measure/first_contact.h"
#include "ist/measure/occlusion.h"
#include "ist/measure/penetration.h"
#include "ist/measure/settle.h"
#include "ist/models/models.h"
#include "listener.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

std::array<double, 16> down_by(double x, double y, double z) {
  return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1};
}

int32_t stop(void* user, double part) {
  EXPECT_GE(part, 0);
  EXPECT_LE(part, 1);
  ++*static_cast<int*>(user);
  return 1;
}

class CMeasure : public ::testing::Test {
 protected:
  CMeasure() { EXPECT_EQ(name(ist_query_create(fixed_, moving_, nullptr, &query_)), "ok"); }
  ~CMeasure() override {
    EXPECT_EQ(name(ist_query_free(query_)), "ok");
    EXPECT_EQ(name(ist_tree_free(fixed_)), "ok");
    EXPECT_EQ(name(ist_tree_free(moving_)), "ok");
  }
  // What C++ answers.
  const SphereTree fixed_tree_ = build_tree(icosphere(4, 4), {.voxel_size = 0.5});
  const SphereTree moving_tree_ = build_tree(icosphere(3, 2), {.voxel_size = 0.5});
  Query cpp_{fixed_tree_, moving_tree_};
  ist_tree* fixed_ = c_tree(icosphere(4, 4), 0.5);
  ist_tree* moving_ = c_tree(icosphere(3, 2), 0.5);
  ist_query* query_ = nullptr;
};

TEST_F(CMeasure, SignedDistancesAreThoseOfCpp) {
  const std::vector<double> points = {0, 0, 5, 1, 2, 3, 0, 0, 3.5, 9, 9, 9};
  std::vector<Eigen::Vector3d> at;
  for (std::size_t i = 0; i < points.size(); i += 3) {
    at.emplace_back(points[i], points[i + 1], points[i + 2]);
  }
  const auto wanted = signed_distance(fixed_tree_, at, 2);
  std::vector<ist_surface_distance> found(4);
  ASSERT_EQ(name(ist_tree_signed_distance(fixed_, points.data(), 4, 2, nullptr, found.data())),
            "ok");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found[i].distance, wanted[i].distance);
    EXPECT_EQ(found[i].triangle, wanted[i].triangle);
    EXPECT_EQ(found[i].is_signed, 1);
    EXPECT_EQ(found[i].closest[2], wanted[i].closest[2]);
  }
  EXPECT_TRUE(std::isnan(found[3].distance));
  EXPECT_EQ(found[3].triangle, IST_NO_TRIANGLE);
  EXPECT_EQ(name(ist_tree_signed_distance(fixed_, points.data(), 4, 0, nullptr, found.data())),
            "argument-invalid");
  EXPECT_EQ(name(ist_tree_signed_distance(fixed_, nullptr, 4, 1, nullptr, found.data())),
            "null-argument");
  EXPECT_EQ(name(ist_tree_signed_distance(fixed_, nullptr, 0, 1, nullptr, nullptr)), "ok");
}

TEST_F(CMeasure, ADistanceMapFillsWhatThereIsRoomFor) {
  const auto pose = down_by(0, 0, 5.8);
  std::vector<ist_surface_distance> found(10);
  uint64_t vertices = 0;
  ASSERT_EQ(name(ist_tree_distance_map(moving_, fixed_, pose.data(), 50, nullptr, found.data(),
                                       found.size(), &vertices)),
            "ok");
  const auto wanted = distance_map(moving_tree_, fixed_tree_,
                                   Eigen::Isometry3d(Eigen::Translation3d(0, 0, 5.8)), 50);
  EXPECT_EQ(vertices, wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].distance, wanted[i].distance);
  int reports = 0;
  const auto progress = sized<ist_progress>({0, stop, &reports});
  EXPECT_EQ(name(ist_tree_distance_map(moving_, fixed_, pose.data(), 50, &progress, found.data(),
                                       10, &vertices)),
            "cancelled");
  EXPECT_EQ(vertices, 0U);
}

TEST_F(CMeasure, PenetrationIsThatOfCppAndGoesOnFromTheLast) {
  const auto pose = down_by(0.3, 0, 5.5);
  auto result = sized<ist_penetration>();
  ASSERT_EQ(
      name(ist_query_penetration(query_, pose.data(), 1e-3, nullptr, nullptr, nullptr, &result)),
      "ok");
  const Penetration wanted =
      penetration(cpp_, Eigen::Isometry3d(Eigen::Translation3d(0.3, 0, 5.5)), 1e-3);
  EXPECT_EQ(result.lower, wanted.lower);
  EXPECT_EQ(result.upper, wanted.upper);
  EXPECT_EQ(result.points, wanted.points);
  EXPECT_EQ(result.complete, 1);
  EXPECT_EQ(result.not_closed, IST_CLOSED);
  EXPECT_EQ(result.point[2], wanted.point[2]);
  // Into the same struct.
  ASSERT_EQ(
      name(ist_query_penetration(query_, pose.data(), 1e-3, &result, nullptr, nullptr, &result)),
      "ok");
  EXPECT_LE(result.lower, wanted.upper);
  EXPECT_GE(result.upper, wanted.lower);
  const auto few = sized<ist_budget>({0, 5, 0});
  ASSERT_EQ(name(ist_query_penetration(query_, pose.data(), 1e-3, nullptr, &few, nullptr, &result)),
            "ok");
  EXPECT_EQ(result.complete, 0);
  EXPECT_GE(result.upper, wanted.lower);
  EXPECT_EQ(
      name(ist_query_penetration(query_, pose.data(), -1, nullptr, nullptr, nullptr, &result)),
      "argument-invalid");
  EXPECT_EQ(result.upper, 0);
  auto strange = sized<ist_penetration>();
  strange.struct_size = 7;
  result.lower = result.upper = 9;
  EXPECT_EQ(
      name(ist_query_penetration(query_, pose.data(), 1, &strange, nullptr, nullptr, &result)),
      "struct-size");
  EXPECT_EQ(result.lower, 0);
  EXPECT_EQ(result.upper, 0);
  ist_query* open = c_query(c_tree(open_strip(3), 0.5));
  ASSERT_EQ(name(ist_query_penetration(open, pose.data(), 1, nullptr, nullptr, nullptr, &result)),
            "ok");
  EXPECT_EQ(result.not_closed, IST_FIXED_NOT_CLOSED);
  EXPECT_TRUE(std::isnan(result.lower) && std::isnan(result.upper));
  EXPECT_EQ(name(ist_query_free(open)), "ok");
}

// Saved trees keep the balls.
TEST_F(CMeasure, PreparedBodiesHaveTheSameDepth) {
  const auto pose = down_by(0, 0, 1.25);
  ist_tree *large = c_tree(icosphere(3, 1), 0.5), *small = c_tree(icosphere(3, 0.5), 0.5);
  const auto is_prepared = [](const ist_tree* tree) {
    auto info = sized<ist_tree_info>();
    EXPECT_EQ(name(ist_tree_get_info(tree, &info)), "ok");
    return info.prepared_for_depth;
  };
  auto before = sized<ist_penetration>(), after = sized<ist_penetration>();
  const auto ask = [&](ist_penetration& result) {
    ist_query* query = nullptr;
    EXPECT_EQ(name(ist_query_create(large, small, nullptr, &query)), "ok");
    EXPECT_EQ(
        name(ist_query_penetration(query, pose.data(), 1e-4, nullptr, nullptr, nullptr, &result)),
        "ok");
    EXPECT_EQ(name(ist_query_free(query)), "ok");
  };
  ask(before);
  EXPECT_EQ(name(ist_tree_prepare_depth(large, 100, nullptr)), "memory-limit");
  int reports = 0;
  const auto progress = sized<ist_progress>({0, stop, &reports});
  EXPECT_EQ(name(ist_tree_prepare_depth(large, 0, &progress)), "cancelled");
  EXPECT_EQ(is_prepared(large), 0);
  for (const ist_tree* tree : {large, small}) {
    EXPECT_EQ(name(ist_tree_prepare_depth(tree, 0, nullptr)), "ok");
    EXPECT_EQ(is_prepared(tree), 1);
  }
  ask(after);
  EXPECT_EQ(after.complete, 1);
  EXPECT_GT(after.lower, 0.2);
  EXPECT_LE(before.lower, after.upper);
  EXPECT_LE(after.lower, before.upper);
  EXPECT_LT(after.points, before.points);
  EXPECT_EQ(name(ist_tree_prepare_depth(nullptr, 0, nullptr)), "null-argument");
}

TEST_F(CMeasure, ASurfaceThatIntersectsItself_SaysSo) {
  const TriangleMesh two = joined(box({0, 0, 0}, {2, 2, 2}), box({1.5, 0.5, 0.5}, {3.5, 1.5, 1.5}));
  ist_tree* tree = c_tree(two, 0.5);
  std::uint64_t pairs = 0;
  ASSERT_EQ(name(ist_tree_self_intersections(tree, &pairs)), "ok");
  EXPECT_EQ(pairs, build_tree(two, {.voxel_size = 0.5}).self_intersections());
  EXPECT_GT(pairs, 0u);
  const double point[] = {1.75, 1, 1};
  ist_surface_distance found;
  ASSERT_EQ(name(ist_tree_signed_distance(tree, point, 1, INFINITY, nullptr, &found)), "ok");
  EXPECT_EQ(found.distance, -0.25);
  EXPECT_EQ(found.is_signed, 1);
  EXPECT_EQ(found.self_intersecting, 1);
  ist_tree* small = c_tree(moved(icosphere(1, 0.1), {1.75, 1, 1}), 0.05);
  ist_query* query = nullptr;
  ASSERT_EQ(name(ist_query_create(tree, small, nullptr, &query)), "ok");
  auto depth = sized<ist_penetration>();
  const auto pose = down_by(0, 0, 0);
  ASSERT_EQ(
      name(ist_query_penetration(query, pose.data(), 0.01, nullptr, nullptr, nullptr, &depth)),
      "ok");
  EXPECT_NEAR(depth.lower, 0.25, 0.11);
  EXPECT_EQ(depth.self_intersecting, IST_FIXED_SELF_INTERSECTING);
  auto options = sized<ist_rows_options>();
  options.questions = IST_ASK_PENETRATION;
  options.tolerance = 0.01;
  ist_row row;
  ASSERT_EQ(name(ist_query_rows(query, pose.data(), 1, &options, &row)), "ok");
  EXPECT_EQ(row.self_intersecting, IST_FIXED_SELF_INTERSECTING);
  EXPECT_EQ(name(ist_query_free(query)), "ok");
  EXPECT_EQ(name(ist_tree_free(small)), "ok");
  EXPECT_EQ(name(ist_tree_free(tree)), "ok");
}

TEST_F(CMeasure, FirstContactIsThatOfCpp) {
  const auto from = down_by(0, 0, 12), to = down_by(0, 0, 0);
  auto motion = sized<ist_motion>();
  motion.from = from.data();
  motion.to = to.data();
  auto result = sized<ist_first_contact>();
  ASSERT_EQ(name(ist_query_first_contact(query_, &motion, 1e-4, nullptr, nullptr, &result)), "ok");
  const FirstContact wanted = first_contact(cpp_, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 12)),
                                            Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0)), 1e-4);
  EXPECT_EQ(result.outcome, IST_FIRST_CONTACT);
  EXPECT_EQ(result.lower, wanted.lower);
  EXPECT_EQ(result.upper, wanted.upper);
  EXPECT_EQ(result.passes, wanted.passes ? 1 : 0);
  EXPECT_EQ(result.triangles_known, 1);
  EXPECT_EQ(result.moving, wanted.triangles->moving);
  ASSERT_TRUE(wanted.place.has_value());
  EXPECT_EQ(result.place_known, 1);
  EXPECT_EQ(result.place_triangles[0], wanted.place->triangles.fixed);
  EXPECT_EQ(result.place_triangles[1], wanted.place->triangles.moving);
  EXPECT_EQ(Eigen::Vector3d(result.place_fixed), wanted.place->fixed_point);
  EXPECT_EQ(Eigen::Vector3d(result.place_moving), wanted.place->moving_point);
  EXPECT_EQ(Eigen::Vector3d(result.normal), wanted.normal);
  // Away from the other body.
  const auto away = down_by(0, 0, 30);
  motion.to = away.data();
  ASSERT_EQ(name(ist_query_first_contact(query_, &motion, 1e-4, nullptr, nullptr, &result)), "ok");
  EXPECT_EQ(result.place_known, 0);
  EXPECT_EQ(Eigen::Vector3d(result.normal), Eigen::Vector3d(0, 0, 0));
  // A screw, and one that is stopped.
  motion.to = nullptr;
  EXPECT_EQ(name(ist_query_first_contact(query_, &motion, 1e-4, nullptr, nullptr, &result)),
            "argument-invalid")
      << "a direction without a length";
  motion.direction[2] = 1;
  motion.along = -12;
  motion.angle = 7;
  ASSERT_EQ(name(ist_query_first_contact(query_, &motion, 1e-4, nullptr, nullptr, &result)), "ok");
  EXPECT_EQ(result.outcome, IST_FIRST_CONTACT);
  int reports = 0;
  const auto progress = sized<ist_progress>({0, stop, &reports});
  ASSERT_EQ(name(ist_query_first_contact(query_, &motion, 1e-4, nullptr, &progress, &result)),
            "cancelled");
  EXPECT_EQ(result.outcome, IST_FIRST_UNKNOWN);
  motion.from = nullptr;
  EXPECT_EQ(name(ist_query_first_contact(query_, &motion, 1e-4, nullptr, nullptr, &result)),
            "null-argument");
  EXPECT_EQ(result.outcome, IST_FIRST_UNKNOWN);
}

TEST_F(CMeasure, EscapeIsThatOfCpp) {
  const auto pose = down_by(3, 0, 4);
  auto result = sized<ist_escape>();
  ASSERT_EQ(name(ist_query_escape(query_, pose.data(), 0.01, INFINITY, nullptr, &result)), "ok");
  const Escape wanted =
      escape(cpp_, Eigen::Isometry3d(Eigen::Translation3d(3, 0, 4)), {.tolerance = 0.01});
  EXPECT_EQ(result.status, IST_ESCAPE_FOUND);
  EXPECT_EQ(std::memcmp(result.pose, wanted.pose().matrix().data(), sizeof result.pose), 0);
  EXPECT_EQ(std::memcmp(result.motion, wanted.motion().matrix().data(), sizeof result.motion), 0);
  EXPECT_EQ(result.lower, wanted.lower);
  EXPECT_EQ(result.upper, wanted.upper);
  EXPECT_EQ(result.verdicts, wanted.verdicts);
  EXPECT_GT(result.lower, 0.9);
  std::array<double, 16> freed{};
  std::copy_n(result.pose, 16, freed.begin());
  ASSERT_EQ(name(ist_query_escape(query_, freed.data(), 0, INFINITY, nullptr, &result)), "ok");
  EXPECT_EQ(result.status, IST_ESCAPE_NOT_NEEDED);
  EXPECT_EQ(result.upper, 0);
  ASSERT_EQ(name(ist_query_escape(query_, pose.data(), 0, 0.5, nullptr, &result)), "ok");
  EXPECT_EQ(result.status, IST_ESCAPE_NOT_FOUND);
  EXPECT_EQ(result.upper, HUGE_VAL);
  int reports = 0;
  const auto progress = sized<ist_progress>({0, stop, &reports});
  EXPECT_EQ(name(ist_query_escape(query_, pose.data(), 0, INFINITY, &progress, &result)),
            "cancelled");
  EXPECT_EQ(result.status, IST_ESCAPE_UNKNOWN);
  for (const double bad : {-1.0, std::nan("")}) {
    EXPECT_EQ(name(ist_query_escape(query_, pose.data(), bad, INFINITY, nullptr, &result)),
              "argument-invalid");
    EXPECT_EQ(name(ist_query_escape(query_, pose.data(), 0, bad, nullptr, &result)),
              "argument-invalid");
  }
  const std::array<double, 16> no_pose{};
  EXPECT_EQ(name(ist_query_escape(query_, no_pose.data(), 0, 1, nullptr, &result)), "pose-invalid");
}

TEST_F(CMeasure, SettleIsThatOfCpp) {
  const auto pose = down_by(0.3, 0, 6.5);
  auto options = sized<ist_settle_options>();
  options.closing[2] = -1;
  options.has_load_point = 1;
  options.held = IST_HOLD_X | IST_HOLD_Y | IST_HOLD_YAW;
  auto result = sized<ist_settlement>();
  std::vector<ist_settle_contact> contacts(2);
  ASSERT_EQ(name(ist_query_settle(query_, pose.data(), &options, nullptr, contacts.data(),
                                  contacts.size(), &result)),
            "ok");
  SettleOptions same;
  same.closing = {0, 0, -1};
  same.load_point = Eigen::Vector3d(0, 0, 0);
  same.held = {true, true, false, false, false, true};
  const Settlement wanted =
      settle(cpp_, Eigen::Isometry3d(Eigen::Translation3d(0.3, 0, 6.5)), same);
  ASSERT_FALSE(wanted.contacts.empty());
  EXPECT_EQ(result.is_free, 1);
  EXPECT_EQ(std::memcmp(result.pose, wanted.pose().matrix().data(), sizeof result.pose), 0);
  EXPECT_EQ(result.moved[0], 0);
  EXPECT_EQ(result.closed, wanted.closed);
  EXPECT_EQ(result.remaining, wanted.remaining);
  EXPECT_EQ(result.residual, wanted.residual);
  EXPECT_EQ(result.levels, static_cast<int32_t>(wanted.level.size()));
  EXPECT_EQ(result.contacts, wanted.contacts.size());
  EXPECT_EQ(contacts[0].force, wanted.contacts[0].force);
  EXPECT_EQ(contacts[0].fixed, wanted.contacts[0].triangles.fixed);
  EXPECT_EQ(result.load_guessed, 0);
  EXPECT_EQ(result.unit_guessed, 1);
  const auto far = down_by(0, 0, 60);
  ASSERT_EQ(name(ist_query_settle(query_, far.data(), &options, nullptr, nullptr, 0, &result)),
            "ok");
  EXPECT_EQ(result.status, IST_SETTLE_LEFT_THE_BOX);
  int reports = 0;
  const auto progress = sized<ist_progress>({0, stop, &reports});
  EXPECT_EQ(name(ist_query_settle(query_, pose.data(), &options, &progress, nullptr, 0, &result)),
            "cancelled");
  EXPECT_EQ(result.status, IST_SETTLE_UNKNOWN);
  options.held = 64;
  EXPECT_EQ(name(ist_query_settle(query_, pose.data(), &options, nullptr, nullptr, 0, &result)),
            "argument-invalid");
  options.held = IST_HOLD_Z;
  EXPECT_EQ(name(ist_query_settle(query_, pose.data(), &options, nullptr, nullptr, 0, &result)),
            "argument-invalid");
}

TEST_F(CMeasure, OcclusionIsThatOfCppInArraysOfTheCaller) {
  const auto pose = down_by(0, 0, 5.7);
  const std::vector<double> limits = {0.05, 0.2};
  auto options = sized<ist_occlusion_options>();
  options.limits = limits.data();
  options.limit_count = limits.size();
  std::vector<ist_surface_distance> distances(7);
  std::vector<ist_contact_region> regions(3);
  std::vector<double> areas(2);
  auto arrays = sized<ist_occlusion_arrays>();
  arrays.distances = distances.data();
  arrays.distance_capacity = distances.size();
  arrays.regions = regions.data();
  arrays.region_capacity = regions.size();
  arrays.areas = areas.data();
  auto fixed = sized<ist_occlusion>(), moving = sized<ist_occlusion>();
  ASSERT_EQ(name(ist_query_occlusion(query_, pose.data(), &options, nullptr, nullptr, &arrays,
                                     &fixed, &moving)),
            "ok")
      << ist_last_error_message();
  const Occlusion wanted =
      occlusion(cpp_, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 5.7)), {.limits = limits});
  EXPECT_EQ(areas, wanted.moving.areas);
  EXPECT_EQ(moving.regions, wanted.moving.regions.size());
  EXPECT_EQ(moving.vertices, wanted.moving.vertices.size());
  EXPECT_EQ(fixed.penetrating_area, wanted.fixed.penetrating_area);
  ASSERT_EQ(moving.regions, 1U);
  EXPECT_EQ(regions[0].area, wanted.moving.regions[0].area);
  EXPECT_EQ(regions[0].partner, 0);
  EXPECT_EQ(regions[0].centre[2], wanted.moving.regions[0].centre[2]);
  EXPECT_EQ(std::isnan(distances[0].distance), std::isnan(wanted.moving.vertices[0].distance));
  int reports = 0;
  const auto progress = sized<ist_progress>({0, stop, &reports});
  EXPECT_EQ(name(ist_query_occlusion(query_, pose.data(), nullptr, &progress, nullptr, nullptr,
                                     &fixed, &moving)),
            "cancelled");
  EXPECT_EQ(moving.vertices, 0U);
  options.contact = std::nan("");
  EXPECT_EQ(name(ist_query_occlusion(query_, pose.data(), &options, nullptr, nullptr, nullptr,
                                     &fixed, &moving)),
            "argument-invalid");
  EXPECT_EQ(name(ist_query_occlusion(query_, pose.data(), nullptr, nullptr, nullptr, nullptr,
                                     nullptr, &moving)),
            "null-argument");
}

TEST(CComparison, MotionIsThatOfCpp) {
  const auto before = down_by(1, 2, 3);
  const Eigen::Isometry3d first(Eigen::Translation3d(1, 2, 3));
  const Eigen::Isometry3d last =
      Eigen::Translation3d(0, 1, -2) * Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 2) / 3);
  const double about[3] = {5, -4, 7};
  auto result = sized<ist_pose_change>();
  ASSERT_EQ(name(ist_motion_between(before.data(), last.data(), about, &result)), "ok");
  const PoseChange wanted = pose_change(first, last, {5, -4, 7});
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(result.about[i], about[i]);
    EXPECT_EQ(result.translation[i], wanted.translation[i]);
    EXPECT_EQ(result.rotation[i], wanted.rotation[i]);
    EXPECT_EQ(result.axis[i], wanted.axis[i]);
    EXPECT_EQ(result.axis_point[i], (*wanted.axis_point)[i]);
  }
  EXPECT_EQ(result.angle, wanted.angle);
  EXPECT_EQ(result.along, wanted.along);
  EXPECT_EQ(result.turns, 1);
  EXPECT_EQ(result.rotation_error, wanted.rotation_error);
  ASSERT_EQ(name(ist_motion_between(before.data(), before.data(), about, &result)), "ok");
  EXPECT_EQ(result.turns, 0);
  EXPECT_EQ(result.axis_point[0], 0);
  const double nowhere[3] = {0, std::nan(""), 0};
  EXPECT_EQ(name(ist_motion_between(before.data(), last.data(), nowhere, &result)),
            "argument-invalid");
  EXPECT_EQ(result.about[0], 0);
  const auto zero = std::array<double, 16>{};
  EXPECT_EQ(name(ist_motion_between(before.data(), zero.data(), about, &result)), "pose-invalid");
}

TEST(CComparison, MatchesAreThoseOfCpp) {
  const ist_placed_contact before[] = {{{0, 0, 0}, 16, 0}, {{9, 0, 0}, 0, 0}, {{20, 0, 0}, 0, 0}};
  const ist_placed_contact after[] = {{{0.1, 0, 0}, 17, 0}, {{9.5, 0, 0}, 3, 0}};
  std::vector<int32_t> matches(3, 7);
  ASSERT_EQ(name(ist_match_contacts(before, 3, after, 2, 2, matches.data())), "ok");
  EXPECT_EQ(matches, (std::vector<int32_t>{-1, 1, -1}));
  ASSERT_EQ(name(ist_match_contacts(before, 3, nullptr, 0, 2, matches.data())), "ok");
  EXPECT_EQ(matches, (std::vector<int32_t>{-1, -1, -1}));
  EXPECT_EQ(name(ist_match_contacts(nullptr, 0, after, 2, 2, nullptr)), "ok");
  EXPECT_EQ(name(ist_match_contacts(before, 3, after, 2, -1, matches.data())), "argument-invalid");
  EXPECT_EQ(name(ist_match_contacts(before, 3, after, 2, std::nan(""), matches.data())),
            "argument-invalid");
  const ist_placed_contact bad[] = {{{0, HUGE_VAL, 0}, 0, 0}};
  EXPECT_EQ(name(ist_match_contacts(bad, 1, after, 2, 2, matches.data())), "argument-invalid");
}

TEST_F(CMeasure, EndsMidwayToo) {
  std::vector<ist_surface_distance> found;
  expect_ends_midway([&](std::size_t work, const ist_progress* progress) {
    const std::vector<double> points(3 * 50'000 * work, 0.5);
    found.resize(50'000 * work);
    found[0].triangle = 77;
    return ist_tree_signed_distance(fixed_, points.data(), found.size(), 9, progress, found.data());
  });
  EXPECT_EQ(found[0].triangle, 77U);

  const auto pose = down_by(0, 0, 5.7);
  auto options = sized<ist_occlusion_options>();
  auto fixed = sized<ist_occlusion>(), moving = sized<ist_occlusion>();
  expect_ends_midway([&](std::size_t work, const ist_progress* progress) {
    options.longest_edge =
        0.05 / std::sqrt(static_cast<double>(work));  // as many times the triangles
    return ist_query_occlusion(query_, pose.data(), &options, progress, nullptr, nullptr, &fixed,
                               &moving);
  });
  EXPECT_EQ(fixed.vertices, 0U);
}

}  // namespace
}  // namespace ist::test
