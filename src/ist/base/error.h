#pragma once

#include <stdexcept>
#include <string>

#include "ist/base/api.h"

namespace ist {

/// What went wrong, for code that must tell the cases apart. The text for people is `what()`.
enum class ErrorCode {
  kFileUnreadable,     ///< the file cannot be opened or read
  kFileUnwritable,     ///< the file cannot be created, written or renamed
  kNotAMesh,           ///< the content is in no mesh format that is read here
  kMeshEmpty,          ///< a mesh format, but no triangle and no vertex
  kMeshPointsOnly,     ///< vertices or lines, but no triangle
  kMeshTruncated,      ///< the file ends before its content does
  kMeshBadIndex,       ///< a face names a vertex that is not there
  kMeshNotFinite,      ///< a vertex is NaN or infinite
  kMeshExtent,         ///< the largest extent is zero or outside [1e-12, 1e15] units
  kVoxelSizeInvalid,   ///< not a positive, finite number
  kVoxelSizeTooSmall,  ///< needs more than 2^16 voxels an axis
  kMemoryLimit,        ///< would need more memory than was allowed
  kNotATree,           ///< not a tree file, or one of another byte order
  kTreeVersion,        ///< a tree file of another version
  kTreeTruncated,      ///< a tree file that ends too early or too late
  kTreeCorrupt,        ///< a tree file whose checksum or content does not hold
  kPolicyMissing,      ///< the tree was built without the spheres that are asked for
  kTrianglesMissing,   ///< the tree was built without the triangles that are asked for
  kTargetMissing,      ///< this processor lacks the instruction set that is asked for
  kPoseInvalid,        ///< not a rigid motion
  kInputInvalid,       ///< another input file whose content does not hold
  kFixedPointRange,    ///< a number that the hardware's fixed-point format does not hold
};

/// The only exception of the library. `what()` names the place, the cause and the remedy.
/// Building and loading throw it; queries never do.
class IST_API Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& detail) : std::runtime_error(detail), code_(code) {}
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

/// The code's own name, such as "mesh-truncated": stable, for logs and tests.
[[nodiscard]] IST_API const char* to_string(ErrorCode code) noexcept;

}  // namespace ist
