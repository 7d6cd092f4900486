#include "ist/measure/distances_of.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "ist/base/parallel.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

// Points that one thread takes at a time. Neighbours in the list are often near each other.
constexpr std::size_t kGrain = 256;
// Points between two questions whether to go on: a few ms.
constexpr std::size_t kAtOnce = 1 << 14;

SurfaceDistance with_sign(const LeafTriangles& body, const NearestTriangle& nearest,
                          const Vector& point) {
  const Side side = body.side_of(point, nearest);
  const double distance = std::sqrt(nearest.square);
  return {side == Side::kInside ? -distance : distance, nearest.on.point, nearest.triangle,
          side != Side::kUnknown, !body.sides().self_intersections().pairs.empty()};
}

}  // namespace

SurfaceDistance beyond_reach() {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return {kNone, {kNone, kNone, kNone}, SurfaceDistance::kNoTriangle, false, false};
}

std::vector<SurfaceDistance> distances_of(const SphereTree& tree, const PointSearch& search,
                                          std::span<const Vector> points, double reach,
                                          const Proceed& proceed) {
  std::vector<SurfaceDistance> out(points.size());
  const LeafTriangles& body = *parts_of(tree).triangles;
  static_cast<void>(body.sides());  // made here, so that its loops have all threads
  for (std::size_t done = 0; done < points.size(); done += kAtOnce) {
    if (proceed && !proceed(static_cast<double>(done) / static_cast<double>(points.size()))) {
      out.resize(done);
      return out;
    }
    const std::size_t count = std::min(kAtOnce, points.size() - done);
    parallel_for(count, kGrain, [&](std::size_t begin, std::size_t end) {
      std::optional<std::uint32_t> last;
      for (std::size_t i = done + begin; i < done + end; ++i) {
        const std::optional<NearestTriangle> nearest = search.nearest(points[i], reach, last);
        out[i] = nearest ? with_sign(body, *nearest, points[i]) : beyond_reach();
        if (nearest) last = nearest->triangle;
      }
    });
  }
  return out;
}

}  // namespace ist
