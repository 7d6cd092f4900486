// In any arithmetic of the caller: built-in shapes, places of a tree, poses, and measures.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "ist/base/pose.h"
#include "ist/measure.h"
#include "ist/measure/pose_rows.h"
#include "ist/models/models.h"
#include "ist/scene.h"
#include "stability/float_environment_case.h"
#include "support/effort.h"

namespace ist::test {
namespace {

constexpr double kAnyReach = std::numeric_limits<double>::infinity();

void add(Record& record, const Eigen::Isometry3d& pose) {
  for (Eigen::Index column = 0; column < 4; ++column) {
    record.add(Eigen::Vector3d(pose.matrix().block<3, 1>(0, column)));
  }
}
void add(Record& record, const std::vector<SurfaceDistance>& distances) {
  for (const SurfaceDistance& each : distances) {
    record.add(each.distance);
    record.add(each.closest);
    record.add(each.triangle);
    record.add(each.is_signed);
  }
}
void add(Record& record, const SurfaceOcclusion& surface) {
  add(record, surface.vertices);
  record.add(surface.areas);
  record.add(surface.total_area);
  record.add(surface.penetrating_area);
  record.add(surface.depth_integral);
  for (const ContactRegion& region : surface.regions) {
    record.add(region.area);
    record.add(region.centre);
    record.add(region.share);
    record.add(region.closest);
  }
}

// Two closed bodies that cross.
class FloatEnvironmentOfAMeasure : public FloatEnvironmentOfTheCaller {
 protected:
  [[nodiscard]] Eigen::Isometry3d pose(double distance) const {
    Eigen::Matrix3d rotation;
    rotation << 1, 0, 0, 0, 0.6, -0.8, 0, 0.8, 0.6;
    return pose_of(rotation, {distance * unit_, 0, 0.25 * distance * unit_});
  }

