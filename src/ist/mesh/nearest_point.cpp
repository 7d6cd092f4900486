#include "ist/mesh/nearest_point.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "ist/base/ordered_vector.h"

namespace ist {
namespace {

// Handles a sliver, whose corner weights would be mostly rounding: returns the nearest point of its
// three edges, or the foot of the perpendicular if that is nearer. The foot is found along the
// longest edge, and along the height above it. Whatever rounding does to the foot, it is a point of
// the triangle.
NearestPoint nearest_on_sliver(const std::array<Eigen::Vector3d, 3>& triangle,
                               const Eigen::Vector3d& normal,
                               const Eigen::Vector3d& point) noexcept {
  NearestPoint nearest{};
  double least = std::numeric_limits<double>::infinity(), longest2 = 0;
  std::size_t longest = 0;
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    const Eigen::Vector3d& from = triangle[static_cast<std::size_t>(i)];
    const Eigen::Vector3d& to = triangle[static_cast<std::size_t>(next)];
    const Eigen::Vector3d side = to - from, offset = point - from;
    const double along = dot_in_order(side, offset), length2 = square_in_order(side);
    if (length2 > longest2) longest = static_cast<std::size_t>(i);
    longest2 = std::max(longest2, length2);
    NearestPoint on_side{from, i};
    if (along >= length2 && length2 > 0) {
      on_side = {to, next};
    } else if (along > 0) {
      on_side = {from + along / length2 * side, 3 + i};
    }
    const double distance2 = square_in_order(point - on_side.point);
    if (distance2 < least) {
      least = distance2;
      nearest = on_side;
    }
  }
  // The height is this part of the longest edge at least.
  constexpr double kLeastHeight = 1e-11;
  const double least_area = kLeastHeight * longest2;
  if (!(square_in_order(normal) > least_area * least_area)) return nearest;
  const Eigen::Vector3d& from = triangle[longest];
  const Eigen::Vector3d side = triangle[(longest + 1) % 3] - from;
  const Eigen::Vector3d to_tip = triangle[(longest + 2) % 3] - from, offset = point - from;
  const double tip_at = dot_in_order(to_tip, side) / longest2;
  const double point_at = dot_in_order(offset, side) / longest2;
  const Eigen::Vector3d height = to_tip - tip_at * side, above = offset - point_at * side;
  const double up = dot_in_order(above, height) / square_in_order(height);
  const double along = point_at - up * tip_at;
  if (!(up > 0 && along > 0 && along + up < 1)) return nearest;
  const Eigen::Vector3d foot = from + (along * side + up * to_tip);
  return square_in_order(point - foot) < least ? NearestPoint{foot, NearestPoint::kInside}
                                               : nearest;
}

}  // namespace

NearestPoint nearest_on_triangle(const std::array<Eigen::Vector3d, 3>& triangle,
                                 const Eigen::Vector3d& point) noexcept {
  const Eigen::Vector3d &a = triangle[0], &b = triangle[1], &c = triangle[2];
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = point - a;
  // area2 / sides2 is the squared sine of the sharpest corner. The weights below lose as many
  // digits as it has zeros.
  const Eigen::Vector3d normal = ab.cross(ac);
  const double ab2 = square_in_order(ab), ac2 = square_in_order(ac), bc2 = square_in_order(c - b);
  const double area2 = square_in_order(normal);
  const double sides2 = std::max(std::max(ab2 * ac2, ab2 * bc2), ac2 * bc2);
  if (!(area2 > 1e-6 * sides2)) {
    return nearest_on_sliver(triangle, normal, point);
  }
  const double d1 = dot_in_order(ab, ap), d2 = dot_in_order(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {a, 0};
  const Eigen::Vector3d bp = point - b;
  const double d3 = dot_in_order(ab, bp), d4 = dot_in_order(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {b, 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 - d3 > 0) return {a + d1 / (d1 - d3) * ab, 3};
  const Eigen::Vector3d cp = point - c;
  const double d5 = dot_in_order(ab, cp), d6 = dot_in_order(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {c, 2};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 - d6 > 0) return {a + d2 / (d2 - d6) * ac, 5};
  const double va = d3 * d6 - d5 * d4;
  const double along_bc = (d4 - d3) + (d5 - d6);
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0 && along_bc > 0) {
    return {b + (d4 - d3) / along_bc * (c - b), 4};
  }
  const double sum = (va + vb) + vc;
  if (!(sum > 0)) return {a, 0};
  return {a + (vb / sum) * ab + (vc / sum) * ac, NearestPoint::kInside};
}

}  // namespace ist
