// In any arithmetic of the caller: worlds of many bodies, made, moved and asked in it.
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <vector>

#include "ist/query/world/world.h"
#include "stability/float_environment_case.h"

namespace ist::test {
namespace {

class FloatEnvironmentOfAWorld : public FloatEnvironmentOfTheCaller {
 protected:
  // Two bodies that cross, one near them and one far away, in this order.
  void SetUp() override {
    // So oblique that every pose of a pair is rounded; turned by 3-4-5 triangles.
    const auto rolled = [](double sine, double cosine) {
      Eigen::Matrix3d rotation;
      rotation << 1, 0, 0, 0, cosine, -sine, 0, sine, cosine;
      return rotation;
    };
    Eigen::Matrix3d yawed;
    yawed << 0.28, -0.96, 0, 0.96, 0.28, 0, 0, 0, 1;
    poses_[0] = pose_of(yawed, unit_ * Eigen::Vector3d(0.1, -0.7, 3.3));
    poses_[1] = pose_of(rolled(0.6, 0.8) * yawed, unit_ * Eigen::Vector3d(0.9, -0.4, 3.7));
    poses_[2] = pose_of(yawed * rolled(-0.8, 0.6), unit_ * Eigen::Vector3d(-2.2, -0.3, 3.1));
    poses_[3] = pose_of(rolled(0.8, 0.6), unit_ * Eigen::Vector3d(71.3, 0.3, -9.1));
    apart_ = pose_of(rolled(0.6, 0.8), unit_ * Eigen::Vector3d(0.9, 3.7, 3.7));
  }

  // `call` takes a world of these bodies, whose pairs were not looked for yet, and the record.
  template <class Call>
  void changes_no_world(const std::string& name, std::size_t least, const Call& call) const {
    changes_nothing(name, least, [&](Record& record) {
      WorldOptions options;
      options.query.frontier_pairs = 1 << 12;
      options.manifold.points = 8;
      options.reach = unit_;
      World world(options);
      for (std::size_t body = 0; body < poses_.size(); ++body) {
        static_cast<void>(world.add(body % 2 == 0 ? large_ : small_, poses_[body]));
      }
      world.reserve();
      call(world, record);
    });
  }

  static void say(const WorldPair& pair, Record& record) {
    record.add(pair.bodies.a);
    record.add(pair.bodies.b);
    record.add(pair.status);
    record.add(pair.answer);
    record.add(pair.complete);
    record.add(pair.roots);
    record.add(pair.distance);
    record.add(pair.narrowest);
    record.add(pair.resolution);
    record.add(pair.pad);
    record.add(pair.found);
    record.add(pair.written);
    record.add(pair.sphere_tests);
  }
  static void say(const WorldAnswer& answer, Record& record) {
    record.add(answer.status);
    record.add(answer.complete);
    record.add(answer.near_pairs);
    record.add(answer.sphere_tests);
    for (const WorldPair& pair : answer.pairs) say(pair, record);
  }

  const SphereTree large_ = tree(meshes_.a), small_ = tree(meshes_.b);
  std::array<Eigen::Isometry3d, 4> poses_;
  Eigen::Isometry3d apart_;
};

INSTANTIATE_TEST_SUITE_P(Units, FloatEnvironmentOfAWorld, ::testing::Values(1.0, 0x1p-37),
                         [](const auto& unit) { return unit.param == 1 ? "one" : "tiny"; });

TEST_P(FloatEnvironmentOfAWorld, ChangesNoPose) {
  Eigen::Isometry3d bent = poses_[2];  // which is projected
  bent.matrix()(0, 1) += 0x1.23456789abcdep-20;
  changes_no_world("World::pose_of", 500, [&](World& world, Record& record) {
    record.add(world.set_pose(2, bent));
    for (BodyIndex a = 0; a < 3; ++a) {
      for (BodyIndex b = a + 1; b < 4; ++b) {
        const std::optional<Eigen::Isometry3d> pose = world.pose_of(a, b);
        for (Eigen::Index i = 0; i < 4; ++i) {
          record.add(Eigen::Vector3d(pose->matrix().block<3, 1>(0, i)));
        }
      }
    }
  });
}

TEST_P(FloatEnvironmentOfAWorld, ChangesNoMemory) {
  changes_no_world("World::reserve and bytes_needed", 32, [](World& world, Record& record) {
    record.add(world.bytes());
    record.add(world.bytes_needed());
    record.add(world.bytes_needed(2));
    world.reserve(2);
    record.add(world.bytes());
  });
}

TEST_P(FloatEnvironmentOfAWorld, ChangesNoNearPair) {
  changes_no_world("World::ask for near pairs", 60, [&](World& world, Record& record) {
    say(world.ask({}), record);
    record.add(world.set_pose(1, poses_[3]));
    say(world.ask({}), record);
  });
}

TEST_P(FloatEnvironmentOfAWorld, ChangesNoIntersection) {
  changes_no_world("World::ask for intersections", 60, [](World& world, Record& record) {
    say(world.ask({WorldQuestion::kIntersects}), record);
  });
}

TEST_P(FloatEnvironmentOfAWorld, ChangesNoContact) {
  changes_no_world("World::ask for contacts", 400, [](World& world, Record& record) {
    const WorldAnswer answer = world.ask({WorldQuestion::kContacts});
    say(answer, record);
    for (const WorldPair& pair : answer.pairs) {
      for (const Contact& contact : pair.manifold->points()) record.add(contact);
      record.add(pair.manifold->sums().spring.torque);
    }
  });
}

TEST_P(FloatEnvironmentOfAWorld, ChangesNoLeafPair) {
  changes_no_world("World::ask for leaf pairs", 1000, [](World& world, Record& record) {
    std::vector<LeafPair> out(1 << 14);
    const auto answer = world.ask({.kind = WorldQuestion::kLeafPairs, .leaf_pairs = out});
    say(answer, record);
    out.resize(answer.pairs.back().first + answer.pairs.back().written);
    for (const LeafPair& leaves : out) record.add(leaves);
  });
}

TEST_P(FloatEnvironmentOfAWorld, ChangesNoTrianglePair) {
  changes_no_world("World::ask for pairs of triangles", 200, [](World& world, Record& record) {
    std::vector<TrianglePair> out(1 << 14);
    const auto answer = world.ask({.kind = WorldQuestion::kTrianglePairs, .triangle_pairs = out});
    say(answer, record);
    out.resize(answer.pairs.back().first + answer.pairs.back().written);
    for (const TrianglePair& triangles : out) record.add(triangles);
  });
}

TEST_P(FloatEnvironmentOfAWorld, ChangesNoDistance) {
  changes_no_world("World::ask for distances", 100, [](World& world, Record& record) {
    say(world.ask({WorldQuestion::kDistance, 0}), record);
  });
}

TEST_P(FloatEnvironmentOfAWorld, ChangesNoLeastDistance) {
  changes_no_world("World::distance", 300, [&](World& world, Record& record) {
    // First where two bodies cross, and then where all are apart.
    for (const Eigen::Isometry3d& pose : {poses_[1], apart_}) {
      record.add(world.set_pose(1, pose));
      const WorldDistance least = world.distance(0);
      record.add(least.complete);
      record.add(least.distance);
      record.add(least.nearest->a);
      record.add(least.nearest->b);
      record.add(least.sphere_tests);
      for (const WorldPair& pair : least.pairs) say(pair, record);
    }
  });
}

}  // namespace
}  // namespace ist::test
