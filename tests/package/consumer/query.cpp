// Questions need the engine alone: this program links ist::ist.
#include <ist/ist.h>
#include <ist/measure.h>

#include <cstdio>

int main() {
  ist::TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const ist::SphereTree tree = ist::build_tree(mesh, {.voxel_size = 0.1});
  ist::Query query(tree, tree);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const bool touches = query.intersects(pose).answer == ist::Answer::kYes;
  pose.translation().x() = 3;
  const bool parts = query.intersects(pose).answer == ist::Answer::kNo;
  std::printf("%d %d\n", touches, parts);
  return touches && parts ? 0 : 1;
}
