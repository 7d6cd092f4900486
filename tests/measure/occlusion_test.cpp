#include "ist/measure/occlusion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ist/base/parallel.h"
#include "ist/measure/contact_regions.h"
#include "ist/models/models.h"
#include "measure/body_pair.h"
#include "query/query_cases.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;
using Pose = Eigen::Isometry3d;

struct Bite : BodyPair {
  using BodyPair::BodyPair;
  [[nodiscard]] Occlusion at(const Vector& to, const OcclusionOptions& options = {}) const {
    return occlusion(query, place(to), options);
  }
};

// The part of a sphere of radius `r` whose distance from a sphere of radius `other` is at most
// `level`, their centres `apart`: a cap.
double cap_area(double r, double other, double apart, double level) {
  const double reach = other + level;
  const double along = (apart * apart + r * r - reach * reach) / (2 * apart);
  return 2 * std::numbers::pi * r * std::clamp(r - along, 0.0, 2 * r);
}

// The integral of max(level - distance, 0) over the sphere, by rings.
double integral_below(double r, double other, double apart, double level) {
  constexpr int kRings = 200000;
  double sum = 0;
  for (int k = 0; k < kRings; ++k) {
    const double z = r * (2 * (k + 0.5) / kRings - 1);
    const double distance = std::sqrt(apart * apart + r * r - 2 * apart * z) - other;
    sum += std::max(level - distance, 0.0) * 2 * std::numbers::pi * r * (2 * r / kRings);
  }
  return sum;
}

TEST(Occlusion, OfSpheresComesToItsClosedFormsAsMeshesGetFiner) {
  const double apart = 5.7;
  double last = HUGE_VAL;
  for (const int level : {3, 4, 5}) {
    const Bite bite(icosphere(level, 4), icosphere(level, 2));
    const Occlusion found = bite.at({0, 0, apart}, {.reach = 1, .limits = {0.05, 0.2}});
    ASSERT_TRUE(found.complete);
    double error = 0;
    const auto compare = [&](double measured, double truth) {
      error = std::max(error, std::abs(measured - truth) / truth);
    };
    const auto of_sphere = [&](const SurfaceOcclusion& one, double r, double other) {
      compare(one.areas[0], cap_area(r, other, apart, 0.05));
      compare(one.areas[1], cap_area(r, other, apart, 0.2));
      compare(one.penetrating_area, cap_area(r, other, apart, 0));
      compare(one.depth_integral, integral_below(r, other, apart, 0));
      ASSERT_EQ(one.regions.size(), 1U);
      compare(one.regions[0].area, cap_area(r, other, apart, 0.1));
      compare(one.regions[0].penetrating_area, one.penetrating_area);
      EXPECT_EQ(one.regions[0].partner, 0U);
      EXPECT_EQ(one.regions[0].share, 1);
      EXPECT_NEAR(-one.regions[0].least_distance, 6 - apart, 0.3 / (1 << level));
      double least = HUGE_VAL;
      for (const ContactTriangle& part : one.regions[0].triangles) {
        least = std::min(least, part.least_distance);
        if (part.triangle != one.regions[0].triangle) continue;
        EXPECT_EQ(part.least_distance, one.regions[0].least_distance);
      }
      EXPECT_EQ(least, one.regions[0].least_distance);
      EXPECT_NEAR(one.total_area, 4 * std::numbers::pi * r * r, 4 * r * r / (1 << level));
    };
    of_sphere(found.fixed, 4, 2);
    of_sphere(found.moving, 2, 4);
    EXPECT_LT(error, 0.6 * last) << level;
    last = error;
  }
  EXPECT_LT(last, 0.02);
}

TEST(Occlusion, OfBoxesIsExact) {
  const Bite bite(box({-5, -5, -1}, {5, 5, 0}), box({0, 0, 0}, {1, 2, 1}));
  const Occlusion found = bite.at({0, 0, 0.05}, {.limits = {0.04, 0.06}});
  EXPECT_EQ(found.moving.areas[0], 0);
  EXPECT_NEAR(found.moving.areas[1], 2 + 6 * 0.01, 1e-9) << "the sides' lowest hundredth too";
  EXPECT_EQ(found.moving.penetrating_area, 0);
  ASSERT_EQ(found.moving.regions.size(), 1U);
  EXPECT_NEAR(found.moving.regions[0].least_distance, 0.05, 1e-12);
  EXPECT_NEAR((found.moving.regions[0].centre - Vector(0.5, 1, 0.05)).head<2>().norm(), 0, 1e-9);
  // Into the other: the lower face and what of the sides is below.
  const Occlusion deep = bite.at({0, 0, -0.25});
  EXPECT_NEAR(deep.moving.penetrating_area, 2 + 6 * 0.25, 1e-9);
  EXPECT_NEAR(deep.moving.depth_integral, 2 * 0.25 + 6 * 0.25 * 0.125, 1e-9);
  EXPECT_NEAR(deep.moving.depth_at_vertices, 0.25, 1e-12);
}

