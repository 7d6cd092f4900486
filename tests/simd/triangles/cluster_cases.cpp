#include "simd/triangles/cluster_cases.h"

#include <cmath>

#include "query/query_cases.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

ClusterPose cluster_pose(const Eigen::Isometry3d& pose, const TriangleClusters& fixed,
                         const TriangleClusters& moving, double error) {
  ClusterPose out;
  const Eigen::Matrix3d rotation = fixed.axes().transpose() * pose.linear() * moving.axes();
  const Eigen::Vector3d translation = fixed.axes().transpose() * pose.translation();
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) out.rotation[i][j] = rotation(i, j);
    out.translation[i] = translation[i];
  }
  out.grid = fixed.grid();
  out.error = static_cast<float>(error);
  return out;
}

TriangleMesh at(TriangleMesh mesh, const Eigen::Isometry3d& pose) {
  for (Eigen::Vector3d& v : mesh.vertices) v = pose * v;
  return mesh;
}

}  // namespace

ClusterCase::ClusterCase(std::string of, TriangleMesh fixed_mesh, TriangleMesh moving_mesh,
                         const Eigen::Isometry3d& pose)
    : name(std::move(of)),
      fixed(std::move(fixed_mesh)),
      moving(at(moving_mesh, pose)),
      fixed_clusters(fixed, Eigen::Vector3d::Zero()),
      moving_clusters(moving_mesh, Eigen::Vector3d::Zero()) {
  double largest = 0;
  for (const auto* mesh : {&fixed, &moving, &moving_mesh}) {
    for (const Eigen::Vector3d& v : mesh->vertices) {
      largest = std::max(largest, v.cwiseAbs().maxCoeff());
    }
  }
  step = {cluster_pose(pose, fixed_clusters, moving_clusters, 0x1p-46 * largest),
          {fixed_clusters.bounds(0).data(), fixed_clusters.node_count(0)},
          fixed_clusters.clusters().data(),
          moving_clusters.clusters().data(),
          fixed_clusters.triangle_count(),
          moving_clusters.triangle_count()};
}

std::vector<ClusterCase> cluster_cases() {
  Random random(11);
  std::vector<ClusterCase> cases;
  for (int i = 0; i < 12; ++i) {
    TriangleMesh a = random_mesh(random), b = random_mesh(random);
    const Eigen::Matrix3d rotation = random.rotation();
    const Eigen::Vector3d to = a.vertices[random.below(a.vertices.size())] -
                               rotation * b.vertices[random.below(b.vertices.size())];
    cases.emplace_back("random " + std::to_string(i), std::move(a), std::move(b),
                       pose_of(rotation, to + random.uniform(0, 0.2) * random.direction()));
  }
  const TriangleMesh ball = icosphere(3, 1), ring = torus(2, 0.5, 60, 20);
  for (const double x : {0.0, 0.01, 1.4, 1.5, 1.51, 3.0}) {
    cases.emplace_back("ball in ring " + std::to_string(x), ring, ball, shift({x, 0, 0.003}));
    cases.emplace_back("ring on ball " + std::to_string(x), ball, ring,
                       pose_of(random.rotation(), {x, 0.1, 0}));
  }
  const TriangleMesh plate = box({-2, -2, -1}, {2, 2, -0.999});
  cases.emplace_back("few on many", plate, ball, shift({0.01, 0, 0}));
  cases.emplace_back("many on few", ball, plate, shift({0.01, 0, 0}));
  cases.emplace_back("one on one", triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                     triangle({0.1, 0.1, -1}, {0.2, 0.1, 1}, {0.1, 0.3, 1}), shift({0, 0, 0}));
  cases.emplace_back("on itself", ball, ball, shift({0, 0, 0}));
  // Where squares and cubes of lengths leave what float holds well.
  for (const int exponent : {-38, -36, 36, 38}) {
    const double by = std::ldexp(1.0, exponent);
    const auto scaled = [by](TriangleMesh mesh) {
      for (Eigen::Vector3d& v : mesh.vertices) v *= by;
      return mesh;
    };
    cases.emplace_back("apart 2^" + std::to_string(exponent), scaled(ring), scaled(ball),
                       shift({0.45 * by, 3 * by, 0}));
    cases.emplace_back("meeting 2^" + std::to_string(exponent), scaled(ring), scaled(ball),
                       shift({1.5 * by, 0, 0.003 * by}));
  }
  cases.emplace_back("large", turned(moved(ball, {1e3, 0, 0}), random.rotation()), ball,
                     shift({600, 0, 0}));
  return cases;
}

}  // namespace ist::test
