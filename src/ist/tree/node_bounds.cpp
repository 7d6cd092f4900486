#include "ist/tree/node_bounds.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "ist/base/assert.h"
#include "ist/base/ordered_vector.h"
#include "ist/tree/enclosing_ball.h"
#include "ist/tree/least_axis.h"

namespace ist {
namespace {

using Eigen::Vector3d;

// The part of the 1 % that the ball's centre may use.
constexpr double kTolerance = 0.008;

// The least area of a flat payload whose normal is certain, in squares of the cube's edge.
constexpr double kFlatArea = 0x1p-16;

// Rounds a value to the nearest whole number; halves upward. Precondition: |value| <= 2^16.
int nearest(double value) noexcept {
  constexpr int kShift = 1 << 17;  // makes the number positive, so that a conversion rounds down
  return static_cast<int>(value + (kShift + 0.5)) - kShift;
}

// Rounds a value up. Precondition: 0 <= value < 2^31.
int up(double value) noexcept {
  const int down = static_cast<int>(value);
  return down + static_cast<int>(down < value);
}

Vector3d least_spread(std::span<const Vector3d> points) noexcept {
  const double ox = points[0][0], oy = points[0][1], oz = points[0][2];
  double x1 = 0, y1 = 0, z1 = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  for (const Vector3d& p : points.subspan(1)) {
    const double x = p[0] - ox, y = p[1] - oy, z = p[2] - oz;
    x1 += x;
    y1 += y;
    z1 += z;
    xx += x * x;
    xy += x * y;
    xz += x * z;
    yy += y * y;
    yz += y * z;
    zz += z * z;
  }
  return least_axis(moments_about_mean(static_cast<double>(points.size()), {x1, y1, z1},
                                       {xx, xy, xz, yy, yz, zz}));
}

// Rounds `axis` to a packed normal and measures along it. The axis has length 1 to a few roundings,
// so 126 times the axis, rounded, is no longer than 128.
Extent extent_along(const Vector3d& axis, std::span<const Vector3d> points,
                    const Vector3d& from) noexcept {
  const int rounded[3] = {nearest(126 * axis[0]), nearest(126 * axis[1]), nearest(126 * axis[2])};
  const Vector3d normal(PackedSlab::kNormalUnit * rounded[0], PackedSlab::kNormalUnit * rounded[1],
                        PackedSlab::kNormalUnit * rounded[2]);
  const double first = dot_in_order(normal, difference(points[0], from));
  Extent extent{{static_cast<std::int8_t>(rounded[0]), static_cast<std::int8_t>(rounded[1]),
                 static_cast<std::int8_t>(rounded[2]), 0, 0},
                first,
                first};
  for (const Vector3d& p : points.subspan(1)) {
    const double height = dot_in_order(normal, difference(p, from));
    extent.least = std::min(extent.least, height);
    extent.greatest = std::max(extent.greatest, height);
  }
  return extent;
}

}  // namespace

PackedBall pack_centre(const Vector3d& centre, const Vector3d& parent_centre,
                       double parent_edge) noexcept {
  const double unit = PackedBall::kUnit * parent_edge;
  const auto packed = [&](Eigen::Index axis) {
    const double units = (centre[axis] - parent_centre[axis]) / unit;
    return static_cast<std::int16_t>(nearest(std::clamp(units, -32768.0, 32767.0)));
  };
  return {packed(0), packed(1), packed(2), 0};
}

std::uint16_t pack_radius(double radius, double parent_edge) noexcept {
  const double units = radius / (PackedBall::kUnit * parent_edge);
  IST_ASSERT(units > 0 && units <= 65535);
  return static_cast<std::uint16_t>(up(units));
}

PackedSlab pack_slab(const Extent& extent, double pad, double edge) noexcept {
  const double unit = PackedSlab::kUnit * edge;
  const int offset =
      nearest(std::clamp(0.5 * (extent.least + extent.greatest) / unit, -127.0, 127.0));
  const double half = std::max(extent.greatest - unit * offset, unit * offset - extent.least);
  const double units = (half + pad) / unit;
  if (!(units <= 255)) return {0, 0, 0, 0, 255};
  PackedSlab slab = extent.normal;
  slab.offset = static_cast<std::int8_t>(offset);
  slab.half = static_cast<std::uint8_t>(up(units));
  return slab;
}

PackedBall pack_ball(const Payload& payload, const Vector3d& parent_centre,
                     double parent_edge) noexcept {
  const Vector3d centre = enclosing_centre(payload.points, kTolerance);
  PackedBall ball = pack_centre(centre, parent_centre, parent_edge);
  const Vector3d rounded = centre_of(ball, parent_centre, parent_edge);
  double farthest2 = 0;
  for (const Vector3d& p : payload.points) {
    const Vector3d d = difference(p, rounded);
    farthest2 = std::max(farthest2, dot_in_order(d, d));
  }
  // A distance has a relative error of a few 2⁻⁵³.
  ball.r = pack_radius(std::sqrt(farthest2) + payload.pad, parent_edge);
  return ball;
}

PackedSlab pack_slab(const Payload& payload, const Vector3d& centre, double edge) noexcept {
  // Heights have an error of a dozen 2⁻⁵³ of the cube's edge.
  const double area = length_in_order(payload.area);
  const auto of_area = [&] {
    return extent_along(scaled(1 / area, payload.area), payload.points, centre);
  };
  if (payload.is_flat && area > kFlatArea * (edge * edge)) {
    return pack_slab(of_area(), payload.pad, edge);
  }
  Extent extent = extent_along(least_spread(payload.points), payload.points, centre);
  if (area > 0) {
    const Extent other = of_area();
    if (other.greatest - other.least < extent.greatest - extent.least) extent = other;
  }
  return pack_slab(extent, payload.pad, edge);
}

}  // namespace ist