TEST(Occlusion, IsTheSameWithoutVoxels) {
  const TriangleMesh a = icosphere(3, 4), b = icosphere(3, 2);
  BodyPair voxels(a, b), alone(a, b, 0);
  const Eigen::Isometry3d pose = place({0.1, 0.2, 5.8});
  const Occlusion found = occlusion(alone.query, pose), wanted = occlusion(voxels.query, pose);
  for (const auto& [one, other] :
       {std::pair(&found.fixed, &wanted.fixed), {&found.moving, &wanted.moving}}) {
    EXPECT_EQ(one->areas, other->areas);
    EXPECT_EQ(one->penetrating_area, other->penetrating_area);
    EXPECT_EQ(one->depth_at_vertices, other->depth_at_vertices);
    EXPECT_EQ(one->regions.size(), other->regions.size());
  }
}

TEST(Occlusion, IsContinuousInThePose) {
  const Bite bite(icosphere(3, 4), icosphere(3, 2));
  double last = -1;
  for (int k = 0; k < 40; ++k) {
    const Occlusion found = bite.at({0.1, 0.2, 6 - 0.005 * k}, {.limits = {0.1}});
    if (last >= 0) {
      EXPECT_GT(found.moving.areas[0], last);
      EXPECT_LT(found.moving.areas[0] - last, 0.15);
    }
    last = found.moving.areas[0];
  }
}

// A body that lies wholly inside another, deeper than the reach: its distances are none, its areas
// and depths are all there.
TEST(Occlusion, CountsWhatIsDeeperThanTheReach) {
  const Bite bite(box({-9, -9, -9}, {9, 9, 9}), box({0, 0, 0}, {1, 1, 1}));
  const Occlusion found = bite.at({0, 0, 0}, {.reach = 0.5});
  for (const SurfaceDistance& one : found.moving.vertices) EXPECT_TRUE(std::isnan(one.distance));
  EXPECT_NEAR(found.moving.penetrating_area, 6, 1e-9);
  EXPECT_NEAR(found.moving.areas[0], 6, 1e-9);
  EXPECT_NEAR(found.moving.depth_at_vertices, 9, 1e-12);
  EXPECT_NEAR(found.moving.depth_integral, 3 * (9 - 2.0 / 3) + 3 * 8, 1e-9);
  EXPECT_EQ(found.fixed.penetrating_area, 0);
  // Half in, half out, by more than the reach either way.
  const Bite long_one(box({-9, -9, -9}, {9, 9, 0}), box({0, 0, -5}, {1, 1, 5}));
  const Occlusion half = long_one.at({0, 0, 0}, {.reach = 0.5});
  EXPECT_NEAR(half.moving.penetrating_area, 1 + 4 * 5, 1e-9);
  EXPECT_NEAR(half.moving.depth_integral, 4 * 12.25 + 4, 0.05)
      << "from 4.5 on the bottom is nearer";
}

// Two bumps over a plate: each has its partner there.
TEST(Occlusion, PairsRegionsThatFaceEachOther) {
  const TriangleMesh bumps =
      joined(moved(icosphere(3, 1), {-3, 0, 0}), moved(icosphere(3, 1), {3, 0, 0.04}));
  const Bite bite(box({-6, -6, -2}, {6, 6, 0}), bumps);
  const Occlusion found = bite.at({0, 0, 0.98});
  ASSERT_EQ(found.moving.regions.size(), 2U);
  ASSERT_EQ(found.fixed.regions.size(), 2U);
  double shares = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const ContactRegion& one = found.moving.regions[k];
    shares += one.share;
    ASSERT_TRUE(one.partner.has_value());
    const ContactRegion& other = found.fixed.regions[*one.partner];
    EXPECT_EQ(other.partner, k);
    EXPECT_LT((other.centre - one.centre).norm(), 0.2);
  }
  EXPECT_NEAR(shares, 1, 1e-12);
  // Triangles are told once each, and make up their regions.
  double pressed = 0, of_second = 0, area = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& triangles = found.moving.regions[k].triangles;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      EXPECT_TRUE(i == 0 || triangles[i - 1].triangle < triangles[i].triangle);
      EXPECT_GE(triangles[i].pressed_thicker, triangles[i].pressed);
      EXPECT_GE(triangles[i].pressed, triangles[i].pressed_thinner);
      pressed += triangles[i].pressed;
      (k == 1 ? of_second : area) += k == 1 ? triangles[i].pressed : triangles[i].area;
    }
  }
  EXPECT_NEAR(of_second / pressed, found.moving.regions[1].share, 1e-12);
  EXPECT_NEAR(area, found.moving.regions[0].area, 1e-12);
  EXPECT_LT(found.moving.regions[0].centre[0], 0) << "the lower one is the larger";
  EXPECT_GT(found.moving.regions[0].share_thinner, found.moving.regions[0].share_thicker);
}

