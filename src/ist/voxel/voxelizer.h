#pragma once

#include <cstdint>
#include <limits>

#include "ist/base/api.h"
#include "ist/base/progress.h"
#include "ist/mesh/mesh.h"
#include "ist/voxel/payload.h"
#include "ist/voxel/voxel_set.h"

namespace ist {

struct VoxelizerOptions {
  double voxel_size = 0;        ///< mesh units
  bool keep_triangles = false;  ///< whether to list the triangles of each voxel
  /// The most memory for the voxels and the caller's structures over them, bytes.
  std::uint64_t max_memory = std::numeric_limits<std::uint64_t>::max();
  /// The memory of the caller's structures: bytes a voxel and a triangle.
  std::uint64_t bytes_per_voxel = 0, bytes_per_triangle = 0;
  PayloadVisitor* visitor = nullptr;  ///< takes the geometry of each voxel, if not null
};

/// Voxelizes the surface of a mesh: finds every voxel whose closed cube intersects a triangle, and
/// none whose cube grown by Lattice::kPad misses every triangle. Each voxel gets a normal, weighted
/// by the area of the triangles inside it. Empty space takes no memory. The result is the same for
/// any number of threads.
///
/// @param progress receives the stages, if not null
///
/// Cost: O(triangles + pairs of voxel and triangle) time and O(voxels) memory, + O(pairs) with
/// keep_triangles; some 50 ns a pair on one core.
/// Errors: those of make_lattice, and kMemoryLimit, with the memory to expect and the smallest
/// voxel size that would fit, rounded up to two digits. It is thrown before the memory is
/// allocated: at once, if the surface's area needs too many pairs, else as soon as the voxels found
/// need too much.
[[nodiscard]] VoxelSet voxelize(const TriangleMesh& mesh, const VoxelizerOptions& options,
                                Progress* progress = nullptr);

/// Whether voxelize() would succeed: neither the lattice nor the memory forbids it.
/// Cost: the time to find the voxels that fit, at most a tenth of a whole build.
[[nodiscard]] bool can_voxelize(const TriangleMesh& mesh, const VoxelizerOptions& options,
                                Progress* progress = nullptr);

/// Returns the lattice of voxelize() over a mesh. Throws the errors of make_lattice.
[[nodiscard]] IST_LOOP_API Lattice lattice_of(const TriangleMesh& mesh, double voxel_size);
/// Returns the error that lattice_of() would throw, or nullopt.
[[nodiscard]] IST_LOOP_API std::optional<Error> lattice_flaw(const TriangleMesh& mesh,
                                                             double voxel_size);

}  // namespace ist
