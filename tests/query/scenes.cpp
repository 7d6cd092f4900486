#include "query/scenes.h"

#include <vector>

#include "ist/models/models.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// About x by 3-4-5, so that no face is parallel to one of the other body.
Eigen::Isometry3d turned(const Eigen::Vector3d& translation) {
  Eigen::Matrix3d rotation;
  rotation << 1, 0, 0, 0, 0.6, -0.8, 0, 0.8, 0.6;
  return pose_of(rotation, translation);
}

}  // namespace

const Scene& jaws() {
  static const Scene scene{"jaws", tree_of(make_jaw(Jaw::kUpper, 1), 110),
                           tree_of(make_jaw(Jaw::kLower, 1), 140), shift({0, 0, -0.25})};
  return scene;
}

std::span<const Scene> solids() {
  static const std::vector<Scene> all = [] {
    const TriangleMesh ball = icosphere(3, 1), block = box({-0.9, -0.7, -0.8}, {0.9, 0.7, 0.8});
    std::vector<Scene> made;
    made.push_back({"equal", tree_of(ball, 30), tree_of(block, 27), turned({0.5, 0.25, 0})});
    made.push_back({"coarse in fine", tree_of(ball, 40), tree_of(block, 5), turned({0.5, 0.5, 0})});
    made.push_back({"fine in coarse", tree_of(ball, 4), tree_of(block, 36), turned({0, 0.5, 0.5})});
    return made;
  }();
  return all;
}

const Scene& shells() {
  static const Scene scene = [] {
    const TriangleMesh ball = icosphere(3, 1);
    return Scene{"shells", tree_of(ball, 24), tree_of(ball, 24), shift({0.01, 0.02, 0.005})};
  }();
  return scene;
}

QueryOptions options_of(SpherePolicy policy, const std::string& target, int workers) {
  QueryOptions options;
  options.policy = policy;
  options.target = target;
  options.workers = workers;
  options.period = std::chrono::nanoseconds(0);
  return options;
}

Eigen::Isometry3d near_touch(const TriangleMesh& a, const TriangleMesh& b,
                             const Eigen::Matrix3d& rotation, double gap, Random& random) {
  const Eigen::Vector3d on_a = a.vertices[random.below(a.vertices.size())];
  const Eigen::Vector3d on_b = b.vertices[random.below(b.vertices.size())];
  return pose_of(rotation, on_a - rotation * on_b + gap * random.direction());
}

}  // namespace ist::test
