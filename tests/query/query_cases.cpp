#include "query/query_cases.h"

#include <cmath>
#include <tuple>

#include "ist/tree/sphere_tree.h"
#include "support/shapes.h"

namespace ist::test {

TriangleMesh random_mesh(Random& random) {
  switch (random.below(5)) {
    case 0:
      return moved(icosphere(static_cast<int>(random.below(3)), random.uniform(0.5, 2)),
                   random.point(-3, 3));
    case 1: {
      const Eigen::Vector3d corner = random.point(-3, 3);
      return box(corner, corner + random.point(0.2, 2));
    }
    case 2: {
      TriangleMesh soup;
      const std::size_t triangles = 1 + random.below(12);
      for (std::size_t i = 0; i < triangles; ++i) {
        const Eigen::Vector3d a = random.point(-1, 1), b = random.point(-1, 1);
        soup = joined(soup, triangle(a, b, random.point(-1, 1)));
      }
      return soup;
    }
    case 3: {
      const Eigen::Vector3d a = random.point(-1, 1), b = random.point(-1, 1);
      return triangle(a, b, random.point(-1, 1));
    }
    default: {
      const Eigen::Vector3d a = random.point(-1, 1), b = a + random.direction();
      const double thin = std::ldexp(1.0, -static_cast<int>(random.below(50)));
      return triangle(a, b, a + random.uniform(-0.5, 1.5) * (b - a) + thin * random.direction());
    }
  }
}

SphereTree tree_of(const TriangleMesh& mesh, double cells) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : mesh.vertices) bounds.extend(vertex);
  BuildOptions options;
  options.voxel_size = bounds.sizes().maxCoeff() / cells;
  options.spheres = SpherePolicy::kSlab;
  options.keep_triangles = false;
  return build_tree(mesh, options);
}

std::vector<Eigen::Matrix3d> quarter_turns() {
  std::vector<Eigen::Matrix3d> turns;
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) {
      if (x == y) continue;
      for (int signs = 0; signs < 4; ++signs) {
        Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
        turn(x, 0) = (signs & 1) != 0 ? -1 : 1;
        turn(y, 1) = (signs & 2) != 0 ? -1 : 1;
        turn.col(2) = turn.col(0).cross(turn.col(1));
        turns.push_back(turn);
      }
    }
  }
  return turns;
}

Eigen::Isometry3d pose_of(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation;
  pose.translation() = translation;
  return pose;
}

Eigen::Isometry3d shift(const Eigen::Vector3d& translation) {
  return pose_of(Eigen::Matrix3d::Identity(), translation);
}

bool same(const FoundPairs& a, const FoundPairs& b) {
  const auto numbers = [](const QueryResult& r) {
    return std::tuple(r.status, r.complete, r.truncated, r.level, r.leaf_pairs, r.sphere_tests,
                      r.pad);
  };
  return numbers(a.result) == numbers(b.result) && a.leaf_pairs == b.leaf_pairs;
}

}  // namespace ist::test
