#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ist/mesh/mesh.h"
#include "ist/query/results.h"
#include "ist/tree/sphere_tree.h"
#include "support/exact.h"

namespace ist::test {

/// The leaves of one body in rational numbers, in the tree's frame: the axes and units of the mesh,
/// and the origin at corner + root_centre · voxel_size, which no double need hold.
///
/// The tree must outlive it. Cost: some 30 µs a triangle in a leaf, where the tree is tight.
class ExactBody {
 public:
  ExactBody(const TriangleMesh& mesh, const SphereTree& tree);

  [[nodiscard]] const SphereTree& tree() const { return tree_; }
  [[nodiscard]] std::uint32_t leaf_count() const { return tree_.leaf_count(); }
  [[nodiscard]] const ExactPoint& origin() const { return origin_; }

 private:
  friend class ExactPair;
  struct Polygon {
    ExactPolygon corners;
    std::vector<Eigen::Vector3d> rounded;
  };
  struct Bound {  // saved ball and slab, where the tree has them
    ExactPoint centre, normal;
    mpq_class radius, offset, half;
    Eigen::Vector3d rounded_centre;
  };
  struct Leaf {
    ExactPoint cube_centre;
    Eigen::Vector3d rounded_centre;
    std::vector<Polygon> polygons;  // of the triangles, clipped to the cube; empty if not tight
    Bound bound;
  };
  void unpack_bounds();

  const SphereTree& tree_;
  mpq_class voxel_size_;
  ExactPoint origin_;
  std::vector<Leaf> leaves_;
  double farthest_ = 0;  // no point of a leaf's cube is farther from the origin
};

/// Two bodies at a pose: what is true of each pair of leaves, decided in rational numbers after a
/// filter in double that never decides what is close.
///
/// This is the oracle of every query. It knows nothing of inner nodes: the guarantee is about
/// leaves alone. The pose is that of rigid_pose, number by number, so that its rotation is off
/// orthonormal by the rounding of that.
class ExactPair {
 public:
  /// Both bodies must outlive it; `pose` must be a rigid motion.
  ExactPair(const ExactBody& fixed, const ExactBody& moving, const Eigen::Isometry3d& pose);

  [[nodiscard]] const ExactBody& fixed() const { return fixed_; }
  [[nodiscard]] const ExactBody& moving() const { return moving_; }

  /// Whether what the spheres stand for meets: the closed cubes for `simple` and `table`, the
  /// triangles clipped to the closed cubes for `tight` and `slab`.
  [[nodiscard]] bool geometry_meets(SpherePolicy policy, std::uint32_t fixed_leaf,
                                    std::uint32_t moving_leaf) const;

  /// Whether the leaf balls come within `pad` of each other: d <= rA + rB + pad. The balls are
  /// the circumspheres of the true cubes, or for `tight` the saved ones; for `slab`, whether each
  /// of them also comes within `pad` of the other's slab. `pad` may be negative.
  [[nodiscard]] bool bounds_meet(SpherePolicy policy, std::uint32_t fixed_leaf,
                                 std::uint32_t moving_leaf, double pad) const;

  /// The translation between the two trees' frames.
  [[nodiscard]] const ExactPoint& translation() const { return translation_; }

 private:
  struct Axis {
    ExactPoint direction;
    mpq_class reach;  // how far both cubes together reach along it, from their centres
  };
  [[nodiscard]] ExactPoint in_fixed_frame(const ExactPoint& point) const;
  [[nodiscard]] bool cubes_meet(std::uint32_t fixed_leaf, std::uint32_t moving_leaf) const;
  [[nodiscard]] bool polygons_apart(const ExactBody::Polygon& fixed,
                                    std::span<const Eigen::Vector3d> moving) const;
  [[nodiscard]] bool slabs_met(const ExactBody::Bound& fixed, const ExactBody::Bound& moving,
                               const Eigen::Vector3d& apart, double pad) const;
  [[nodiscard]] bool triangles_meet(std::uint32_t fixed_leaf, std::uint32_t moving_leaf) const;

  const ExactBody& fixed_;
  const ExactBody& moving_;
  std::array<ExactPoint, 3> rotation_;
  ExactPoint translation_;
  std::vector<Axis> axes_;  // all that can separate two cubes
  Eigen::Matrix3d rounded_rotation_;
  Eigen::Vector3d rounded_translation_;
  double margin_;  // no double of the filter is farther from the truth
  std::vector<Eigen::Vector3d> moved_centres_;
  std::vector<std::vector<std::vector<Eigen::Vector3d>>> moved_polygons_;  // by leaf and polygon
};

/// Two bodies by their trees and in rational numbers.
struct RationalBodies {
  RationalBodies(const TriangleMesh& a, SphereTree tree_of_a, const TriangleMesh& b,
                 SphereTree tree_of_b)
      : fixed(std::move(tree_of_a)),
        moving(std::move(tree_of_b)),
        exact_fixed(a, fixed),
        exact_moving(b, moving) {}
  RationalBodies(const RationalBodies&) = delete;
  RationalBodies& operator=(const RationalBodies&) = delete;

  [[nodiscard]] ExactPair at(const Eigen::Isometry3d& pose) const {
    return {exact_fixed, exact_moving, pose};
  }

  SphereTree fixed, moving;
  ExactBody exact_fixed, exact_moving;
};

/// Whether an answer must have a pair of leaves: their bounds come within the margin, or where
/// bounds are not nested, their geometry meets.
[[nodiscard]] bool must_be_found(const ExactPair& pair, SpherePolicy policy,
                                 std::uint32_t fixed_leaf, std::uint32_t moving_leaf,
                                 bool nested = true, double margin = 0);

/// Whether an answer is what the design guarantees:
///   {leaf pairs that must be found} ⊆ answer ⊆ {leaf pairs whose bounds meet, within the pad},
/// and sorted by fixed leaf, then by moving leaf, each pair once. Looks at all pairs of leaves.
/// Where it is not, says which pair and why.
///
/// Cost: some 50 ns a pair, and 10 to 500 µs for one that is too close for the filter.
[[nodiscard]] ::testing::AssertionResult keeps_guarantee(const ExactPair& pair, SpherePolicy policy,
                                                         std::span<const LeafPair> leaf_pairs,
                                                         double pad, bool nested = true,
                                                         double margin = 0);

}  // namespace ist::test
