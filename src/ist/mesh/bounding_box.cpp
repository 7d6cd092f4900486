#include "ist/mesh/bounding_box.h"

namespace ist {

Eigen::AlignedBox3d bounding_box(const TriangleMesh& mesh) noexcept {
  Eigen::AlignedBox3d box;
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) box.extend(mesh.vertices[vertex]);
  }
  return box;
}

}  // namespace ist
