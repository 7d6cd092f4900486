#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "ist/mesh/clusters/triangle_clusters.h"
#include "ist/mesh/mesh.h"
#include "simd/triangles/cluster_step.h"

namespace ist::test {

/// Two meshes, their clusters, and a pose of the second one.
struct ClusterCase {
  ClusterCase(std::string of, TriangleMesh fixed_mesh, TriangleMesh moving_mesh,
              const Eigen::Isometry3d& pose);

  std::string name;
  TriangleMesh fixed, moving;  ///< the moving one is at the pose already, in double
  TriangleClusters fixed_clusters, moving_clusters;
  ClusterStep step;
};

/// Bodies that touch and do not, of random triangles, of many and few, large and small, and far.
[[nodiscard]] std::vector<ClusterCase> cluster_cases();

}  // namespace ist::test
