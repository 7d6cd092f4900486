#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "ist/base/rigid_move.h"
#include "ist/measure/free_test.h"
#include "ist/query/query.h"

namespace ist {

/// Returns directions in which the moving body may be freed soon, unit vectors, fixed axes: the
/// most promising first. Precondition: `pose` is rigid.
/// @param deepest the shortest way out of the deepest point, zero if none is known
[[nodiscard]] std::vector<Eigen::Vector3d> escape_directions(Query& query,
                                                             const Eigen::Isometry3d& pose,
                                                             const Eigen::Vector3d& deepest);

/// Finds where translations from a pose free two bodies.
class EscapeLines {
 public:
  /// Refers to all. Precondition: the bodies are not free at `pose`.
  /// @param least     no shorter way is free, mesh units
  /// @param tolerance a way ends so near a pose that is not free, mesh units
  EscapeLines(FreeTest& free, const Query& query, const Eigen::Isometry3d& pose, double least,
              double tolerance);

  /// Returns a way along a direction after which the bodies are free, and before which they are not
  /// free. It is no longer than `most`. Steps grow: the line may leave out a shorter one.
  [[nodiscard]] std::optional<double> way(const Eigen::Vector3d& direction, double most);

 private:
  FreeTest& free_;
  const Eigen::Isometry3d& pose_;
  double least_, tolerance_;
  double apart_;  // after this way the bodies are apart
};

/// Returns the least part of a motion that frees the bodies, and before which they are not free.
/// Steps back from 1 grow.
/// @param pose_at tells the pose after a part of the motion; at 1 the bodies are free, at 0 not
/// @param step    the first step, a part of the motion
template <class PoseAt>
[[nodiscard]] double shortened(FreeTest& free, const PoseAt& pose_at, double step) {
  double good = 1, bad = 0;
  for (double by = step; by < 1; by *= 2) {
    if (!free.at(pose_at(1 - by))) {
      bad = 1 - by;
      break;
    }
    good = 1 - by;
  }
  while (good - bad > 0.25 * step && !free.is_ended()) {
    const double middle = 0.5 * (good + bad);
    (free.at(pose_at(middle)) ? good : bad) = middle;
  }
  return good;
}

}  // namespace ist
