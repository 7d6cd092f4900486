#include "peers/turned.h"

#include <numbers>

#include "support/bodies.h"

namespace ist::bench {
namespace {

Eigen::Isometry3d turn(double degrees, const Eigen::Vector3d& axis) {
  return Eigen::Isometry3d(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.normalized()));
}

TriangleMesh turned(TriangleMesh mesh, const Eigen::Isometry3d& by) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = by * vertex;
  return mesh;
}

}  // namespace

TurnedPair turned_pair() {
  const Eigen::Isometry3d fixed = turn(kFixedTurned, {1, 2, 3}),
                          moving = turn(kMovingTurned, {-3, 1, 2});
  TurnedPair pair{turned(upper_jaw(), fixed), turned(lower_jaw(), moving), peer_poses()};
  for (NamedPose& pose : pair.poses) {
    pose.label += ", turned";
    pose.truth.reset();  // which is of the vertices before they were rounded
    pose.pose = fixed * pose.pose * moving.inverse();
  }
  return pair;
}

}  // namespace ist::bench
