#include "ist/query/advice/closing_path.h"

#include <algorithm>

#include "ist/base/assert.h"
#include "ist/base/float_environment.h"

namespace ist {
namespace {

// In parts of the smaller body's largest extent, but the depth, which is of its diagonal.
constexpr double kFirstStep = 0x1p-10, kAccuracy = 0x1p-20, kBefore = 0.02, kDepth = 0.01;

// How far the box must go until it is beyond the other.
double leaving(const Eigen::AlignedBox3d& fixed, const Eigen::AlignedBox3d& moving, Way way) {
  return way.sign > 0 ? fixed.max()[way.axis] - moving.min()[way.axis]
                      : moving.max()[way.axis] - fixed.min()[way.axis];
}

struct Bracket {
  double touching, free;
};

Bracket open(ExactBodies& bodies, const ClosingPath& path, double step, double apart) {
  Bracket places{0, step};
  while (places.free < apart && !bodies.free(path.pose(places.free))) {
    places = {places.free, 2 * places.free};
  }
  return {places.touching, std::min(places.free, apart)};
}

std::optional<Bracket> close(ExactBodies& bodies, const ClosingPath& path, double least,
                             double passed) {
  for (double free = 0; free > -passed;) {
    const double distance = bodies.distance(path.pose(free), least).lower;
    const double next = free - std::max(distance, least);
    if (!bodies.free(path.pose(next))) return Bracket{next, free};
    free = next;
  }
  return std::nullopt;
}

}  // namespace

Eigen::Isometry3d ClosingPath::pose(double place) const noexcept {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = place * opening.vector();
  return pose;
}

std::vector<Eigen::Isometry3d> ClosingPath::poses(std::size_t count) const {
  IST_ASSERT(count >= 2);
  const ScopedFloatEnvironment environment;
  std::vector<Eigen::Isometry3d> result;
  for (std::size_t i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(count - 1);
    result.push_back(pose((1 - part) * begin + part * end));
  }
  return result;
}

Way opening_of(const Eigen::AlignedBox3d& fixed, const Eigen::AlignedBox3d& moving) {
  const ScopedFloatEnvironment environment;
  Way best;
  for (const int axis : {0, 1, 2}) {
    for (const int sign : {+1, -1}) {
      const Way way{axis, sign};
      if (leaving(fixed, moving, way) < leaving(fixed, moving, best)) best = way;
    }
  }
  return best;
}

std::optional<ClosingPath> find_closing_path(ExactBodies& bodies, Way opening) {
  const ScopedFloatEnvironment environment;
  const Eigen::AlignedBox3d &fixed = bodies.fixed_box(), &moving = bodies.moving_box();
  const Eigen::AlignedBox3d& smaller =
      moving.diagonal().norm() < fixed.diagonal().norm() ? moving : fixed;
  const double extent = smaller.diagonal().maxCoeff();
  ClosingPath path{opening, 0, 0, 0, kAccuracy * extent};
  const bool is_free = bodies.free(path.pose(0));
  const double step = kFirstStep * extent;
  const std::optional<Bracket> found =
      is_free ? close(bodies, path, step, leaving(fixed, moving, {opening.axis, -opening.sign}))
              : open(bodies, path, step, leaving(fixed, moving, opening) + step);
  if (!found) return std::nullopt;
  auto [touching, free] = *found;
  while (free - touching > path.accuracy) {
    const double middle = 0.5 * (touching + free);
    (bodies.free(path.pose(middle)) ? free : touching) = middle;
  }
  path.touch = touching;
  path.begin = free + kBefore * extent;
  path.end = is_free ? touching - kDepth * smaller.diagonal().norm() : 0;
  return path;
}

}  // namespace ist
