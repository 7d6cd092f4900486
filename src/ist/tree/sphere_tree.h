#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "ist/mesh/orientation.h"
#include "ist/mesh/triangle_mesh.h"
#include "ist/tree/linear_octree.h"
#include "ist/tree/sphere_policy.h"
#include "ist/tree/tight_spheres.h"
#include "ist/voxel/classify.h"
#include "ist/voxel/lattice.h"
#include "ist/voxel/packed_normal.h"
#include "ist/voxel/voxel_set.h"

namespace ist {

/// The triangles of a tree built to answer exactly.
struct LeafTriangles {
  TriangleMesh mesh;    ///< as oriented at build, mesh frame
  TriangleLists lists;  ///< one list a leaf
};

/// The cells near the outside of the surface, on the lattice of the surface voxels.
struct ProximityTree {
  /// Cell (0, 0, 0) of the octree is cell (-kMargin, -kMargin, -kMargin) of the lattice.
  static constexpr std::uint32_t kMargin = kProximityMargin;
  LinearOctree octree;
};

/// A body made ready for queries. It never changes after it is made, so any number of threads may
/// read it.
class SphereTree {
 public:
  struct Parts {
    Lattice lattice;
    LinearOctree octree;
    Orientation orientation = Orientation::kAssumed;
    std::vector<PackedNormal> normals;       ///< one a leaf
    SphereLevels tight;                      ///< empty where not built
    std::optional<LeafTriangles> triangles;  ///< where built to answer exactly
    std::optional<ProximityTree> proximity;  ///< where asked for, and there are any such cells
  };

  /// Parts that do not fit each other are a bug of the caller.
  explicit SphereTree(Parts parts);

  [[nodiscard]] const Lattice& lattice() const noexcept { return parts_.lattice; }
  [[nodiscard]] const LinearOctree& octree() const noexcept { return parts_.octree; }
  [[nodiscard]] int depth() const noexcept { return parts_.octree.depth(); }
  [[nodiscard]] Orientation orientation() const noexcept { return parts_.orientation; }
  [[nodiscard]] const std::vector<PackedNormal>& normals() const noexcept { return parts_.normals; }
  [[nodiscard]] const std::optional<LeafTriangles>& triangles() const noexcept {
    return parts_.triangles;
  }
  [[nodiscard]] const std::optional<ProximityTree>& proximity() const noexcept {
    return parts_.proximity;
  }

  /// Every tree has `simple` and `table`.
  [[nodiscard]] bool has(SpherePolicy policy) const noexcept {
    return is_implicit(policy) || !parts_.tight.empty();
  }
  /// Throws kPolicyMissing, naming `body` and the remedy, where the tree has no such spheres.
  void require(SpherePolicy policy, std::string_view body) const;

  /// The saved spheres of a level. Precondition: has(SpherePolicy::kTight).
  [[nodiscard]] const std::vector<Sphere>& tight(int level) const noexcept {
    return parts_.tight[static_cast<std::size_t>(level)];
  }

  /// The sphere of a node in the tree's frame. `cube_centre` as for implicit_ball.
  /// Precondition: has(policy).
  [[nodiscard]] Ball ball(SpherePolicy policy, int level, std::uint32_t node,
                          const Eigen::Vector3d& cube_centre) const noexcept {
    if (policy == SpherePolicy::kTight) {
      const Sphere& s = tight(level)[node];
      return {{double{s.x}, double{s.y}, double{s.z}}, double{s.r}};
    }
    return implicit_ball(policy, parts_.lattice, level, cube_centre,
                         level == 0 ? std::uint8_t{0} : parts_.octree.mask(level, node));
  }

  /// The largest radius of a leaf, mesh units.
  [[nodiscard]] double largest_leaf_radius(SpherePolicy policy) const noexcept;

  /// No node's sphere reaches farther from the origin of the tree's frame, mesh units.
  [[nodiscard]] double reach() const noexcept { return reach_; }

  /// Bytes in memory.
  [[nodiscard]] std::uint64_t bytes() const noexcept;

 private:
  Parts parts_;
  double largest_tight_leaf_ = 0;
  double reach_ = 0;
};

}  // namespace ist
