#include "ist/query/exact/triangle_bounds.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace ist {
namespace {

// Half of kPart covers the rounding to float, half that of a difference of doubles; kLeast covers
// denormals.
constexpr double kPart = 0x1p-23, kLeast = 0x1p-148;

float below(double x) { return static_cast<float>(x - (kPart * std::abs(x) + kLeast)); }
float above(double x) { return static_cast<float>(x + (kPart * std::abs(x) + kLeast)); }

// Returns a vector along the normal, a little shorter than 1, so that rounding does not make it
// longer.
Eigen::Vector3d normal_of(const TriangleCorners& c) {
  const Eigen::Vector3d u = c[1] - c[0], v = c[2] - c[0];
  const Eigen::Vector3d n(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                          u[0] * v[1] - u[1] * v[0]);
  const double squared = (n[0] * n[0] + n[1] * n[1]) + n[2] * n[2];
  if (!(squared > 0x1p-900) || !(squared < 0x1p900)) return Eigen::Vector3d::Zero();
  return n * ((1 - 0x1p-20) / std::sqrt(squared));
}

}  // namespace

FloatBox float_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) noexcept {
  FloatBox box;
  for (std::size_t i = 0; i < 3; ++i) {
    box.low[i] = below(low[static_cast<Eigen::Index>(i)]);
    box.high[i] = above(high[static_cast<Eigen::Index>(i)]);
  }
  return box;
}

TriangleBounds bounds_of(const TriangleCorners& corners, const Eigen::Vector3d& origin) noexcept {
  const TriangleCorners c = {corners[0] - origin, corners[1] - origin, corners[2] - origin};
  const Eigen::Vector3d normal = normal_of(c);
  TriangleBounds bounds;
  bounds.box = float_box(c[0].cwiseMin(c[1]).cwiseMin(c[2]), c[0].cwiseMax(c[1]).cwiseMax(c[2]));
  double farthest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    farthest += std::max({std::abs(c[0][axis]), std::abs(c[1][axis]), std::abs(c[2][axis])});
    bounds.normal[i] = static_cast<float>(normal[axis]);
    for (std::size_t k = 0; k < 3; ++k) bounds.corner[k][i] = static_cast<float>(c[k][axis]);
  }
  // Any normal will do, as long as heights are measured along it as it is stored. A height errs by
  // 3u of the coordinates (product and two sums), the corner by u, and the two differences after it
  // by 2u, u = 2⁻²⁴; the doubles here by less.
  const auto height = [&](const Eigen::Vector3d& p) {
    return (bounds.normal[0] * p[0] + bounds.normal[1] * p[1]) + bounds.normal[2] * p[2];
  };
  const auto [bottom, top] = std::minmax({height(c[0]), height(c[1]), height(c[2])});
  bounds.slack = static_cast<float>(8 * 0x1p-24 * farthest + kLeast);
  bounds.bottom = static_cast<float>(bottom) - bounds.slack;
  bounds.top = static_cast<float>(top) + bounds.slack;
  return bounds;
}

void TriangleLanes::add(const TriangleBounds& bounds) noexcept {
  const auto numbers = std::bit_cast<std::array<float, kTriangleNumbers>>(bounds);
  for (std::size_t i = 0; i < kTriangleNumbers; ++i) number[i][count] = numbers[i];
  ++count;
}

namespace {

// Returns the distance of one triangle's corners from the other's slab, above or below it.
float apart_along(const float (&normal)[3], float bottom, float top, const float (&corner)[3][3],
                  float slack) {
  float height[3];
  for (std::size_t i = 0; i < 3; ++i) {
    height[i] = (normal[0] * corner[i][0] + normal[1] * corner[i][1]) + normal[2] * corner[i][2];
  }
  const float lowest = std::min(std::min(height[0], height[1]), height[2]);
  const float highest = std::max(std::max(height[0], height[1]), height[2]);
  return std::max(lowest - top, bottom - highest) - slack;
}

bool near_each_other(const TriangleBounds& a, const TriangleBounds& b, float distance) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (a.box.low[i] - b.box.high[i] > distance || b.box.low[i] - a.box.high[i] > distance) {
      return false;
    }
  }
  return !(apart_along(a.normal, a.bottom, a.top, b.corner, b.slack) > distance) &&
         !(apart_along(b.normal, b.bottom, b.top, a.corner, a.slack) > distance);
}

}  // namespace

std::size_t find_near_scalar(const TriangleLanes& lanes, const TriangleBounds* bounds,
                             const std::uint32_t* ids, std::size_t count, float distance,
                             NearPair* out) {
  std::size_t found = 0;
  for (std::size_t k = 0; k < count; ++k) {
    for (std::uint32_t lane = 0; lane < lanes.count; ++lane) {
      std::array<float, kTriangleNumbers> numbers;
      for (std::size_t i = 0; i < kTriangleNumbers; ++i) numbers[i] = lanes.number[i][lane];
      if (near_each_other(std::bit_cast<TriangleBounds>(numbers), bounds[ids[k]], distance)) {
        out[found++] = {lane, ids[k]};
      }
    }
  }
  return found;
}

}  // namespace ist