  const SphereTree fixed_ = tree(icosphere(2, unit_)), moving_ = tree(icosphere(1, 0.75 * unit_));
};

INSTANTIATE_TEST_SUITE_P(Units, FloatEnvironmentOfAMeasure, ::testing::Values(1.0, 0x1p-20),
                         [](const auto& unit) { return unit.param == 1 ? "one" : "small"; });

TEST_P(FloatEnvironmentOfAMeasure, ChangesNoShape) {
  changes_nothing("make_icosphere and its kin", 1000, [&](Record& record) {
    record.add(make_icosphere(2, 0.7 * unit_).vertices);
    record.add(make_cylinder(5, 0.7 * unit_, 0.3 * unit_).vertices);
    record.add(make_box({-0.1 * unit_, 0, 0}, {0.3 * unit_, unit_, unit_}).vertices);
    record.add(make_fossa(3, 0.7 * unit_, 0.1 * unit_).vertices);
    BuiltInShape shape;
    shape.kind = BuiltInShape::Kind::kCylinder;
    shape.radius = 0.7 * unit_;
    shape.height = 0.3 * unit_;
    record.add(make_shape(shape).vertices);
  });
}

// Of one unit, so asked once.
class FloatEnvironmentOfAJaw : public FloatEnvironmentOfTheCaller {};

INSTANTIATE_TEST_SUITE_P(Once, FloatEnvironmentOfAJaw, ::testing::Values(1.0),
                         [](const auto&) { return std::string("one"); });

TEST_P(FloatEnvironmentOfAJaw, ChangesNoJaw) {
  changes_nothing("make_jaw", 1'000'000,
                  [](Record& record) { record.add(make_jaw(Jaw::kLower, 7).vertices); });
}

TEST_P(FloatEnvironmentOfAJaw, ChangesNoSplint) {
  IST_SLOW();
  changes_nothing("make_splint", 100'000,
                  [](Record& record) { record.add(make_splint(3, 5.3).vertices); });
}

TEST_P(FloatEnvironmentOfAMeasure, ChangesNoPlaceOfATree) {
  // Not in the middle of the coordinates, where the grid's corner and size would be exact.
  const SphereTree aside =
      tree(moved(icosphere(1, 0.7 * unit_), unit_ * Eigen::Vector3d(0.1, 7, 3)));
  changes_nothing("SphereTree::leaf_centres and its kin", 1000, [&](Record& record) {
    record.add(aside.origin());
    record.add(fixed_.leaf_centres());
    record.add(fixed_.origin());
    record.add(fixed_.bounding_radius());
    for (const SpherePolicy policy : kSpherePolicies)
      record.add(fixed_.largest_leaf_radius(policy));
  });
}

TEST_P(FloatEnvironmentOfAMeasure, ChangesNoPoseThatIsComposed) {
  const Eigen::Isometry3d a = pose(0.1), b = pose(0.7);
  changes_nothing("compose_rigid", 96,
                  [&](Record& record) { add(record, compose_rigid(a, b).value()); });
}

TEST_P(FloatEnvironmentOfAMeasure, ChangesNoMotion) {
  const Eigen::Isometry3d from = pose(0.1);
  Eigen::Isometry3d to = pose(0.7);
  to.linear().col(0).swap(to.linear().col(1));
  to.linear().col(2) *= -1;
  const std::vector<Eigen::Vector3d> points = {{0.1, 0.2, 0.3}, {-1, 0, 2}};
  changes_nothing("Motion", 96, [&](Record& record) {
    for (const Motion& motion :
         {Motion::between(from, to), Motion::screw(from, {1, 2, 3}, {0.1, 0.2, 0.3}, 7, 0.3)}) {
      for (const double parameter : {0.0, 0.1, 0.7, 1.0}) add(record, motion.at(parameter));
      record.add(motion.longest_way(points));
    }
  });
}

TEST_P(FloatEnvironmentOfAMeasure, ChangesNoSignedDistance) {
  changes_nothing("signed_distance and distance_map", 1000, [&](Record& record) {
    add(record, signed_distance(fixed_, moving_.triangles()->vertices, kAnyReach));
    add(record, distance_map(moving_, fixed_, pose(0.9), unit_));
  });
}

TEST_P(FloatEnvironmentOfAMeasure, ChangesNoDepth) {
  changes_nothing("penetration", 72, [&](Record& record) {
    Query query(fixed_, moving_);
    const Penetration depth = penetration(query, pose(0.9), 0.01 * unit_);
    record.add(depth.status);
    record.add(depth.lower);
    record.add(depth.upper);
    record.add(depth.point);
    record.add(depth.direction);
    record.add(depth.triangle);
    record.add(depth.points);
  });
}

TEST_P(FloatEnvironmentOfAMeasure, ChangesNoFirstContact) {
  changes_nothing("first_contact", 40, [&](Record& record) {
    Query query(fixed_, moving_);
    const FirstContact found = first_contact(query, pose(3), pose(0.5), 1e-3 * unit_);
    record.add(found.status);
    record.add(found.lower);
    record.add(found.upper);
    record.add(found.distance);
    record.add(found.distances);
  });
}

// All questions at several poses, and how much of them is done before the first and the second
// slice of them.
TEST_P(FloatEnvironmentOfAMeasure, ChangesNoRow) {
  const std::vector<Eigen::Isometry3d> poses = {pose(0),   pose(0.5), pose(0.9), pose(1.5),
                                                pose(1.7), pose(2),   pose(3)};
  const RowQuestions questions{.intersects = true,
                               .leaf_pairs = true,
                               .distance = true,
                               .contacts = true,
                               .penetration = true,
                               .tolerance = 0.01 * unit_};
  for (const std::size_t threads : {1U, 2U}) {
    changes_nothing(fmt::format("answer_rows, threads: {}", threads), 500, [&](Record& record) {
      Query query(fixed_, moving_);
      std::vector<PoseRow> rows(poses.size());
      std::vector<double> parts;
      EXPECT_TRUE(answer_rows(
          {query, {}, {}}, poses, questions, threads,
          [&](std::size_t i, const PoseRow& row) { rows[i] = row; },
          [&](double part) {
            parts.push_back(part);
            return true;
          }));
      for (const PoseRow& row : rows) {
        record.add(row.intersects->answer);
        record.add(row.leaf_pairs->leaf_pairs);
        record.add(row.distance->distance);
        record.add(row.contacts->sphere_tests);
        record.add(row.sums.weight);
        record.add(row.sums.spring.torque);
        record.add(row.penetration->lower);
        record.add(row.penetration->upper);
      }
      parts.resize(threads == 1 ? 2 : 1);
      record.add(parts);
    });
  }
}

TEST_P(FloatEnvironmentOfAMeasure, ChangesNoOcclusion) {
  changes_nothing("occlusion", 1000, [&](Record& record) {
    const Query query(fixed_, moving_);
    OcclusionOptions options;
    options.reach = unit_;
    options.limits = {0.05 * unit_, 0.1 * unit_};
    options.contact = 0.1 * unit_;
    options.longest_edge = 0.2 * unit_;
    const Occlusion found = occlusion(query, pose(0.9), options);
    add(record, found.fixed);
    add(record, found.moving);
  });
}

}  // namespace
}  // namespace ist::test
