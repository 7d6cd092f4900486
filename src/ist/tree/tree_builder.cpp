
#include <bit>
#include <chrono>
#include <optional>

#include "ist/base/error.h"
#include "ist/base/float_environment.h"
#include "ist/base/throw_error.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/bound_builder.h"
#include "ist/tree/mesh_source.h"
#include "ist/tree/nested_bounds.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "ist/voxel/voxelizer.h"

namespace ist {
namespace {

// Returns the bytes a leaf of a structure with `bytes_a_parent`. A surface has one parent for every
// three leaves, all levels together; three for every eight leaves are counted.
constexpr std::uint64_t bytes_a_leaf(std::uint64_t bytes_a_parent) {
  return (3 * bytes_a_parent + 7) / 8;
}
constexpr std::uint64_t kOctreeBytes = bytes_a_leaf(sizeof(OctreeNode) + 1);
constexpr std::uint64_t kBallBytes = bytes_a_leaf(sizeof(BallBlock));
constexpr std::uint64_t kSlabBytes = bytes_a_leaf(sizeof(SlabBlock) + kNestingBytes);

// A surface voxel has two to three proximity voxels. Their codes are stored twice while joined. A
// triangle has its normals, half a corner's, three sides while sides are sorted, and some bins. A
// closed surface is put into clusters too.
constexpr std::uint64_t kProximityBytes = 3 * 2 * sizeof(std::uint64_t);
constexpr std::uint64_t kPseudoNormalBytes = 256;
// A triangle in clusters, with its corners twice while they are ordered.
constexpr std::uint64_t kClusterBytes = 224;

VoxelizerOptions voxelizer_options(const BuildOptions& options) {
  const bool saved = !is_implicit(options.spheres);
  VoxelizerOptions voxelizer{options.voxel_size, saved || options.keep_triangles,
                             options.max_memory, kOctreeBytes};
  if (saved) {
    voxelizer.bytes_per_voxel += kBallBytes;
    if (options.spheres == SpherePolicy::kSlab) voxelizer.bytes_per_voxel += kSlabBytes;
  }
  if (options.keep_triangles) voxelizer.bytes_per_triangle += kClusterBytes;
  if (options.proximity) {
    voxelizer.bytes_per_voxel += kProximityBytes;
    voxelizer.bytes_per_triangle += kPseudoNormalBytes + kClusterBytes;
  }
  return voxelizer;
}

// Returns nullopt without proximity voxels: a mesh without area has no outside.
std::optional<ProximityTree> make_proximity_tree(const TriangleMesh& mesh,
                                                 const VoxelSet& surface) {
  const std::vector<std::uint64_t> codes = proximity_voxels(mesh, surface);
  if (codes.empty()) return std::nullopt;
  const std::uint32_t cells = surface.lattice.cells + 2 * ProximityTree::kMargin;
  return ProximityTree{LinearOctree(codes, static_cast<int>(std::bit_width(cells - 1)))};
}

}  // namespace

SphereTree build_tree(TriangleMesh mesh, const BuildOptions& options, BuildReport* report,
                      Progress* progress) {
  const ScopedFloatEnvironment environment;
  if (const char* flaw = source_flaw(options.source)) {
    throw_error(ErrorCode::kArgumentInvalid,
                "source: {}: give a file's name without its folder, and a LengthUnit", flaw);
  }
  if (to_string(mesh.frame).empty() || to_string(options.frame).empty()) {
    throw Error(ErrorCode::kArgumentInvalid, "frame: it is out of range: give a PatientFrame");
  }
  MeshSource source = options.source;
  if (to_string(mesh.unit).empty() || contradict(source.unit, mesh.unit)) {
    throw_error(ErrorCode::kArgumentInvalid,
                "source: its unit is {}, and the mesh's is {}: leave one of them unknown",
                to_string(source.unit), to_string(mesh.unit));
  }
  if (source.unit == LengthUnit::kUnknown) source.unit = mesh.unit;
  require_valid(mesh);
  turn_into(mesh, options.frame);
  auto begin = std::chrono::steady_clock::now();
  const auto end_stage = [&](const char* name) {
    const auto now = std::chrono::steady_clock::now();
    if (report != nullptr)
      report->stages.push_back(
          {name, std::chrono::duration<double, std::milli>(now - begin).count()});
    begin = std::chrono::steady_clock::now();
    if (progress != nullptr) progress->check();
  };
  if (options.weld) weld(mesh);
  const OrientationResult oriented = orient_outward(mesh, progress);
  if (report != nullptr) report->turned_components = oriented.turned_components;
  end_stage("orientation");

  VoxelSet voxels = voxelize(mesh, voxelizer_options(options), progress);
  end_stage("voxels");

  if (progress != nullptr) progress->begin_stage("folding the octree", 0);
  TreeParts parts{voxels.lattice,
                  LinearOctree(voxels.codes, voxels.lattice.depth),
                  oriented.orientation,
                  std::move(voxels.normals),
                  {},
                  std::nullopt,
                  std::nullopt,
                  source,
                  mesh.frame};
  end_stage("octree");

  if (!is_implicit(options.spheres)) {
    parts.bounds = build_bounds(options.spheres, mesh, voxels, parts.octree, progress);
    end_stage("bounds");
  }
  if (options.proximity) {
    if (progress != nullptr) progress->begin_stage("finding proximity voxels", 0);
    parts.proximity = make_proximity_tree(mesh, voxels);
    end_stage("proximity voxels");
  }
  if (options.keep_triangles) {
    parts.triangles =
        LeafTriangles(std::move(mesh), std::move(voxels.triangles), parts.lattice.origin());
    end_stage("triangle clusters");
  }
  return tree_from(std::move(parts));
}

bool can_build_tree(const TriangleMesh& mesh, const BuildOptions& options, Progress* progress) {
  return can_voxelize(mesh, voxelizer_options(options), progress);
}

}  // namespace ist
