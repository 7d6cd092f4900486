#include "support/shapes.h"

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "ist/models/models.h"
#include "models/shape_rings.h"

namespace ist::test {

TriangleMesh box(const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
  return make_box(min, max);
}

TriangleMesh triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                      const Eigen::Vector3d& c) {
  return {{a, b, c}, {{0, 1, 2}}};
}

TriangleMesh coincident(std::size_t triangles) {
  TriangleMesh mesh = triangle({-1, -1, 0}, {1, -0.8, 0.1}, {0, 1, 0.4});
  mesh.triangles.assign(triangles, {0, 1, 2});
  return mesh;
}

TriangleMesh icosphere(int level, double radius) { return make_icosphere(level, radius); }

TriangleMesh cylinder(int quarter, double radius, double height) {
  return make_cylinder(quarter, radius, height);
}

TriangleMesh pipe(int quarter, double inner, double outer, double height) {
  TriangleMesh mesh;
  const std::uint32_t rings[] = {
      add_ring(mesh, quarter, inner, 0), add_ring(mesh, quarter, outer, 0),
      add_ring(mesh, quarter, outer, height), add_ring(mesh, quarter, inner, height)};
  for (std::size_t i = 0; i < 4; ++i) add_band(mesh, quarter, rings[i], rings[(i + 1) % 4]);
  return mesh;
}

TriangleMesh revolved(const std::vector<Eigen::Vector2d>& outline, int around) {
  constexpr double kTurn = 6.283185307179586;
  TriangleMesh mesh;
  std::vector<std::vector<std::uint32_t>> rings;  // the vertices of each point of the outline
  for (const Eigen::Vector2d& point : outline) {
    auto& ring = rings.emplace_back();
    for (int i = 0; i < around; ++i) {
      if (point[0] == 0 && i > 0) {
        ring.push_back(ring[0]);
        continue;
      }
      const double angle = kTurn * i / around;
      ring.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.emplace_back(point[0] * std::cos(angle), point[0] * std::sin(angle), point[1]);
    }
  }
  const auto add = [&mesh](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
  };
  for (std::size_t k = 0; k < rings.size(); ++k) {
    const auto &from = rings[k], &to = rings[(k + 1) % rings.size()];
    for (std::size_t i = 0; i < from.size(); ++i) {
      const std::size_t next = (i + 1) % from.size();
      add(from[i], from[next], to[next]);
      add(from[i], to[next], to[i]);
    }
  }
  return mesh;
}

TriangleMesh torus(double ring, double tube, int around, int across) {
  constexpr double kTurn = 6.283185307179586;
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < across; ++i) {
    const double angle = kTurn * i / across;
    outline.emplace_back(ring + tube * std::cos(angle), tube * std::sin(angle));
  }
  return revolved(outline, around);
}

TriangleMesh tube(double inner, double outer, double half, double edge) {
  constexpr double kTurn = 6.283185307179586;
  const std::vector<Eigen::Vector2d> corners = {
      {inner, -half}, {outer, -half}, {outer, half}, {inner, half}};
  std::vector<Eigen::Vector2d> outline;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Eigen::Vector2d &a = corners[k], b = corners[(k + 1) % corners.size()];
    if (a[0] == 0 && b[0] == 0) {  // the axis
      outline.push_back(a);
      continue;
    }
    const int parts = static_cast<int>(std::ceil((b - a).norm() / edge));
    for (int i = 0; i < parts; ++i) outline.push_back(a + (b - a) * i / parts);
  }
  return revolved(outline, static_cast<int>(std::ceil(kTurn * outer / edge)));
}

TriangleMesh plate_with_holes(int holes) {
  int across = 1;
  while (across * across < holes) ++across;
  const int along = (holes + across - 1) / across;
  const auto is_solid = [&](int x, int y) {
    if (x < 0 || y < 0 || x > 2 * across || y > 2 * along) return false;
    return x % 2 == 0 || y % 2 == 0 || (y / 2) * across + x / 2 >= holes;
  };
  TriangleMesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> places;
  const auto vertex = [&](int x, int y, int z) {
    const auto [found, is_new] =
        places.try_emplace({x, y, z}, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.emplace_back(x, y, z);
    return found->second;
  };
  const auto square = [&mesh](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  // The wall over an edge of the floor that has the plate on its left.
  const auto wall = [&](int x0, int y0, int x1, int y1) {
    square(vertex(x0, y0, 0), vertex(x1, y1, 0), vertex(x1, y1, 1), vertex(x0, y0, 1));
  };
  for (int x = 0; x <= 2 * across; ++x) {
    for (int y = 0; y <= 2 * along; ++y) {
      if (!is_solid(x, y)) continue;
      square(vertex(x, y, 1), vertex(x + 1, y, 1), vertex(x + 1, y + 1, 1), vertex(x, y + 1, 1));
      square(vertex(x, y, 0), vertex(x, y + 1, 0), vertex(x + 1, y + 1, 0), vertex(x + 1, y, 0));
      if (!is_solid(x, y - 1)) wall(x, y, x + 1, y);
      if (!is_solid(x + 1, y)) wall(x + 1, y, x + 1, y + 1);
      if (!is_solid(x, y + 1)) wall(x + 1, y + 1, x, y + 1);
      if (!is_solid(x - 1, y)) wall(x, y + 1, x, y);
    }
  }
  return mesh;
}

TriangleMesh open_strip(int squares) {
  TriangleMesh mesh;
  for (int i = 0; i <= squares; ++i) {
    mesh.vertices.emplace_back(i, 0, 0);
    mesh.vertices.emplace_back(i, 1, 0);
  }
  for (int i = 0; i < squares; ++i) {
    const auto v = static_cast<std::uint32_t>(2 * i);
    mesh.triangles.push_back({v, v + 2, v + 3});
    mesh.triangles.push_back({v, v + 3, v + 1});
  }
  return mesh;
}

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh mesh = a;
  const auto offset = static_cast<std::uint32_t>(a.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& [i, j, k] : b.triangles)
    mesh.triangles.push_back({i + offset, j + offset, k + offset});
  return mesh;
}

TriangleMesh inside_out(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh turned(TriangleMesh mesh, const Eigen::Matrix3d& by) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = by * vertex;
  return mesh;
}

TriangleMesh moved(TriangleMesh mesh, const Eigen::Vector3d& by) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex += by;
  return mesh;
}

}  // namespace ist::test
