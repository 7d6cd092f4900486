#pragma once

#include <cstdint>
#include <limits>

#include "ist/base/progress.h"
#include "ist/mesh/triangle_mesh.h"
#include "ist/voxel/voxel_set.h"

namespace ist {

struct VoxelizerOptions {
  double voxel_size = 0;        ///< mesh units
  bool keep_triangles = false;  ///< list the triangles of each voxel
  /// Bytes that the voxels, and what the caller makes of them, may take.
  std::uint64_t max_memory = std::numeric_limits<std::uint64_t>::max();
  /// What the caller will add: bytes a voxel, a pair of voxel and triangle, and a triangle.
  std::uint64_t bytes_per_voxel = 0, bytes_per_pair = 0, bytes_per_triangle = 0;
};

/// Finds every voxel whose closed cube meets a triangle, and none whose cube grown by
/// Lattice::kPad misses every triangle; with each its normal, weighted by the area of the triangles
/// inside it. Sparse: nothing is stored for empty space. The same result for any number of threads.
///
/// @param progress told of the stages, if not null
///
/// Cost: O(triangles + pairs of voxel and triangle) time and O(voxels) memory, + O(pairs) with
/// keep_triangles; some 50 ns a pair on one core. Errors: those of make_lattice, and kMemoryLimit,
/// thrown before the memory is allocated, with the smallest voxel size that would fit.
[[nodiscard]] VoxelSet voxelize(const TriangleMesh& mesh, const VoxelizerOptions& options,
                                Progress* progress = nullptr);

/// Whether voxelize() would give a result: neither the lattice nor the memory forbids it. Cost:
/// that of finding the voxels, a tenth of a whole build.
[[nodiscard]] bool can_voxelize(const TriangleMesh& mesh, const VoxelizerOptions& options,
                                Progress* progress = nullptr);

/// The lattice that voxelize() puts over a mesh. Throws what make_lattice does.
[[nodiscard]] Lattice lattice_of(const TriangleMesh& mesh, double voxel_size);
/// What it would throw; nothing where it would not.
[[nodiscard]] std::optional<Error> lattice_flaw(const TriangleMesh& mesh, double voxel_size);

}  // namespace ist
