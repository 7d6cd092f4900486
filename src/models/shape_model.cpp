#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "ist/base/float_environment.h"
#include "ist/models/models.h"
#include "models/shape_rings.h"

namespace ist {

TriangleMesh make_box(const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
  TriangleMesh mesh;
  for (unsigned k = 0; k < 8; ++k)  // bit 0 of k = +x, bit 1 = +y, bit 2 = +z
    mesh.vertices.emplace_back((k & 1u) != 0 ? max.x() : min.x(), (k & 2u) != 0 ? max.y() : min.y(),
                               (k & 4u) != 0 ? max.z() : min.z());
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh make_icosphere(int level, double radius) {
  const ScopedFloatEnvironment environment;
  const double golden = (1 + std::sqrt(5.0)) / 2;
  TriangleMesh mesh;
  const auto add = [&mesh](const Eigen::Vector3d& direction) {
    const double length2 = direction.x() * direction.x() + direction.y() * direction.y() +
                           direction.z() * direction.z();
    mesh.vertices.push_back(direction / std::sqrt(length2));
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  };
  for (const double y : {1.0, -1.0})
    for (const double x : {-1.0, 1.0}) add({x, y * golden, 0});
  for (const double z : {1.0, -1.0})
    for (const double y : {-1.0, 1.0}) add({0, y, z * golden});
  for (const double x : {1.0, -1.0})
    for (const double z : {-1.0, 1.0}) add({x * golden, 0, z});
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int i = 0; i < level; ++i) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), 0u);
      if (is_new) found->second = add(mesh.vertices[a] + mesh.vertices[b]);
      return found->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex *= radius;
  return mesh;
}

namespace {

// Adds a half sphere round the origin, z >= 0, that faces outward, as rings that are as close to
// each other as the vertices of a ring. Returns the index of its first vertex; the first ring lies
// in the plane z = 0.
std::uint32_t add_half_sphere(TriangleMesh& mesh, int quarter, double radius) {
  std::uint32_t last = 0;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < quarter; ++i) {
    const double t = static_cast<double>(i) / quarter, scale = radius / (1 + t * t);
    const std::uint32_t ring = add_ring(mesh, quarter, (1 - t * t) * scale, 2 * t * scale);
    if (i > 0) add_band(mesh, quarter, last, ring);
    last = ring;
  }
  const auto pole = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(0, 0, radius);
  for (std::uint32_t i = last; i < pole; ++i) {
    mesh.triangles.push_back({i, i + 1 < pole ? i + 1 : last, pole});
  }
  return first;
}

}  // namespace

TriangleMesh make_fossa(int quarter, double radius, double thickness) {
  const ScopedFloatEnvironment environment;
  TriangleMesh mesh;
  const std::uint32_t inner = add_half_sphere(mesh, quarter, radius);
  for (Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  const std::uint32_t outer = add_half_sphere(mesh, quarter, radius + thickness);
  add_band(mesh, quarter, inner, outer);
  return mesh;
}

TriangleMesh make_cylinder(int quarter, double radius, double height) {
  const ScopedFloatEnvironment environment;
  TriangleMesh mesh;
  const std::uint32_t bottom = add_ring(mesh, quarter, radius, 0);
  const std::uint32_t top = add_ring(mesh, quarter, radius, height);
  add_band(mesh, quarter, bottom, top);
  const std::uint32_t middle = top + top - bottom;
  mesh.vertices.emplace_back(0, 0, 0);
  mesh.vertices.emplace_back(0, 0, height);
  for (std::uint32_t i = 0; i < top; ++i) {
    const std::uint32_t j = (i + 1) % top;
    mesh.triangles.push_back({middle, bottom + j, bottom + i});
    mesh.triangles.push_back({middle + 1, top + i, top + j});
  }
  return mesh;
}

}  // namespace ist
