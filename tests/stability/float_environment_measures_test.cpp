#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "ist/base/pose.h"
#include "ist/haptics.h"
#include "ist/haptics/recording.h"
#include "ist/haptics/servo_callback.h"
#include "ist/measure.h"
#include "ist/measure/pose_rows.h"
#include "ist/models/models.h"
#include "ist/scene.h"
#include "scene/scene_case.h"
#include "stability/float_environment_case.h"
#include "support/effort.h"

namespace ist::test {
namespace {

// In any arithmetic of the caller: built-in shapes, places of a tree, poses, and measures.

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

// It has one unit, so it is asked once.
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
  // Off the centre of the coordinates: there the grid's corner and size would be exact.
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
    ASSERT_TRUE(found.place.has_value());
    for (int i = 0; i < 3; ++i) {
      record.add(found.place->fixed_point[i]);
      record.add(found.place->moving_point[i]);
      record.add(found.normal[i]);
    }
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

// In any arithmetic of the caller: scenes, their ticks, and plans.

constexpr double kMetresPerMillimetre = 1e-3;

void add(Record& record, const Placement& place) {
  for (const double number : to_numbers(place)) record.add(number);
}
void add(Record& record, const Vector6& six) {
  for (const double number : six) record.add(number);
}

class FloatEnvironmentOfAScene : public FloatEnvironmentOfTheCaller {
 protected:
  // The tool begins free of the box, and presses on it 10 ms later.
  const std::filesystem::path file_ = folder_.write(
      "scene.toml",
      replaced(replaced(kSoundScene, "move = [0, 0, 0] }", "move = [0, 0, 11] }"),
               "{ time = 1, move = [0, 0, -4] }", "{ time = 0.02, move = [0, 0, 9] }"));
};

INSTANTIATE_TEST_SUITE_P(Once, FloatEnvironmentOfAScene, ::testing::Values(1.0),
                         [](const auto&) { return std::string("one"); });

TEST_P(FloatEnvironmentOfAScene, ChangesNoSceneThatIsRead) {
  changes_nothing("read_scene", 16, [&](Record& record) {
    const ist::Scene scene = read_scene(file_);
    record.add(*scene.fixed.front().voxel_size);
    record.add(*scene.held.front().voxel_size);
    record.add(scene.rate);
  });
}

TEST_P(FloatEnvironmentOfAScene, ChangesNoPlan) {
  const std::filesystem::path plan = folder_.write(
      "plan.csv", "time,x,y,z,qw,qx,qy,qz\n0,0.1,0.2,0.3,1,0,0,0\n1.5,0.7,0,0,0.9,0.1,0.2,0.3\n");
  changes_nothing("read_script and make_script_device", 500, [&](Record& record) {
    const std::vector<Waypoint> read = read_script(plan, kMetresPerMillimetre);
    for (const Waypoint& waypoint : read) {
      record.add(waypoint.time);
      add(record, waypoint.pose);
    }
    const std::unique_ptr<Device> device = make_script_device(read);
    for (int tick = 0; tick < 5; ++tick) {
      add(record, device->read().value());
      device->write(Vector6::Zero(), 0.3);
    }
  });
}

TEST_P(FloatEnvironmentOfAScene, ChangesNoTick) {
  changes_nothing("build_scene, Simulation::tick and a simulated hand", 5000, [&](Record& record) {
    const BuiltScene built = build_scene(read_scene(file_));
    record.add(built.step_limit);
    for (int number = 0; number < 50; ++number) {
      const Tick tick = built.simulation->tick(built.device->read());
      built.device->write(tick.wrench, built.simulation->dt());
      add(record, tick.device);
      add(record, tick.tool);
      add(record, tick.wrench);
    }
  });
}

// Each tick from the record of one that was made before, and two without a pose or a test.
TEST_P(FloatEnvironmentOfAScene, ChangesNoTickThatIsReplayed) {
  std::vector<RecordedTick> recorded;
  {
    const BuiltScene built = build_scene(read_scene(file_));
    for (std::uint64_t number = 0; number < 40; ++number) {
      const std::optional<Placement> device = built.device->read();
      const Tick tick = built.simulation->tick(device);
      built.device->write(tick.wrench, built.simulation->dt());
      recorded.push_back({.tick = number, .device = device});
    }
  }
  recorded[31].device.reset();
  recorded[35].budget.contacts.tests = 0;
  changes_nothing("replay", 5000, [&](Record& record) {
    const BuiltScene built = build_scene(read_scene(file_));
    for (const RecordedTick& tick : recorded) {
      const TickRecord replayed = replay(tick, *built.simulation);
      record.add(replayed.tick);
      record.add(replayed.dt);
      for (const double number : replayed.device) record.add(number);
      for (const double number : replayed.tool) record.add(number);
      for (const double number : replayed.wrench) record.add(number);
      record.add(replayed.held);
      record.add(replayed.leaf_pairs);
      if (replayed.contacts) record.add(replayed.contacts->sphere_tests);
    }
  });
}

TEST_P(FloatEnvironmentOfAScene, ChangesNoCallOfADriver) {
  changes_nothing("ServoCallback::on_tick", 1000, [&](Record& record) {
    const BuiltScene built = build_scene(read_scene(file_));
    ServoCallbackOptions options;
    options.unit = kMetresPerMillimetre;
    options.sphere_tests = 1'000'000;  // so that no clock counts
    ServoCallback callback(*built.simulation, options);
    ServoCallback::Pose pose = callback.tool();
    std::array<double, 3> force{}, torque{};
    for (int number = 0; number < 20; ++number) {
      static_cast<void>(callback.on_tick(pose, force, torque));
      for (const double each : force) record.add(each);
      for (const double each : torque) record.add(each);
    }
    for (const double each : callback.tool()) record.add(each);
  });
}

TEST_P(FloatEnvironmentOfAScene, ChangesNoPlacement) {
  Placement from, to;
  to.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  to.translation = {0.1, 0.2, 0.3};
  Vector6 motion;
  motion << 0.01, 0.02, 0.03, 0.1, 0.2, 0.3;
  changes_nothing("Placement::moved, motion_between and to_placement", 200, [&](Record& record) {
    add(record, motion_between(from, to));
    add(record, to.moved(motion));
    add(record, to.integrated_fast(motion));
    add(record, to_placement(to_numbers(to.moved(motion))).value());
  });
}

// A tenth of ten is 1, but more than 1 if 0.1 · 10 is rounded up.
TEST_P(FloatEnvironmentOfAScene, ChangesNoQuantile) {
  LatencyHistogram times;
  for (int i = 1; i <= 10; ++i) times.record(std::chrono::microseconds(100 * i));
  changes_nothing("LatencyHistogram::quantile", 8,
                  [&](Record& record) { record.add(times.quantile(0.1).count()); });
}

}  // namespace
}  // namespace ist::test
