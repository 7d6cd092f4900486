#include "advise/closing_path.h"

#include <algorithm>

#include "ist/base/assert.h"
#include "ist/base/float_environment.h"

namespace ist {
namespace {

// Lengths as fractions of the smaller body's largest extent, except kDepth, of its diagonal, and
// kOfTheWay, of the way until the bodies have passed each other.
constexpr double kFirstStep = 0x1p-10, kOfTheWay = 0x1p-12, kAccuracy = 0x1p-20, kBefore = 0.02,
                 kDepth = 0.01;

// Returns the displacement at which the moving box is beyond the fixed one, mesh units.
double open_distance(const Eigen::AlignedBox3d& fixed, const Eigen::AlignedBox3d& moving,
                     AxisDirection direction) {
  return direction.sign > 0 ? fixed.max()[direction.axis] - moving.min()[direction.axis]
                            : moving.max()[direction.axis] - fixed.min()[direction.axis];
}

// Two offsets, mesh units: the bodies are free at `free` and not at `blocked`.
struct Bracket {
  double blocked, free;
};

Bracket open(ExactBodies& bodies, const ClosingPath& path, double step, double apart) {
  Bracket offsets{0, step};
  while (offsets.free < apart && !bodies.free(path.pose(offsets.free))) {
    offsets = {offsets.free, 2 * offsets.free};
  }
  return {offsets.blocked, std::min(offsets.free, apart)};
}

// Steps inwards from a free offset, by the distance between the bodies; by `least`, or 1/4096 of
// the way, where that is more. Returns nothing if the bodies pass each other.
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

// Bisects for first contact.
double bisect_first_contact(ExactBodies& bodies, const ClosingPath& path, Bracket offsets) {
  while (offsets.free - offsets.blocked > path.accuracy) {
    const double middle = 0.5 * (offsets.blocked + offsets.free);
    (bodies.free(path.pose(middle)) ? offsets.free : offsets.blocked) = middle;
  }
  return offsets.blocked;
}

const Eigen::AlignedBox3d& smaller_box(const ExactBodies& bodies) {
  const Eigen::AlignedBox3d &fixed = bodies.fixed_box(), &moving = bodies.moving_box();
  return moving.diagonal().norm() < fixed.diagonal().norm() ? moving : fixed;
}

}  // namespace

Eigen::Isometry3d ClosingPath::pose(double offset) const noexcept {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = turn;
  pose.translation() = (about - turn * about) + offset * open_direction;
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

AxisDirection shortest_open_direction(const Eigen::AlignedBox3d& fixed,
                                      const Eigen::AlignedBox3d& moving) {
  const ScopedFloatEnvironment environment;
  AxisDirection best;
  for (const int axis : {0, 1, 2}) {
    for (const int sign : {+1, -1}) {
      const AxisDirection direction{axis, sign};
      if (open_distance(fixed, moving, direction) < open_distance(fixed, moving, best)) {
        best = direction;
      }
    }
  }
  return best;
}

std::optional<ClosingPath> find_closing_path(ExactBodies& bodies, AxisDirection open_direction) {
  const ScopedFloatEnvironment environment;
  const Eigen::AlignedBox3d &fixed = bodies.fixed_box(), &moving = bodies.moving_box();
  const double extent = smaller_box(bodies).diagonal().maxCoeff();
  ClosingPath path{.open_direction = open_direction.vector(), .accuracy = kAccuracy * extent};
  const bool is_free = bodies.free(path.pose(0));
  const double step = kFirstStep * extent;
  const std::optional<Bracket> found =
      is_free ? close(bodies, path, 0, step,
                      -open_distance(fixed, moving, {open_direction.axis, -open_direction.sign}))
              : open(bodies, path, step, open_distance(fixed, moving, open_direction) + step);
  if (!found) return std::nullopt;
  path.first_contact = bisect_first_contact(bodies, path, *found);
  path.begin = path.first_contact + path.accuracy + kBefore * extent;
  path.end = std::min(0.0, path.first_contact - kDepth * smaller_box(bodies).diagonal().norm());
  return path;
}

std::vector<ClosingPath> paths_beside(ExactBodies& bodies, const ClosingPath& path) {
  constexpr double kInclined = 0.364, kHalfTurned = 0.0262;  // tangents of 20 and of 1.5 degrees
  // The cosines and sines of sixths of a turn.
  constexpr double kHalf = 0.5, kRoot = 0.8660254037844386;
  constexpr double kSixths[][2] = {{1, 0},  {kHalf, kRoot},   {-kHalf, kRoot},
                                   {-1, 0}, {-kHalf, -kRoot}, {kHalf, -kRoot}};
  const ScopedFloatEnvironment environment;
  Eigen::Index least = 0;
  path.open_direction.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d u = path.open_direction.cross(Eigen::Vector3d::Unit(least)).normalized();
  const Eigen::Vector3d v = path.open_direction.cross(u);
  const double extent = smaller_box(bodies).diagonal().maxCoeff();
  std::vector<ClosingPath> beside;
  for (const auto& [cosine, sine] : kSixths) {
    ClosingPath tilted = path;
    tilted.open_direction =
        (path.open_direction + kInclined * (cosine * u + sine * v)).normalized();
    // The axis is neither parallel nor normal to the path, so that the whole body turns.
    const Eigen::Vector3d axis = kHalfTurned * (sine * u + cosine * path.open_direction);
    tilted.turn = Eigen::Quaterniond(1, axis[0], axis[1], axis[2]).normalized().toRotationMatrix();
    tilted.about = bodies.moving_box().center();
    double free = path.begin;
    for (int tries = 0; tries < 4 && !bodies.free(tilted.pose(free)); ++tries) {
      free += kBefore * extent;
    }
    if (!bodies.free(tilted.pose(free))) continue;
    const auto found =
        close(bodies, tilted, free, kFirstStep * extent, path.first_contact - 0.5 * extent);
    if (!found) continue;
    tilted.first_contact = tilted.end = bisect_first_contact(bodies, tilted, *found);
    tilted.begin = tilted.first_contact + tilted.accuracy + kBefore * extent;
    beside.push_back(tilted);
  }
  return beside;
}

}  // namespace ist
