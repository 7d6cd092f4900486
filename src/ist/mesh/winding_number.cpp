#include "ist/mesh/winding_number.h"

#include <Eigen/Geometry>

#include "ist/base/ordered_vector.h"

namespace ist {
namespace {

// Returns the signed crossing of the triangle by the ray from the origin along `direction`: 1
// outward, -1 inward, 0 if it misses, and nullopt so near to an edge that rounding could decide.
std::optional<int> crossing(const Eigen::Vector3d& direction, const Eigen::Vector3d& a,
                            const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  constexpr double kDoubt = 1e-12;
  const auto side = [&direction](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const double volume = dot_in_order(direction, from.cross(to));
    const double doubt = kDoubt * from.cwiseAbs().maxCoeff() * to.cwiseAbs().maxCoeff();
    return volume > doubt ? 1 : volume < -doubt ? -1 : 0;
  };
  const int ab = side(a, b), bc = side(b, c), ca = side(c, a);
  if (ab * bc < 0 || bc * ca < 0 || ca * ab < 0) return 0;
  if (ab == 0 || bc == 0 || ca == 0) return std::nullopt;
  const double height = dot_in_order(a, (b - a).cross(c - a));  // of the plane, along the normal
  return (height > 0) == (ab > 0) ? ab : 0;
}

}  // namespace

std::optional<int> winding_number(const TriangleMesh& mesh,
                                  std::span<const std::uint32_t> triangles,
                                  const Eigen::Vector3d& point) noexcept {
  static const Eigen::Vector3d kDirections[] = {
      {0.5377, 0.2931, 0.7905},   {-0.6121, 0.7417, 0.2741},  {0.8693, -0.4243, 0.2537},
      {0.3187, 0.6173, -0.7193},  {-0.4877, -0.3797, 0.7861}, {-0.7219, 0.1531, -0.6749},
      {0.1319, -0.9203, -0.3683}, {-0.2399, -0.5101, -0.8261}};
  for (const Eigen::Vector3d& direction : kDirections) {
    std::optional<int> winding = 0;
    for (const std::uint32_t t : triangles) {
      const Triangle& triangle = mesh.triangles[t];
      const std::optional<int> crossed =
          crossing(direction, mesh.vertices[triangle[0]] - point,
                   mesh.vertices[triangle[1]] - point, mesh.vertices[triangle[2]] - point);
      if (!crossed) {
        winding.reset();
        break;
      }
      *winding += *crossed;
    }
    if (winding) return winding;
  }
  return std::nullopt;
}

}  // namespace ist
