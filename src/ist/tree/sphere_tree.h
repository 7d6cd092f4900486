#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "ist/base/api.h"
#include "ist/mesh/orientation.h"
#include "ist/mesh/triangle_mesh.h"
#include "ist/tree/bound_blocks.h"
#include "ist/tree/linear_octree.h"
#include "ist/tree/slab.h"
#include "ist/tree/sphere_policy.h"
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
class IST_API SphereTree {
 public:
  struct Parts {
    Lattice lattice;
    LinearOctree octree;
    Orientation orientation = Orientation::kAssumed;
    std::vector<PackedNormal> normals;       ///< one a leaf
    BoundBlocks bounds;                      ///< empty where not built
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

  /// The last of kSpherePolicies that the tree has. It has those before it too.
  [[nodiscard]] SpherePolicy tightest() const noexcept {
    if (!parts_.bounds.slabs.empty()) return SpherePolicy::kSlab;
    return parts_.bounds.balls.empty() ? SpherePolicy::kTable : SpherePolicy::kTight;
  }
  [[nodiscard]] bool has(SpherePolicy policy) const noexcept { return policy <= tightest(); }
  /// Throws kPolicyMissing, naming `body` and the remedy, where the tree has no such spheres.
  void require(SpherePolicy policy, std::string_view body) const;

  /// The saved bounds of the nodes at `level`, 0 … depth, a block for each parent: for each node of
  /// octree().nodes(level + 1). Precondition: has(kTight), or has(kSlab).
  [[nodiscard]] std::span<const BallBlock> balls(int level) const noexcept {
    return parts_.bounds.balls[static_cast<std::size_t>(level)];
  }
  [[nodiscard]] std::span<const SlabBlock> slabs(int level) const noexcept {
    return parts_.bounds.slabs[static_cast<std::size_t>(level)];
  }
  [[nodiscard]] const BoundBlocks& bounds() const noexcept { return parts_.bounds; }

  /// The sphere of a node in the tree's frame. `cube_centre` as for implicit_ball.
  /// Precondition: is_implicit(policy).
  [[nodiscard]] Ball ball(SpherePolicy policy, int level, std::uint32_t node,
                          const Eigen::Vector3d& cube_centre) const noexcept {
    return implicit_ball(policy, parts_.lattice, level, cube_centre,
                         level == 0 ? std::uint8_t{0} : parts_.octree.mask(level, node));
  }

  /// The saved ball of the node at `level` that is child `slot` of `parent`, in the tree's frame;
  /// each number is rounded once. Precondition: has(kTight).
  [[nodiscard]] Ball saved_ball(int level, std::uint32_t parent, int slot) const noexcept {
    const PackedBall ball = balls(level)[parent][slot];
    const float(&from)[3] = parts_.octree.nodes(level + 1)[parent].centre;
    const double unit = PackedBall::kUnit * static_cast<double>(std::uint64_t{2} << level);
    const double s = parts_.lattice.voxel_size;
    return {{s * (double{from[0]} + unit * ball.x), s * (double{from[1]} + unit * ball.y),
             s * (double{from[2]} + unit * ball.z)},
            s * (unit * ball.r)};
  }
  /// Its saved slab; the normal is exact. Precondition: has(kSlab).
  [[nodiscard]] Slab saved_slab(int level, std::uint32_t parent, int slot) const noexcept {
    constexpr double kNormal = PackedSlab::kNormalUnit;
    const PackedSlab slab = slabs(level)[parent][slot];
    const double unit = PackedSlab::kUnit * parts_.lattice.edge(level);
    return {{kNormal * slab.nx, kNormal * slab.ny, kNormal * slab.nz},
            unit * slab.offset,
            unit * slab.half};
  }

  /// The largest radius of a leaf, mesh units.
  [[nodiscard]] double largest_leaf_radius(SpherePolicy policy) const noexcept;

  /// No node's sphere reaches farther from the origin of the tree's frame, mesh units.
  [[nodiscard]] double reach() const noexcept { return reach_; }

  /// Bytes in memory.
  [[nodiscard]] std::uint64_t bytes() const noexcept;

 private:
  Parts parts_;
  double largest_saved_leaf_ = 0;
  double reach_ = 0;
};

}  // namespace ist
