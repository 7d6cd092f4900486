#include "ist/mesh/jaw/jaw_tube.h"

#include "ist/base/assert.h"

namespace ist {
namespace {

double distance2(const TriangleMesh& mesh, std::uint32_t a, std::uint32_t b) {
  const Eigen::Vector3d d = mesh.vertices[a] - mesh.vertices[b];
  return d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
}

// Closes a ring by walking from the seam both ways at once, each time along the shorter diagonal.
// `flip` turns the sheet over, for the end that looks the other way.
void sew_end(TriangleMesh& mesh, std::size_t first_vertex, std::size_t ring_size, std::size_t seam,
             bool flip) {
  const auto at = [&](std::size_t i) {
    return static_cast<std::uint32_t>(first_vertex + i % ring_size);
  };
  std::size_t ahead = seam, behind = seam + ring_size - 1;
  while (behind - ahead > 1) {
    const bool step_ahead =
        distance2(mesh, at(ahead + 1), at(behind)) <= distance2(mesh, at(ahead), at(behind - 1));
    const std::uint32_t third = step_ahead ? at(ahead + 1) : at(behind - 1);
    if (flip) {
      mesh.triangles.push_back({at(ahead), at(behind), third});
    } else {
      mesh.triangles.push_back({at(ahead), third, at(behind)});
    }
    if (step_ahead) {
      ++ahead;
    } else {
      --behind;
    }
  }
}

}  // namespace

TriangleMesh sew_tube(std::span<const Eigen::Vector3d> vertices, std::size_t ring_size,
                      TubeSeams seams) {
  IST_ASSERT(ring_size >= 3 && vertices.size() % ring_size == 0 && vertices.size() > 0);
  TriangleMesh mesh;
  mesh.vertices.reserve(vertices.size());
  for (const Eigen::Vector3d& v : vertices) {
    mesh.vertices.push_back(v.cast<float>().cast<double>());
  }
  mesh.triangles.reserve(2 * vertices.size() - 4);

  for (std::size_t ring = 0; ring + ring_size < vertices.size(); ring += ring_size) {
    for (std::size_t i = 0; i < ring_size; ++i) {
      const std::size_t j = (i + 1) % ring_size;
      const auto a = static_cast<std::uint32_t>(ring + i), b = static_cast<std::uint32_t>(ring + j);
      const auto c = static_cast<std::uint32_t>(b + ring_size);
      const auto d = static_cast<std::uint32_t>(a + ring_size);
      if (distance2(mesh, a, c) <= distance2(mesh, b, d)) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({b, c, d});
      }
    }
  }
  sew_end(mesh, 0, ring_size, seams.first, true);
  sew_end(mesh, vertices.size() - ring_size, ring_size, seams.last, false);
  return mesh;
}

}  // namespace ist
