#include "ist/query/advice/contact_error.h"

#include <algorithm>
#include <vector>

#include "ist/base/float_environment.h"

namespace ist {
namespace {

constexpr int kHalvings = 16;

bool has_contacts(CollisionQuery& query, const Eigen::Isometry3d& pose) {
  return query.collide(pose, std::span<Contact>{}).contacts > 0;
}

// Halves the way from a pose with contacts to one without until its length is 2^-16 of what it was;
// the end that has contacts.
Eigen::Isometry3d first_contact(CollisionQuery& query, Eigen::Isometry3d with,
                                Eigen::Isometry3d without) {
  for (int i = 0; i < kHalvings; ++i) {
    Eigen::Isometry3d middle = with;
    middle.translation() = 0.5 * (with.translation() + without.translation());
    (has_contacts(query, middle) ? with : without) = middle;
  }
  return with;
}

}  // namespace

double closing_error(ExactBodies& bodies, CollisionQuery& query, double voxel_size,
                     const ClosingPath& path) {
  constexpr double kStep = 1.0 / 16, kOfTheWay = 1.0 / 64, kTolerance = 0x1p-10;
  const ScopedFloatEnvironment environment;
  const double tolerance = kTolerance * voxel_size;
  const auto next = [&](double place) {
    return place + std::max(kStep * voxel_size, kOfTheWay * (place - path.touch));
  };
  double error = 0, last = path.touch;
  for (double place = next(path.touch);; place = next(place)) {
    const GapInterval gap = bodies.distance(path.pose(place), tolerance);
    if (!(gap.upper > 0)) break;
    const QueryResult result = query.collide(path.pose(place), std::span<Contact>{});
    if (result.contacts > 0) {
      error = std::max(error, gap.upper);
      last = place;
    } else if (gap.lower > query.resolution(result)) {
      break;
    }
  }
  const Eigen::Isometry3d first = first_contact(query, path.pose(last), path.pose(next(last)));
  return std::max(error, bodies.distance(first, tolerance).upper);
}

double error_at_poses(ExactBodies& bodies, CollisionQuery& query,
                      std::span<const Eigen::Isometry3d> poses) {
  const ScopedFloatEnvironment environment;
  double error = 0;
  std::vector<bool> contacts;
  for (const Eigen::Isometry3d& pose : poses) {
    contacts.push_back(has_contacts(query, pose));
    if (contacts.back()) error = std::max(error, bodies.distance(pose, 0).upper);
  }
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (contacts[i] == contacts[i - 1] || poses[i].linear() != poses[i - 1].linear()) continue;
    const std::size_t with = contacts[i] ? i : i - 1, without = contacts[i] ? i - 1 : i;
    const Eigen::Isometry3d first = first_contact(query, poses[with], poses[without]);
    error = std::max(error, bodies.distance(first, 0).upper);
  }
  return error;
}

}  // namespace ist
