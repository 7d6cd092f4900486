#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "ist/query/manifold.h"
#include "ist/query/query.h"
#include "ist/query/reference/reference_query.h"
#include "support/exact_query.h"
#include "support/stability.h"

namespace ist::test {

/// The results about one hard shape: a line each in perf/STABILITY.md.
struct ShapeCases {
  explicit ShapeCases(const std::string& shape);

  StabilityCase voxels;      ///< how far a triangle is from a voxel that lists it
  StabilityCase leaf_pairs;  ///< how far bounds in an answer are apart
  StabilityCase gap;         ///< how far the distance is outside its interval
  StabilityCase answers;     ///< all that is only right or wrong
};

/// Samples how far the triangles in each voxel's list are from its cube, in parts of the pad of the
/// build, against rationals; a triangle that meets a cube and is not in its list is infinitely far.
void check_voxels(const SphereTree& tree, StabilityCase& voxels);

/// Two small bodies, and all that can be asked about them: every policy, every target, one worker
/// and two, held against rational numbers.
class HardPair {
 public:
  HardPair(const TriangleMesh& fixed, double fixed_voxel, const TriangleMesh& moving,
           double moving_voxel);

  [[nodiscard]] const SphereTree& fixed() const { return fixed_; }
  [[nodiscard]] const SphereTree& moving() const { return moving_; }

  /// Leaf pairs keep their guarantee, triangle pairs are those that meet, the gap holds the
  /// distance, contact points are finite, and all engines give the same bits. Returns whether they
  /// touch.
  bool check(const Eigen::Isometry3d& pose, ShapeCases& cases);

 private:
  struct Asked {
    Asked(const SphereTree& fixed, const SphereTree& moving, SpherePolicy by);

    SpherePolicy policy;
    ReferenceQuery reference;
    ContactManifold points;
    std::vector<std::unique_ptr<Query>> engines;  // the last one with two workers
  };
  void check_leaf_pairs(Asked& asked, const ExactPair& exact, const Eigen::Isometry3d& pose,
                        ShapeCases& cases);
  void check_contact_points(Asked& asked, const Eigen::Isometry3d& pose, StabilityCase& answers);
  void check_gap(Query& query, double distance, const Eigen::Isometry3d& pose, StabilityCase& gap);

  SphereTree fixed_, moving_;              // with their triangles
  SphereTree plain_fixed_, plain_moving_;  // and without
  ExactBody exact_fixed_, exact_moving_;
  double longest_edge_, largest_coordinate_ = 0;
  std::vector<std::unique_ptr<Asked>> asked_;
};

}  // namespace ist::test
