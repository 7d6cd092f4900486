#include "ist/measure/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/rigid_move.h"
#include "ist/base/throw_error.h"
#include "ist/measure/first_contact.h"
#include "ist/measure/require.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

constexpr double kFarthest = 1e15;  // as of a motion

bool is_near(const Vector& at) { return at.cwiseAbs().maxCoeff() <= kFarthest && at.allFinite(); }

// Two contacts that may be one.
struct Candidate {
  double square;  // of the distance of their centres
  std::uint32_t before, after;
};

void require_contacts(std::span<const PlacedContact> contacts, const char* name) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (is_near(contacts[i].centre)) continue;
    throw_error(ErrorCode::kArgumentInvalid,
                "{}: the centre of contact {} is not finite, or beyond {:g}", name, i, kFarthest);
  }
}

std::vector<Candidate> candidates(std::span<const PlacedContact> before,
                                  std::span<const PlacedContact> after, double within) {
  std::vector<Candidate> found;
  for (std::uint32_t b = 0; b < before.size(); ++b) {
    for (std::uint32_t a = 0; a < after.size(); ++a) {
      const double square = square_in_order(difference(before[b].centre, after[a].centre));
      if (square > within * within) continue;
      const int one = before[b].tooth, other = after[a].tooth;
      if (one == 0 || other == 0 || one == other) found.push_back({square, b, a});
    }
  }
  // Pairs of equal rank share no contact, so that an exchange of the bites changes nothing.
  std::sort(found.begin(), found.end(), [](const Candidate& x, const Candidate& y) {
    if (x.square != y.square) return x.square < y.square;
    const auto [low_x, high_x] = std::minmax(x.before, x.after);
    const auto [low_y, high_y] = std::minmax(y.before, y.after);
    if (high_x != high_y) return high_x < high_y;
    return low_x != low_y ? low_x < low_y : x.before < y.before;
  });
  return found;
}

}  // namespace

PoseChange pose_change(const Eigen::Isometry3d& before, const Eigen::Isometry3d& after,
                       const Vector& about) {
  const ScopedFloatEnvironment environment;
  if (!is_near(about)) {
    throw_error(ErrorCode::kArgumentInvalid,
                "about: ({}, {}, {}) is not finite, or beyond {:g}: give a nearer point", about[0],
                about[1], about[2], kFarthest);
  }
  const Motion screw = Motion::between(before, after);
  const Eigen::Isometry3d first = require_rigid(before, "before"),
                          last = require_rigid(after, "after");
  PoseChange change;
  change.about = about;
  const Vector in_body = RigidMove(inverse_of(first))(about);
  change.translation = difference(RigidMove(last)(in_body), about);
  change.axis = screw.axis();
  change.angle = screw.angle();
  change.along = screw.along();
  change.rotation = scaled(change.angle, change.axis);
  change.rotation_error = screw.rotation_error();
  if (change.angle > 0) {
    const Vector away = difference(about, screw.point());
    change.axis_point = sum(screw.point(), scaled(dot_in_order(away, change.axis), change.axis));
  } else if (!(change.along > 0)) {
    change.axis = Vector::Zero();
  }
  return change;
}

std::vector<ContactMatch> match_contacts(std::span<const PlacedContact> before,
                                         std::span<const PlacedContact> after, double within) {
  const ScopedFloatEnvironment environment;
  require_contacts(before, "before");
  require_contacts(after, "after");
  if (!(within >= 0)) {
    throw_error(ErrorCode::kArgumentInvalid, "within: {} is no distance: give 0 or more", within);
  }
  std::vector<ContactMatch> matches(before.size());
  for (std::uint32_t b = 0; b < before.size(); ++b) matches[b].before = b;
  std::vector<std::uint8_t> is_taken(after.size());
  for (const Candidate& one : candidates(before, after, within)) {
    if (matches[one.before].after || is_taken[one.after] != 0) continue;
    matches[one.before].after = one.after;
    matches[one.before].moved = std::sqrt(one.square);
    is_taken[one.after] = 1;
  }
  for (std::uint32_t a = 0; a < after.size(); ++a) {
    if (is_taken[a] == 0) matches.push_back({std::nullopt, a});
  }
  return matches;
}

std::vector<double> distance_change(std::span<const SurfaceDistance> before,
                                    std::span<const SurfaceDistance> after) {
  if (before.size() != after.size()) {
    throw_error(ErrorCode::kArgumentInvalid,
                "the maps have {} and {} vertices: compare maps of one mesh", before.size(),
                after.size());
  }
  const ScopedFloatEnvironment environment;
  std::vector<double> change(before.size());
  for (std::size_t v = 0; v < before.size(); ++v) {
    change[v] = before[v].is_signed == after[v].is_signed
                    ? after[v].distance - before[v].distance
                    : std::numeric_limits<double>::quiet_NaN();
  }
  return change;
}

}  // namespace ist
