#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "ist/base/access.h"
#include "ist/base/api.h"
#include "ist/base/assert.h"
#include "ist/mesh/mesh.h"
#include "ist/mesh/surface_sides.h"
#include "ist/tree/bound_blocks.h"
#include "ist/tree/bounds.h"
#include "ist/tree/frame_origin.h"
#include "ist/tree/implicit_ball.h"
#include "ist/tree/linear_octree.h"
#include "ist/tree/outer_balls.h"
#include "ist/tree/sphere_tree.h"
#include "ist/voxel/classify.h"
#include "ist/voxel/lattice.h"
#include "ist/voxel/packed_normal.h"
#include "ist/voxel/voxel_set.h"

namespace ist {

/// The triangles of a tree built with keep_triangles.
struct TreeTriangles {
  /// @param oriented the mesh as oriented at build
  TreeTriangles(TriangleMesh oriented, const Eigen::Vector3d& origin)
      : mesh(std::move(oriented)), clusters(mesh, origin) {}
  /// @param made the clusters of that mesh
  TreeTriangles(TriangleMesh oriented, TriangleClusters made)
      : mesh(std::move(oriented)), clusters(std::move(made)) {}

  TriangleMesh mesh;          ///< mesh frame
  TriangleClusters clusters;  ///< about the tree's origin

  /// Returns the sides of the surface. The first call of this or of component_points(), by any
  /// thread, computes both. It takes 1.2 µs a triangle and core.
  [[nodiscard]] const SurfaceSides& sides() const { return *made().sides; }
  /// Returns the box round all vertices in use.
  [[nodiscard]] const Eigen::AlignedBox3d& box() const { return sides().box(); }
  /// Returns a vertex of each component.
  [[nodiscard]] const std::vector<Eigen::Vector3d>& component_points() const {
    return made().component_points;
  }
  /// Returns the side on which a point lies. `nearest` is the mesh's nearest triangle.
  [[nodiscard]] Side side_of(const Eigen::Vector3d& point, const NearestTriangle& nearest) const {
    return sides().of(mesh, clusters, point, nearest);
  }
  /// Returns the outer balls, or null before keep_outer_balls().
  [[nodiscard]] const OuterBalls* outer_balls() const noexcept {
    return lazy_->balls.load(std::memory_order_acquire);
  }
  /// Keeps outer balls of this surface. The first ones stay. Any thread may call it.
  void keep_outer_balls(OuterBalls balls) const;

 private:
  struct Lazy {
    std::once_flag once;
    std::optional<SurfaceSides> sides;
    std::vector<Eigen::Vector3d> component_points;
    std::once_flag balls_once;
    std::optional<OuterBalls> kept_balls;
    std::atomic<const OuterBalls*> balls = nullptr;  // to kept_balls
  };
  [[nodiscard]] const Lazy& made() const;

  std::shared_ptr<Lazy> lazy_ = std::make_shared<Lazy>();  // copies of the mesh share it
};

/// The proximity voxels, cells near the outside of the surface, on the lattice of the surface
/// voxels.
struct ProximityTree {
  /// Cell (0, 0, 0) of the octree is cell (-kMargin, -kMargin, -kMargin) of the lattice.
  static constexpr std::uint32_t kMargin = kProximityMargin;
  LinearOctree octree;
};

namespace detail {

/// The voxels of a tree, folded into an octree with its bounds.
struct TreeVoxels {
  Lattice lattice;
  LinearOctree octree;
  std::vector<PackedNormal> normals;            ///< one a leaf
  BoundBlocks bounds = {};                      ///< empty if not built
  TriangleLists lists = {};                     ///< one list a leaf; empty without keep_triangles
  std::optional<ProximityTree> proximity = {};  ///< only if requested and not empty
  /// The largest radius of a saved leaf ball, mesh units; set by SphereTree's constructor.
  double largest_saved_leaf = 0;

