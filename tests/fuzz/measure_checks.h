#pragma once

#include <Eigen/Geometry>

#include "fuzz/query_checks.h"
#include "ist/query/query.h"

namespace ist::test {

/// All that can be measured of two trees, and what holds of any measure: it ends, it is finite, and
/// measures of one pose do not contradict each other, nor the exact verdict.
class MeasureChecks {
 public:
  /// Both trees must hold triangles, and outlive it.
  MeasureChecks(const SphereTree& fixed, const SphereTree& moving, QueryChecks::Trees trees);

  /// Throws Finding.
  void at(const Eigen::Isometry3d& pose);

 private:
  void check_invalid(const Eigen::Isometry3d& pose);
  void check_map(const SphereTree& body, const SphereTree& other, const Eigen::Isometry3d& pose);
  void check_depth(const Eigen::Isometry3d& pose, const IntersectionResult& verdict);
  void check_first_contact(const Eigen::Isometry3d& pose, const IntersectionResult& verdict);
  void check_occlusion(const Eigen::Isometry3d& pose);

  const SphereTree& fixed_;
  const SphereTree& moving_;
  bool built_;
  double size_;  // of both bodies
  Query query_;
};

}  // namespace ist::test
