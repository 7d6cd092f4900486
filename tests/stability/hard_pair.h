#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "ist/query/manifold.h"
#include "ist/query/query.h"
#include "ist/query/reference/reference_query.h"
#include "ist/query/results.h"
#include "ist/tree/sphere_tree.h"
#include "support/exact_query.h"
#include "support/stability.h"

namespace ist::test {

/// Returns the overlap of the bounds of two leaves, in mesh units, below 0 if they are apart. A
/// search finds the pair if it is positive. It is the least of the overlaps that the search tests:
/// of the balls, and of each ball with the other's slab. In double, without a pad. `between` is the
/// motion of between_frames().
[[nodiscard]] double leaf_overlap(const SphereTree& fixed, const SphereTree& moving,
                                  SpherePolicy policy, const Eigen::Isometry3d& between,
                                  const LeafPair& pair);

/// The results about one hard shape: a line each in perf/STABILITY.md.
struct ShapeCases {
  explicit ShapeCases(const std::string& shape);

  StabilityCase voxels;      ///< how far a triangle is from a voxel that lists it
  StabilityCase leaf_pairs;  ///< how far bounds in an answer are apart
  StabilityCase gap;         ///< how far the distance is outside its interval
  StabilityCase answers;     ///< answers that are right or wrong
};

/// Samples how far the triangles in each voxel's list are from its cube, in parts of the pad of the
/// build, against rationals; a triangle that meets a cube and is not in its list is infinitely far.
void check_voxels(const SphereTree& tree, StabilityCase& voxels);

/// Asks two small bodies every question, with every policy and target, with one worker and with
/// two. Compares the answers with rational numbers.
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
