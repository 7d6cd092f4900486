#include "ist/voxel/triangle_clip.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ist {
namespace {

// A triangle cut by six planes has nine corners at most, but rounding can bend a nearly straight
// run of corners to and fro across a plane. Past the last place such a pair is dropped: it lies on
// an edge that is kept.
constexpr int kPlaces = ClippedTriangle::kMaxCorners;

// Cuts away what lies beyond `plane` on `axis`; `sign` +1 keeps what is below, -1 what is above.
int cut(const Eigen::Vector3d* in, int count, int axis, double plane, double sign,
        Eigen::Vector3d* out) noexcept {
  int kept = 0;
  Eigen::Vector3d from = in[count - 1];
  double from_beyond = sign * (from[axis] - plane);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d& to = in[i];
    const double to_beyond = sign * (to[axis] - plane);
    if ((from_beyond > 0) != (to_beyond > 0) && kept < kPlaces) {
      const double part = from_beyond / (from_beyond - to_beyond);
      Eigen::Vector3d& crossing = out[kept++];
      for (int k = 0; k < 3; ++k) {
        // Rounding must not carry a crossing outside the edge that it lies on.
        const double low = std::min(from[k], to[k]), high = std::max(from[k], to[k]);
        crossing[k] = std::clamp(from[k] + part * (to[k] - from[k]), low, high);
      }
      crossing[axis] = plane;
    }
    if (!(to_beyond > 0) && kept < kPlaces) out[kept++] = to;
    from = to;
    from_beyond = to_beyond;
  }
  return kept;
}

}  // namespace

double ClippedTriangle::area() const noexcept {
  Eigen::Vector3d twice = Eigen::Vector3d::Zero();
  for (int i = 2; i < count; ++i) {
    const Eigen::Vector3d a = corners[static_cast<std::size_t>(i - 1)] - corners[0];
    const Eigen::Vector3d b = corners[static_cast<std::size_t>(i)] - corners[0];
    twice += a.cross(b);
  }
  return 0.5 * std::sqrt((twice[0] * twice[0] + twice[1] * twice[1]) + twice[2] * twice[2]);
}

void clip_triangle(const std::array<Eigen::Vector3d, 3>& triangle, const Eigen::Vector3d& low,
                   const Eigen::Vector3d& high, ClippedTriangle& result) noexcept {
  Eigen::Vector3d other[kPlaces];
  Eigen::Vector3d* in = result.corners.data();
  Eigen::Vector3d* out = other;
  std::copy(triangle.begin(), triangle.end(), in);
  int count = 3;
  for (int axis = 0; axis < 3; ++axis) {
    const double first = triangle[0][axis], second = triangle[1][axis], third = triangle[2][axis];
    if (std::max({first, second, third}) > high[axis]) {
      count = cut(in, count, axis, high[axis], 1, out);
      std::swap(in, out);
      if (count == 0) break;
    }
    if (std::min({first, second, third}) < low[axis]) {
      count = cut(in, count, axis, low[axis], -1, out);
      std::swap(in, out);
      if (count == 0) break;
    }
  }
  if (in != result.corners.data()) std::copy(in, in + count, result.corners.data());
  result.count = count;
}

NearestPoint nearest_on_triangle(const std::array<Eigen::Vector3d, 3>& triangle,
                                 const Eigen::Vector3d& point) noexcept {
  const Eigen::Vector3d &a = triangle[0], &b = triangle[1], &c = triangle[2];
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = point - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {a, 0};
  const Eigen::Vector3d bp = point - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {b, 1};
  // An edge of length zero is passed over: the other two have its end points.
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 - d3 > 0) return {a + d1 / (d1 - d3) * ab, 3};
  const Eigen::Vector3d cp = point - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
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
