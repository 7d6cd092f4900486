#include "ist/voxel/triangle_clip.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ist {
namespace {

// Cuts away the part above (kAbove) or below `plane` on an axis. Six planes leave a triangle at
// most nine corners, but rounding can bend a nearly straight run of corners to and fro across a
// plane. Corners beyond kMaxCorners are dropped, because such a pair lies on an edge that is kept.
template <int kAxis, bool kAbove>
void cut(const ClippedTriangle& in, double plane, ClippedTriangle& out) noexcept {
  constexpr int kNext = (kAxis + 1) % 3, kLast = (kAxis + 2) % 3;
  const auto beyond = [plane](const Eigen::Vector3d& p) {
    return kAbove ? p[kAxis] - plane : plane - p[kAxis];
  };
  out.count = 0;
  const auto keep = [&out](const Eigen::Vector3d& p) {
    if (out.count < ClippedTriangle::kMaxCorners) {
      out.corners[static_cast<std::size_t>(out.count++)] = p;
    }
  };
  const Eigen::Vector3d* from = &in.corners[static_cast<std::size_t>(in.count - 1)];
  double from_beyond = beyond(*from);
  for (int i = 0; i < in.count; ++i) {
    const Eigen::Vector3d* to = &in.corners[static_cast<std::size_t>(i)];
    const double to_beyond = beyond(*to);
    if ((from_beyond > 0) != (to_beyond > 0)) {
      // Interpolates from the kept end, so that an edge is cut at the same point from both its
      // sides.
      const bool leaving = to_beyond > 0;
      const Eigen::Vector3d &kept = leaving ? *from : *to, &lost = leaving ? *to : *from;
      const double kept_beyond = leaving ? from_beyond : to_beyond;
      const double part = kept_beyond / (kept_beyond - (leaving ? to_beyond : from_beyond));
      Eigen::Vector3d crossing;
      crossing[kAxis] = plane;
      crossing[kNext] = kept[kNext] + part * (lost[kNext] - kept[kNext]);
      crossing[kLast] = kept[kLast] + part * (lost[kLast] - kept[kLast]);
      keep(crossing);
    }
    if (!(to_beyond > 0)) keep(*to);
    from = to;
    from_beyond = to_beyond;
  }
}

template <int kAxis>
const ClippedTriangle& clip_along(const ClippedTriangle& polygon, double low, double high,
                                  ClippedTriangle& result) noexcept {
  double least = high, greatest = low;
  for (int i = 0; i < polygon.count; ++i) {
    const double coordinate = polygon.corners[static_cast<std::size_t>(i)][kAxis];
    least = std::min(least, coordinate);
    greatest = std::max(greatest, coordinate);
  }
  if (least >= low && greatest <= high) return polygon;
  if (least >= low) {
    cut<kAxis, true>(polygon, high, result);
  } else if (greatest <= high) {
    cut<kAxis, false>(polygon, low, result);
  } else {
    ClippedTriangle below;
    cut<kAxis, true>(polygon, high, below);
    if (below.count == 0) {
      result.count = 0;
    } else {
      cut<kAxis, false>(below, low, result);
    }
  }
  return result;
}

}  // namespace

double ClippedTriangle::projected_area(int axis) const noexcept {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  double twice = 0;
  for (int i = 2; i < count; ++i) {
    const Eigen::Vector3d &o = corners[0], &p = corners[static_cast<std::size_t>(i - 1)],
                          &q = corners[static_cast<std::size_t>(i)];
    twice += (p[u] - o[u]) * (q[v] - o[v]) - (p[v] - o[v]) * (q[u] - o[u]);
  }
  return 0.5 * std::abs(twice);
}

const ClippedTriangle& clip_between(const ClippedTriangle& polygon, int axis, double low,
                                    double high, ClippedTriangle& result) noexcept {
  if (polygon.count == 0) return polygon;
  switch (axis) {
    case 0:
      return clip_along<0>(polygon, low, high, result);
    case 1:
      return clip_along<1>(polygon, low, high, result);
    default:
      return clip_along<2>(polygon, low, high, result);
  }
}

void clip_triangle(const std::array<Eigen::Vector3d, 3>& triangle, const Eigen::Vector3d& low,
                   const Eigen::Vector3d& high, ClippedTriangle& result) noexcept {
  ClippedTriangle whole, first, second;
  std::copy(triangle.begin(), triangle.end(), whole.corners.begin());
  whole.count = 3;
  const ClippedTriangle& in_x = clip_between(whole, 0, low[0], high[0], first);
  const ClippedTriangle& in_y = clip_between(in_x, 1, low[1], high[1], second);
  const ClippedTriangle& in_z = clip_between(in_y, 2, low[2], high[2], result);
  if (&in_z == &result) return;
  result.count = in_z.count;
  std::copy_n(in_z.corners.begin(), in_z.count, result.corners.begin());
}

TriangleSlicer::TriangleSlicer(const std::array<Eigen::Vector3d, 3>& triangle, double pad) noexcept
    : reach_(0.5 + pad) {
  std::copy(triangle.begin(), triangle.end(), whole_.corners.begin());
  whole_.count = 3;
}

const ClippedTriangle& TriangleSlicer::cube(std::uint32_t x, std::uint32_t y,
                                            std::uint32_t z) noexcept {
  if (in_layer_ == nullptr || x != x_) {
    in_layer_ = &clip_between(whole_, 0, (x + 0.5) - reach_, (x + 0.5) + reach_, layer_);
    in_row_ = nullptr;
    x_ = x;
  }
  if (in_row_ == nullptr || y != y_) {
    in_row_ = &clip_between(*in_layer_, 1, (y + 0.5) - reach_, (y + 0.5) + reach_, row_);
    y_ = y;
  }
  return clip_between(*in_row_, 2, (z + 0.5) - reach_, (z + 0.5) + reach_, cube_);
}

}  // namespace ist
