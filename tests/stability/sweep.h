#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/manifold.h"
#include "ist/query/query.h"
#include "query/contacts/plain_contacts.h"
#include "support/stability.h"

namespace ist::test {

/// A way of the moving body, step by step.
struct Path {
  std::function<Eigen::Isometry3d(int step)> at;
  int steps;
  double motion;  ///< of a step, as ContactRates counts it
  double way;     ///< no point of the moving body goes farther in a step
  bool straight;  ///< it does not turn: so each pair's bounds meet in one interval of it
};

/// Moved by `step` times the step's number along `direction`, a unit vector.
[[nodiscard]] Path line(const Eigen::Isometry3d& from, const Eigen::Vector3d& direction,
                        double step, int steps);
/// Turned about `centre`, moving mesh coordinates, so that a point `lever` from it goes `step`, and
/// none of the body, within `reach` of it, goes farther than its part of that.
[[nodiscard]] Path turn(const Eigen::Isometry3d& from, const Eigen::Vector3d& axis,
                        const Eigen::Vector3d& centre, double lever, double reach, double step,
                        int steps);

/// The results about motion with one policy: a line each in perf/STABILITY.md.
struct MotionCases {
  MotionCases(const std::string& what, SpherePolicy policy);

  StabilityCase edges;  ///< how far the search's bounds overlap at the step where a pair changes
  StabilityCase once;   ///< how far they overlap where a pair is missing between two steps
  StabilityCase gap;    ///< how fast the distance changes
  StabilityCase sums;   ///< how fast the sums of the contacts change, by their rates
  StabilityCase depth;  ///< how fast the depth of a pair changes
};

/// Moves one body along paths and looks at what changes from each step to the next.
///
/// The guarantee of a leaf pair in motion: it is in the answer while its bounds overlap, and each
/// test is whether two balls, or a ball and a slab, are near enough. So it enters and leaves where
/// the least overlap of them all passes between 0 and the pad. Along a straight line that overlap
/// is a concave function: the pair is there in one interval, and comes and goes only while the
/// overlap is within the pad. A body that turns may come back.
class Sweep {
 public:
  /// Trees with triangles for `fixed` and `moving`, without for the plain ones; of one build.
  Sweep(const SphereTree& fixed, const SphereTree& moving, const SphereTree& plain_fixed,
        const SphereTree& plain_moving, SpherePolicy policy, MotionCases& cases);

  void along(const Path& path);

  /// Pairs that entered or left in all paths.
  [[nodiscard]] std::size_t changes() const { return changes_; }
  /// By which ContactRates counts turns.
  [[nodiscard]] double lever() { return points_.rates().lever; }

 private:
  struct Step {
    Eigen::Isometry3d pose;
    double pad;
    std::vector<LeafPair> pairs;
    ContactSums sums;
    double stretched;  // the sum of w (d + 2s) of all points
    DistanceInterval exact, plain;
  };
  [[nodiscard]] Step look(const Eigen::Isometry3d& pose);
  [[nodiscard]] double overlap(const LeafPair& pair, const Eigen::Isometry3d& pose) const;
  void compare_pairs(const Step& before, const Step& now);
  void find_returns(const Path& path, int step, const Step& now);
  void compare_gap(const Step& before, const Step& now, double way);
  void compare_sums(const Step& before, const Step& now, double motion);
  void compare_depths(const Step& before, const Step& now, double motion);

  const SphereTree& fixed_;
  const SphereTree& moving_;
  SpherePolicy policy_;
  MotionCases& cases_;
  Query exact_, plain_;
  ContactManifold points_;
  PlainContacts contacts_;
  std::unordered_map<std::uint64_t, int> last_seen_;  // step, by pair
  std::size_t changes_ = 0;
};

}  // namespace ist::test
