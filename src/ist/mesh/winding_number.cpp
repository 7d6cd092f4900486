#include "ist/mesh/winding_number.h"

#include "ist/base/float_rounding.h"
#include "ist/base/ordered_vector.h"
#include "ist/mesh/orientation.h"
#include "ist/mesh/triangles_meet.h"

namespace ist {

using Vector = Eigen::Vector3d;

namespace {

// Returns how a triangle's outline turns round `point`, both seen against the axis x: 1
// counterclockwise, -1 clockwise, 0 if it does not go round.
int turns_round(const Vector& a, const Vector& b, const Vector& c, const Vector& point) {
  const double y = point[1], z = point[2];
  const bool a_above = a[2] > z, b_above = b[2] > z, c_above = c[2] > z;
  if (a_above == b_above && b_above == c_above) return 0;
  // An edge that goes up counts if the point is to its left, and down to its right.
  const auto pass = [&](const Vector& from, const Vector& to, bool from_above, bool to_above) {
    if (from_above == to_above) return 0;
    const int side = orientation(Eigen::Vector2d(from[1], from[2]), Eigen::Vector2d(to[1], to[2]),
                                 Eigen::Vector2d(y, z));
    return to_above ? (side > 0 ? 1 : 0) : (side < 0 ? -1 : 0);
  };
  return pass(a, b, a_above, b_above) + pass(b, c, b_above, c_above) + pass(c, a, c_above, a_above);
}

}  // namespace

Crossing crossing(const Vector& a, const Vector& b, const Vector& c, const Vector& point) noexcept {
  if (a[0] < point[0] && b[0] < point[0] && c[0] < point[0]) return Crossing::kNone;
  bool in_box = true;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto [low, high] = std::minmax({a[i], b[i], c[i]});
    in_box = in_box && low <= point[i] && point[i] <= high;
  }
  const int turns = turns_round(a, b, c, point);
  if (turns == 0 && !in_box) return Crossing::kNone;
  const int side = orientation(a, b, c, point);
  if (side == 0 && in_box && triangles_meet({point, point, point}, {a, b, c})) {
    return Crossing::kOnTriangle;
  }
  // The ray along x leaves one side of the plane alone.
  if (turns == 0 || side != turns) return Crossing::kNone;
  return turns > 0 ? Crossing::kOutward : Crossing::kInward;
}

WindingNumber::WindingNumber(const TriangleMesh& mesh, const TriangleClusters& clusters) noexcept
    : mesh_(mesh), clusters_(clusters), extent_(clusters.extent()) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      axes_[i][k] = static_cast<float>(
          clusters.axes()(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)));
    }
  }
}

WindingNumber::Ray WindingNumber::ray_from(const Vector& point) const noexcept {
  const Vector from = difference(point, clusters_.origin());
  Ray ray{};
  for (std::size_t i = 0; i < 3; ++i) {
    ray.from[i] = static_cast<float>(from[static_cast<Eigen::Index>(i)]);
  }
  // Some ten roundings of float, each of a number below the sum.
  ray.slack = rounded_up(0x1p-19 * (extent_ + from.cwiseAbs().maxCoeff()));
  return ray;
}

// Returns a bit for each lane whose box the ray may meet. The box round a node is turned with the
// tree, so its shadows along the mesh's axes are larger than it.
std::uint32_t WindingNumber::lanes_on(const Ray& ray, const NodeBlock& block) const noexcept {
  alignas(64) float apart[kClusterWidth];
  for (std::size_t lane = 0; lane < kClusterWidth; ++lane) {
    float centre[3], half[3];
    for (std::size_t i = 0; i < 3; ++i) {
      centre[i] = (axes_[i][0] * block.centre[0][lane] + axes_[i][1] * block.centre[1][lane]) +
                  axes_[i][2] * block.centre[2][lane] - ray.from[i];
      half[i] = (std::abs(axes_[i][0]) * block.half[0][lane] +
                 std::abs(axes_[i][1]) * block.half[1][lane]) +
                std::abs(axes_[i][2]) * block.half[2][lane];
      half[i] = std::min(half[i], block.radius[lane]);
    }
    const float y = std::abs(centre[1]) - half[1], z = std::abs(centre[2]) - half[2];
    apart[lane] = std::max(std::max(y, z), -centre[0] - half[0]);
  }
  return lanes_within(apart, ray.slack);
}

// Returns a bit for each triangle of a cluster whose box about the ray's axes it may meet.
std::uint32_t WindingNumber::triangles_on(const Ray& ray, std::uint32_t cluster) const noexcept {
  const TriangleCluster& triangles = clusters_.clusters()[cluster];
  const NodeBlock& block = clusters_.bounds(0)[cluster / kClusterWidth];
  const std::size_t at = cluster % kClusterWidth;
  alignas(64) float apart[kClusterWidth] = {};
  for (std::size_t i = 0; i < 3; ++i) {
    // A corner's coordinate along the mesh's axis i, from the ray.
    const float centre = (axes_[i][0] * block.centre[0][at] + axes_[i][1] * block.centre[1][at]) +
                         axes_[i][2] * block.centre[2][at] - ray.from[i];
    float along[3];
    for (std::size_t k = 0; k < 3; ++k) {
      along[k] = (axes_[i][0] * triangles.axis[0][k] + axes_[i][1] * triangles.axis[1][k]) +
                 axes_[i][2] * triangles.axis[2][k];
    }
    for (std::size_t lane = 0; lane < kClusterWidth; ++lane) {
      float corner[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& p = triangles.corner[k];
        corner[k] =
            ((along[0] * p[0][lane] + along[1] * p[1][lane]) + along[2] * p[2][lane]) + centre;
      }
      const float low = std::min(std::min(corner[0], corner[1]), corner[2]),
                  high = std::max(std::max(corner[0], corner[1]), corner[2]);
      apart[lane] = std::max(apart[lane], i == 0 ? -high : std::max(low, -high));
    }
  }
  return lanes_within(apart, ray.slack);
}

std::optional<int> WindingNumber::at(const Vector& point) const noexcept {
  int winding = 0;
  bool on_surface = false;
  for_each_crossed(point, [&](std::uint32_t, Crossing crossing) {
    on_surface = on_surface || crossing == Crossing::kOnTriangle;
    winding += static_cast<int>(crossing);
  });
  if (on_surface) return std::nullopt;
  return winding;
}

}  // namespace ist
