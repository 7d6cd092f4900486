#include "ist/query/advice/closing_path.h"

#include <algorithm>

#include "ist/base/assert.h"
#include "ist/base/float_environment.h"

namespace ist {
namespace {

// In parts of the smaller body's largest extent, but the depth, which is of its diagonal, and what
// is of the way until the bodies have passed each other.
constexpr double kFirstStep = 0x1p-10, kOfTheWay = 0x1p-12, kAccuracy = 0x1p-20, kBefore = 0.02,
                 kDepth = 0.01;

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

// From a free place inwards, by steps that reach no farther than the bodies are apart, but for
// `least` and what would make them more than some 4,000.
std::optional<Bracket> close(ExactBodies& bodies, const ClosingPath& path, double free,
                             double least, double passed) {
  least = std::max(least, kOfTheWay * (free - passed));
  while (free > passed) {
    const double distance = bodies.distance(path.pose(free), least).lower;
    const double next = free - std::max(distance, least);
    if (!bodies.free(path.pose(next))) return Bracket{next, free};
    free = next;
  }
  return std::nullopt;
}

// The place of the touch between two of which one is free.
double touch_in(ExactBodies& bodies, const ClosingPath& path, Bracket places) {
  while (places.free - places.touching > path.accuracy) {
    const double middle = 0.5 * (places.touching + places.free);
    (bodies.free(path.pose(middle)) ? places.free : places.touching) = middle;
  }
  return places.touching;
}

const Eigen::AlignedBox3d& smaller_box(const ExactBodies& bodies) {
  const Eigen::AlignedBox3d &fixed = bodies.fixed_box(), &moving = bodies.moving_box();
  return moving.diagonal().norm() < fixed.diagonal().norm() ? moving : fixed;
}

}  // namespace

Eigen::Isometry3d ClosingPath::pose(double place) const noexcept {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = turn;
  pose.translation() = (about - turn * about) + place * opening;
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
  const double extent = smaller_box(bodies).diagonal().maxCoeff();
  ClosingPath path{.opening = opening.vector(), .accuracy = kAccuracy * extent};
  const bool is_free = bodies.free(path.pose(0));
  const double step = kFirstStep * extent;
  const std::optional<Bracket> found =
      is_free ? close(bodies, path, 0, step, -leaving(fixed, moving, {opening.axis, -opening.sign}))
              : open(bodies, path, step, leaving(fixed, moving, opening) + step);
  if (!found) return std::nullopt;
  path.touch = touch_in(bodies, path, *found);
  path.begin = path.touch + path.accuracy + kBefore * extent;
  path.end = std::min(0.0, path.touch - kDepth * smaller_box(bodies).diagonal().norm());
  return path;
}

std::vector<ClosingPath> paths_beside(ExactBodies& bodies, const ClosingPath& path) {
  constexpr double kInclined = 0.364, kHalfTurned = 0.0262;  // tangents of 20 and of 1.5 degrees
  // Sixths of a turn in a plane, their cosines and sines.
  constexpr double kHalf = 0.5, kRoot = 0.8660254037844386;
  constexpr double kSixths[][2] = {{1, 0},  {kHalf, kRoot},   {-kHalf, kRoot},
                                   {-1, 0}, {-kHalf, -kRoot}, {kHalf, -kRoot}};
  const ScopedFloatEnvironment environment;
  Eigen::Index least = 0;
  path.opening.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d u = path.opening.cross(Eigen::Vector3d::Unit(least)).normalized();
  const Eigen::Vector3d v = path.opening.cross(u);
  const double extent = smaller_box(bodies).diagonal().maxCoeff();
  std::vector<ClosingPath> beside;
  for (const auto& [cosine, sine] : kSixths) {
    ClosingPath way = path;
    way.opening = (path.opening + kInclined * (cosine * u + sine * v)).normalized();
    // About an axis that is neither the way nor square to it, so that all of it turns.
    const Eigen::Vector3d axis = kHalfTurned * (sine * u + cosine * path.opening);
    way.turn = Eigen::Quaterniond(1, axis[0], axis[1], axis[2]).normalized().toRotationMatrix();
    way.about = bodies.moving_box().center();
    double free = path.begin;
    for (int tries = 0; tries < 4 && !bodies.free(way.pose(free)); ++tries) {
      free += kBefore * extent;
    }
    if (!bodies.free(way.pose(free))) continue;
    const auto found = close(bodies, way, free, kFirstStep * extent, path.touch - 0.5 * extent);
    if (!found) continue;
    way.touch = way.end = touch_in(bodies, way, *found);
    way.begin = way.touch + way.accuracy + kBefore * extent;
    beside.push_back(way);
  }
  return beside;
}

}  // namespace ist
