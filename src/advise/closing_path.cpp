#include "advise/closing_path.h"

#include <algorithm>

#include "ist/base/assert.h"
#include "ist/base/float_environment.h"
#include "ist/measure/first_contact.h"
#include "ist/mesh/bounding_box.h"

namespace ist {
namespace {

// Returns the displacement that takes the moving box beyond the fixed one, mesh units.
double open_distance(const Eigen::AlignedBox3d& fixed, const Eigen::AlignedBox3d& moving,
                     AxisDirection direction) {
  return direction.sign > 0 ? fixed.max()[direction.axis] - moving.min()[direction.axis]
                            : moving.max()[direction.axis] - fixed.min()[direction.axis];
}

}  // namespace

Eigen::Isometry3d ClosingPath::pose(double offset) const noexcept {
  return Eigen::Isometry3d(Eigen::Translation3d(offset * open_direction));
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

AxisDirection shortest_open_direction(const SphereTree& fixed, const SphereTree& moving) {
  const ScopedFloatEnvironment environment;
  const Eigen::AlignedBox3d a = bounding_box(*fixed.triangles());
  const Eigen::AlignedBox3d b = bounding_box(*moving.triangles());
  AxisDirection best;
  for (const int axis : {0, 1, 2}) {
    for (const int sign : {+1, -1}) {
      if (open_distance(a, b, {axis, sign}) < open_distance(a, b, best)) best = {axis, sign};
    }
  }
  return best;
}

std::optional<ClosingPath> find_closing_path(Query& exact, AxisDirection open_direction) {
  // Fractions of the smaller body's largest extent, and of its diagonal.
  constexpr double kAccuracy = 0x1p-20, kBefore = 0.02, kDepth = 0.01;
  const ScopedFloatEnvironment environment;
  const Eigen::AlignedBox3d fixed = bounding_box(*exact.fixed().triangles());
  const Eigen::AlignedBox3d moving = bounding_box(*exact.moving().triangles());
  const Eigen::Vector3d size =
      moving.diagonal().norm() < fixed.diagonal().norm() ? moving.diagonal() : fixed.diagonal();
  const auto [axis, sign] = open_direction;
  const double extent = size.maxCoeff(), margin = kBefore * extent;
  const double passed = -open_distance(fixed, moving, {axis, -sign}) - margin;
  ClosingPath path{.open_direction = sign * Eigen::Vector3d::Unit(axis)};
  double from = 0;
  const auto close = [&] {
    return first_contact(exact, path.pose(from), path.pose(passed), kAccuracy * extent);
  };
  FirstContact found = close();
  using Status = FirstContact::Status;
  if (found.status == Status::kTouchesAtStart || found.status == Status::kInsideAtStart) {
    from = open_distance(fixed, moving, open_direction) + margin;
    found = close();
  }
  if (found.status != Status::kContact && found.status != Status::kGrazing) return std::nullopt;
  path.first_contact = from + found.lower * (passed - from);
  path.begin = path.first_contact + margin;
  path.end = std::min(0.0, path.first_contact - kDepth * size.norm());
  return path;
}

}  // namespace ist