// Regions by their triangles, and the triangles that their closest vertices face.
ContactRegions regions_of(const std::vector<std::vector<std::uint32_t>>& triangles,
                          std::vector<std::uint32_t> nearest) {
  ContactRegions out{{}, std::move(nearest)};
  for (const std::vector<std::uint32_t>& indices : triangles) {
    ContactRegion& region = out.regions.emplace_back();
    for (const std::uint32_t k : indices) region.triangles.push_back({k});
  }
  return out;
}

// The closest vertex of each says which region it faces: the second moving one is faced by none.
TEST(ContactRegions, ArePartnersWhereEachFacesTheOther) {
  ContactRegions fixed = regions_of({{1, 2}, {3}}, {10, 99});
  ContactRegions moving = regions_of({{10, 11}, {12}}, {2, 1});
  pair_regions(fixed, moving);
  EXPECT_EQ(fixed.regions[0].partner, 0U);
  EXPECT_EQ(moving.regions[0].partner, 0U);
  EXPECT_FALSE(fixed.regions[1].partner.has_value()) << "nothing touches where it is nearest";
  EXPECT_FALSE(moving.regions[1].partner.has_value());
  ContactRegions one_way = regions_of({{1}}, {12});
  ContactRegions other = regions_of({{10}, {12}}, {1, 77});
  pair_regions(one_way, other);
  EXPECT_FALSE(one_way.regions[0].partner.has_value());
  EXPECT_FALSE(other.regions[1].partner.has_value());
  EXPECT_EQ(moving.regions[1].faces, 0U) << "which faces another one";
  EXPECT_EQ(one_way.regions[0].faces, 1U);
  EXPECT_EQ(other.regions[0].faces, 0U);
  EXPECT_FALSE(other.regions[1].faces.has_value()) << "nothing touches there";
}

// Two balls in a plate, of which a box holds one.
TEST(Occlusion, CountsWithinABoxAlone) {
  const Bite bite(box({-6, -6, -2}, {6, 6, 0}), joined(moved(icosphere(4, 1), {-3, 0, 0}),
                                                       moved(icosphere(4, 1), {3, 0, -0.05})));
  const Vector to(0, 0, 0.9);
  const Bite one(box({-6, -6, -2}, {6, 6, 0}), moved(icosphere(4, 1), {-3, 0, 0}));
  const Occlusion whole = bite.at(to), alone = one.at(to),
                  part = bite.at(
                      to, {.within = Eigen::AlignedBox3d(Vector(-9, -9, -9), Vector(0, 9, 9))});
  ASSERT_EQ(whole.moving.regions.size(), 2U);
  ASSERT_EQ(part.moving.regions.size(), 1U);
  EXPECT_EQ(part.moving.areas, alone.moving.areas);
  EXPECT_EQ(part.moving.penetrating_area, alone.moving.penetrating_area);
  EXPECT_EQ(part.moving.depth_at_vertices, alone.moving.depth_at_vertices);
  EXPECT_GT(whole.moving.depth_at_vertices, part.moving.depth_at_vertices + 0.04);
  EXPECT_EQ(part.moving.total_area, alone.moving.total_area);
  EXPECT_EQ(part.moving.regions[0].share, 1);
  EXPECT_EQ(part.moving.vertices.size(), whole.moving.vertices.size());
  EXPECT_EQ(error_name([&] { (void)bite.at(to, {.within = Eigen::AlignedBox3d()}); }),
            "argument-invalid");
}

TEST(Occlusion, LeavesOutSmallRegionsAndWhatIsFar) {
  const Bite bite(box({-6, -6, -2}, {6, 6, 0}), icosphere(3, 1));
  EXPECT_TRUE(bite.at({0, 0, 1.05}, {.least_area = 5}).moving.regions.empty());
  const Occlusion apart = bite.at({0, 0, 3.5});
  EXPECT_TRUE(apart.complete);
  EXPECT_TRUE(apart.moving.regions.empty());
  EXPECT_EQ(apart.moving.areas, std::vector<double>(4, 0.0));
  for (const SurfaceDistance& one : apart.moving.vertices) EXPECT_TRUE(std::isnan(one.distance));
}

TEST(Occlusion, OfFarOrLargeBodiesEnds) {
  IST_SLOW();
  const Bite bite(icosphere(2, 1), icosphere(2, 1));
  const Occlusion far = bite.at({1e16, 3e15, 0});
  EXPECT_TRUE(far.complete);
  EXPECT_TRUE(far.moving.regions.empty());
  const Bite nested(box({-1000, -1000, -1000}, {1000, 1000, 1000}),
                    box({-800, -800, -800}, {800, 800, 800}), 100);
  EXPECT_EQ(error_name([&] {
              static_cast<void>(nested.at({0, 0, 0}, {.longest_edge = 0.01}));
            }),
            "memory-limit");
}

