
#include <bit>
#include <chrono>
#include <optional>

#include "ist/base/error.h"
#include "ist/base/float_environment.h"
#include "ist/base/throw_error.h"
#include "ist/mesh/bounding_box.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/bound_builder.h"
#include "ist/tree/mesh_source.h"
#include "ist/tree/nested_bounds.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "ist/voxel/triangle_bins.h"
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
// A triangle in clusters, with vertices of its own, moved and then listed, while they are made.
constexpr std::uint64_t kClusterBytes = 224;

VoxelizerOptions voxelizer_options(const BuildOptions& options) {
  const bool saved = !is_implicit(options.spheres);
  VoxelizerOptions voxelizer{options.voxel_size, options.keep_triangles, options.max_memory,
                             kOctreeBytes};
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

// Returns the error of a mesh that gets no tree without voxels, or nullopt.
std::optional<Error> flaw_without_voxels(const TriangleMesh& mesh, const BuildOptions& options) {
  const auto refuse = [](const char* what) {
    return Error(ErrorCode::kArgumentInvalid, fmt::format("{}: give a voxel size", what));
  };
  if (!options.keep_triangles) return refuse("a tree without triangles needs voxels");
  if (options.proximity) return refuse("proximity voxels have the size of other voxels");
  const Eigen::AlignedBox3d box = bounding_box(mesh);
  if (std::optional<Error> flaw = extent_flaw(box.min(), box.max())) return flaw;
  const std::uint64_t triangles = mesh.triangles.size();
  if (triangles > kMaxTriangles) {
    return Error(ErrorCode::kMemoryLimit,
                 fmt::format("the mesh has {} triangles, and {} are the most: simplify the mesh",
                             triangles, kMaxTriangles));
  }
  if (triangles * kClusterBytes > options.max_memory) {
    return Error(ErrorCode::kMemoryLimit,
                 fmt::format("the mesh has {} triangles, which need {} bytes of memory; {} are "
                             "allowed: allow more memory, or simplify the mesh",
                             triangles, triangles * kClusterBytes, options.max_memory));
  }
  return std::nullopt;
}

// The stages of a build.
class Stages {
 public:
  Stages(BuildReport* report, Progress* progress) : report_(report), progress_(progress) {}

  void begin(const char* name) const {
    if (progress_ != nullptr) progress_->begin_stage(name, 0);
  }
  void end(const char* name) {
    const auto now = std::chrono::steady_clock::now();
    if (report_ != nullptr) {
      report_->stages.push_back(
          {name, std::chrono::duration<double, std::milli>(now - begin_).count()});
    }
    begin_ = now;
    if (progress_ != nullptr) progress_->check();
  }
  [[nodiscard]] Progress* progress() const noexcept { return progress_; }

 private:
  BuildReport* report_;
  Progress* progress_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

TreeVoxels make_voxels(const TriangleMesh& mesh, const BuildOptions& options, Stages& stages) {
  VoxelizerOptions voxelizer = voxelizer_options(options);
  std::optional<BoundBuilder> builder;
  if (!is_implicit(options.spheres)) voxelizer.visitor = &builder.emplace(options.spheres);
  VoxelSet voxels = voxelize(mesh, voxelizer, stages.progress());
  stages.end("voxels");

  stages.begin("folding the octree");
  TreeVoxels made{voxels.lattice, LinearOctree(voxels.codes, voxels.lattice.depth),
                  std::move(voxels.normals)};
  stages.end("octree");

  if (builder) {
    made.bounds = builder->finish(made.octree, stages.progress());
    stages.end("bounds");
  }
  if (options.proximity) {
    stages.begin("finding proximity voxels");
    made.proximity = make_proximity_tree(mesh, voxels);
    stages.end("proximity voxels");
  }
  made.lists = std::move(voxels.triangles);
  return made;
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
  Stages stages(report, progress);
  if (options.weld) weld(mesh);
  const OrientationResult oriented = orient_outward(mesh, progress);
  if (report != nullptr) report->turned_components = oriented.turned_components;
  stages.end("orientation");

  TreeParts parts;
  parts.orientation = oriented.orientation;
  parts.source = std::move(source);
  parts.frame = mesh.frame;
  if (options.voxel_size == 0) {
    if (const std::optional<Error> flaw = flaw_without_voxels(mesh, options)) throw *flaw;
  } else {
    parts.voxels = make_voxels(mesh, options, stages);
  }
  if (options.keep_triangles) {
    const Eigen::Vector3d origin = parts.voxels ? parts.voxels->lattice.origin() : middle_of(mesh);
    stages.begin("putting triangles into clusters");
    TriangleClusters clusters(mesh, origin, progress);
    parts.triangles.emplace(std::move(mesh), std::move(clusters));
    stages.end("triangle clusters");
  }
  return tree_from(std::move(parts));
}

bool can_build_tree(const TriangleMesh& mesh, const BuildOptions& options, Progress* progress) {
  const ScopedFloatEnvironment environment;
  if (options.voxel_size == 0) return !flaw_without_voxels(mesh, options);
  return can_voxelize(mesh, voxelizer_options(options), progress);
}

}  // namespace ist