  /// The saved bounds of the nodes at `level`, 0 … depth, one block for each parent, a node of
  /// octree.nodes(level + 1). Precondition: has(kTight), or has(kSlab) for the slabs.
  [[nodiscard]] std::span<const BallBlock> balls(int level) const noexcept {
    return bounds.balls[static_cast<std::size_t>(level)];
  }
  [[nodiscard]] std::span<const SlabBlock> slabs(int level) const noexcept {
    return bounds.slabs[static_cast<std::size_t>(level)];
  }
  /// Returns the published sphere of a node in the tree's frame; `cube_centre` as for
  /// implicit_ball.
  /// Precondition: is_implicit(policy).
  [[nodiscard]] Ball ball(SpherePolicy policy, int level, std::uint32_t node,
                          const Eigen::Vector3d& cube_centre) const noexcept {
    return implicit_ball(policy, lattice, level, cube_centre,
                         level == 0 ? std::uint8_t{0} : octree.mask(level, node));
  }
  /// Returns the sphere that the traversal tests. It holds the spheres of all leaves below the
  /// node.
  [[nodiscard]] Ball nested_ball(SpherePolicy policy, int level, std::uint32_t node,
                                 const Eigen::Vector3d& cube_centre) const noexcept {
    return ist::nested_ball(policy, lattice, level, cube_centre,
                            level == 0 ? std::uint8_t{0} : octree.mask(level, node));
  }

  /// Returns the saved ball of child `slot` of `parent`, a node at `level`, in the tree's frame;
  /// each number is rounded once. Precondition: has(kTight).
  [[nodiscard]] Ball saved_ball(int level, std::uint32_t parent, int slot) const noexcept {
    const PackedBall ball = balls(level)[parent][slot];
    const float(&from)[3] = octree.nodes(level + 1)[parent].centre;
    const double unit = PackedBall::kUnit * static_cast<double>(std::uint64_t{2} << level);
    const double s = lattice.voxel_size;
    return {{s * (double{from[0]} + unit * ball.x), s * (double{from[1]} + unit * ball.y),
             s * (double{from[2]} + unit * ball.z)},
            s * (unit * ball.r)};
  }
  /// Returns the saved slab of child `slot` of `parent`, a node at `level`; the normal is exact.
  /// Precondition: has(kSlab).
  [[nodiscard]] Slab saved_slab(int level, std::uint32_t parent, int slot) const noexcept {
    constexpr double kNormal = PackedSlab::kNormalUnit;
    const PackedSlab slab = slabs(level)[parent][slot];
    const double unit = PackedSlab::kUnit * lattice.edge(level);
    return {{kNormal * slab.nx, kNormal * slab.ny, kNormal * slab.nz},
            unit * slab.offset,
            unit * slab.half};
  }
};

/// The content of a SphereTree, for the library's own code. The code that makes a TreeParts must
/// make its members fit each other. It has voxels, triangles or both.
struct TreeParts {
  std::optional<TreeVoxels> voxels;        ///< only with a voxel size
  std::optional<TreeTriangles> triangles;  ///< only with keep_triangles
  Orientation orientation = Orientation::kAssumed;
  MeshSource source = {};  ///< as source_flaw() allows it
  PatientFrame frame = PatientFrame::kUnknown;
  FrameOrigin origin = {};  ///< set by SphereTree's constructor
  /// The bounding radius of all spheres and triangles round the origin, mesh units; set by
  /// SphereTree's constructor.
  double bounding_radius = 0;
};

}  // namespace detail

using detail::TreeParts;
using detail::TreeVoxels;

/// Returns the content of a tree.
[[nodiscard]] inline const TreeParts& parts_of(const SphereTree& tree) noexcept {
  return detail::Access::parts(tree);
}
/// Returns the voxels of a tree. Precondition: it has voxels.
[[nodiscard]] inline const TreeVoxels& voxels_of(const SphereTree& tree) noexcept {
  IST_ASSERT(parts_of(tree).voxels);
  return *parts_of(tree).voxels;
}
/// Throws kVoxelsMissing if the tree lacks voxels. The error names `body` and the remedy.
IST_LOOP_API void require_voxels(const SphereTree& tree, std::string_view body);

/// Returns the middle of the box round all vertices in use: the origin of a tree without voxels.
[[nodiscard]] Eigen::Vector3d middle_of(const TriangleMesh& mesh) noexcept;

/// Makes a tree of its content.
[[nodiscard]] inline SphereTree tree_from(TreeParts parts) {
  return detail::Access::made_of<SphereTree>(std::move(parts));
}

}  // namespace ist