// A foundation that is deeper than regions go presses on what they hold alone.
TEST(Occlusion, SharesHangOnRegionsAloneHoweverFineTheyAreSplit) {
  const TriangleMesh bumps =
      joined(moved(icosphere(4, 1), {-3, 0, 0}), moved(icosphere(4, 1), {3, 0, 0.04}));
  const Bite bite(box({-6, -6, -2}, {6, 6, 0}), bumps);
  const auto thicker = [&](double edge) {
    return bite.at({0, 0, 0.98}, {.longest_edge = edge, .change = 0.1})
        .moving.regions[0]
        .share_thicker;
  };
  EXPECT_NEAR(thicker(0.1), thicker(0.05), 2e-4);
  EXPECT_NEAR(thicker(0.05), thicker(0.025), 5e-5);
}

TEST(Occlusion, OfJawsHasTheSameBitsForAnyNumberOfThreadsAndTargets) {
  IST_SLOW();
  const SphereTree upper = build_tree(make_jaw(Jaw::kUpper, 1), {.voxel_size = 1});
  const SphereTree lower = build_tree(make_jaw(Jaw::kLower, 1), {.voxel_size = 1});
  const Query query(upper, lower), plain(upper, lower, {.target = "scalar"});
  const Occlusion all = occlusion(query, Pose::Identity());
  const ScopedThreadLimit one(1);
  const Occlusion single = occlusion(plain, Pose::Identity());
  EXPECT_EQ(all.fixed.areas, single.fixed.areas);
  EXPECT_EQ(all.moving.depth_integral, single.moving.depth_integral);
  ASSERT_EQ(all.moving.regions.size(), single.moving.regions.size());
  EXPECT_GT(all.moving.regions.size(), 4U);
  std::size_t paired = 0;
  for (std::size_t k = 0; k < all.moving.regions.size(); ++k) {
    EXPECT_EQ(all.moving.regions[k].share, single.moving.regions[k].share);
    paired += all.moving.regions[k].partner.has_value();
  }
  EXPECT_GT(paired, all.moving.regions.size() / 2);
  // A finer surface says nearly the same.
  const Occlusion finer = occlusion(query, Pose::Identity(), {.longest_edge = 0.1});
  for (std::size_t i = 0; i < all.fixed.areas.size(); ++i) {
    EXPECT_NEAR(all.fixed.areas[i], finer.fixed.areas[i], 0.01 * finer.fixed.areas[i]);
    EXPECT_NEAR(all.moving.areas[i], finer.moving.areas[i], 0.01 * finer.moving.areas[i]);
  }
}

TEST(Occlusion, EndsWhereItIsToldAndRefusesWhatIsNoQuestion) {
  const Bite bite(box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0}, {1, 1, 1}));
  const Occlusion stopped = bite.at({0, 0, 1}, {.proceed = [](double part) { return part < 0.1; }});
  EXPECT_FALSE(stopped.complete);
  // Wherever it is ended, nothing is left half done.
  int asked = 0;
  EXPECT_TRUE(bite.at({0, 0, 1}, {.proceed =
                                      [&](double part) {
                                        ++asked;
                                        return part >= 0 && part < 1;
                                      }})
                  .complete);
  EXPECT_GE(asked, 4);
  for (int most = 1; most < asked; ++most) {
    int left = most;
    const Occlusion ended = bite.at({0, 0, 1}, {.proceed = [&](double) { return --left > 0; }});
    EXPECT_FALSE(ended.complete);
    EXPECT_TRUE(ended.fixed.vertices.empty());
  }
  EXPECT_TRUE(stopped.moving.vertices.empty());
  const auto name = [&](const OcclusionOptions& options) {
    return error_name([&] { static_cast<void>(bite.at({0, 0, 1}, options)); });
  };
  EXPECT_EQ(name({.reach = 0}), "argument-invalid");
  EXPECT_EQ(name({.reach = HUGE_VAL}), "argument-invalid");
  EXPECT_EQ(name({.limits = {0.1, -1}}), "argument-invalid");
  EXPECT_EQ(name({.contact = std::nan("")}), "argument-invalid");
  EXPECT_EQ(name({.longest_edge = 0}), "argument-invalid");
  EXPECT_EQ(name({.foundation = -1}), "argument-invalid");
  Pose sheared = Pose::Identity();
  sheared(0, 1) = 1;
  EXPECT_EQ(error_name([&] { static_cast<void>(occlusion(bite.query, sheared)); }), "pose-invalid");
}

}  // namespace
}  // namespace ist::test
