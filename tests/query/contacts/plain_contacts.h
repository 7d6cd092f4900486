#pragma once

#include <Eigen/Geometry>
#include <map>
#include <span>
#include <vector>

#include "ist/query/manifold.h"
#include "ist/tree/sphere_tree.h"

namespace ist::test {

/// A pair of leaves, in fixed mesh coordinates.
struct PlainPair {
  LeafPair leaves;
  double weight, depth;
  double mean_normal;  ///< length of the mean of both normals; where it is 0 there is no normal
  Eigen::Vector3d position, normal;
};

/// Contacts worked out pair by pair in double from what the headers guarantee.
class PlainContacts {
 public:
  /// Takes the margin and the reach of `options`.
  PlainContacts(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                const ManifoldOptions& options = {});

  [[nodiscard]] PlainPair at(const LeafPair& pair, const Eigen::Isometry3d& pose) const;
  /// Those of `pairs` that have a weight.
  [[nodiscard]] std::vector<PlainPair> of(std::span<const LeafPair> pairs,
                                          const Eigen::Isometry3d& pose) const;
  /// All leaves against all leaves.
  [[nodiscard]] std::vector<PlainPair> all(const Eigen::Isometry3d& pose) const;

  [[nodiscard]] ContactSums sums(const std::vector<PlainPair>& pairs) const;

 private:
  struct Leaf {
    Eigen::Vector3d centre, point, normal, slab_normal;
    double radius, offset, half;
  };
  [[nodiscard]] static std::vector<Leaf> leaves_of(const SphereTree& tree, SpherePolicy policy);

  std::vector<Leaf> fixed_, moving_;
  Eigen::Vector3d about_;
  bool slabs_;
  double size_, area_, farthest_, least_, fade_, reach_;
};

/// One contact a fixed leaf.
[[nodiscard]] std::map<std::uint32_t, Contact> plain_points(const std::vector<PlainPair>& pairs);

}  // namespace ist::test
