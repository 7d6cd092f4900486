#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "ist/constraint/features.h"
#include "ist/constraint/nearest_motion.h"
#include "ist/constraint/surface.h"
#include "ist/measure/free_test.h"
#include "ist/measure/settle_frame.h"
#include "ist/query/query.h"

namespace ist {

/// Shortens a motion that frees two bodies. The coordinates of a motion are those of a SettleFrame
/// at the given pose, about the middle of the moving body.
///
/// Each step solves a quadratic program: the features of the surfaces that are near each other stay
/// apart, to first order, and the weighted mean square of the ways of the body's outermost points
/// becomes least. Points that go farther get more weight, so that the longest way becomes least.
/// Source of the weights: C. L. Lawson, Contributions to the theory of linear least maximum
/// approximation, dissertation, University of California at Los Angeles, 1961.
class EscapeSteps {
 public:
  /// Refers to all but `pose`, which is rigid.
  EscapeSteps(Query& query, FreeTest& free, const Eigen::Isometry3d& pose, double tolerance);

  /// Shortens a motion. The bodies are free after it, before and after the call.
  /// @param turns whether the motion may turn the body
  void shorten(Vector6& motion, bool turns);

  [[nodiscard]] Eigen::Isometry3d pose_after(const Vector6& motion) const noexcept {
    return frame_.pose_at(motion);
  }

 private:
  // The way of an outermost point after a motion, and its derivative.
  struct Way {
    Eigen::Vector3d way;
    Eigen::Vector3d by_turn[3];
  };
  struct Step {
    Vector6 motion;  // turns count as ways at the radius
    double longest;  // way of the outermost points after it, to first order
  };

  bool look(const Vector6& at);
  void bound(const Vector6& at, FeatureList::Which which, bool turns);
  void find_ways(const Vector6& at);
  [[nodiscard]] double longest(const Vector6& at) const noexcept;
  [[nodiscard]] Matrix6 metric() const noexcept;
  [[nodiscard]] Step step(const Vector6& at, bool turns);
  [[nodiscard]] Eigen::Vector3d way_after(std::size_t point, const Vector6& step) const noexcept;
  void touch(Vector6& at);

  Query& query_;
  FreeTest& free_;
  SettleFrame frame_;
  Eigen::Vector3d middle_;
  double radius_;  // the length by which turns count
  double tolerance_, skin_;
  double trust_ = 0;
  std::vector<Eigen::Vector3d> outermost_;       // of the moving body, its coordinates
  std::vector<Eigen::Vector3d> outermost_then_;  // at the given pose
  std::vector<Way> ways_;
  std::vector<double> weights_;
  Surface fixed_, moving_;
  FeatureList features_;
  std::vector<NearPair> near_;
  std::size_t near_count_ = 0;
  NearestMotion nearest_;
};

}  // namespace ist
