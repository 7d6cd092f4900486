#pragma once

#include <stdexcept>
#include <string>

#include "ist/base/api.h"

namespace ist {

/// Identifies the kind of an error, for code that handles kinds differently. `what()` is the text
/// for people.
enum class ErrorCode {
  kFileUnreadable,     ///< the file cannot be opened or read
  kFileUnwritable,     ///< the file cannot be created, written or renamed
  kNotAMesh,           ///< the content is in no supported mesh format
  kMeshEmpty,          ///< the file holds neither a triangle nor a vertex
  kMeshPointsOnly,     ///< the file holds vertices or lines, but no triangle
  kMeshTruncated,      ///< the file ends before its last element
  kMeshBadIndex,       ///< a face refers to a vertex that does not exist
  kMeshNotFinite,      ///< a vertex is NaN or infinite
  kMeshExtent,         ///< the largest extent is zero or outside [1e-12, 1e15] units
  kVoxelSizeInvalid,   ///< not positive and finite, or over 1,000 times the extent
  kVoxelSizeTooSmall,  ///< the grid would need more than 2^16 voxels an axis
  kMemoryLimit,        ///< the result would need more memory than allowed
  kNotATree,           ///< the file is not a tree file, or has another byte order
  kTreeVersion,        ///< the tree file has another version
  kTreeTruncated,      ///< the tree file is shorter or longer than its header says
  kTreeCorrupt,        ///< the tree file's checksum or content is invalid
  kPolicyMissing,      ///< the tree lacks the requested spheres
  kTrianglesMissing,   ///< the tree lacks the triangles that an exact query needs
  kTargetMissing,      ///< this processor lacks the requested instruction set
  kPoseInvalid,        ///< the pose is not a rigid motion
  kArgumentInvalid,    ///< an option or argument is outside its range
  kInputInvalid,       ///< the content of another input file is invalid
  kFixedPointRange,    ///< a number does not fit the hardware's fixed-point format
  kMeshTooLarge,       ///< the mesh file unpacks, or places, more than its reader allows
  kCancelled,          ///< the caller ended the call
  kPartBusy,           ///< another process is making this part of a sweep now
  kVoxelsMissing,      ///< the tree lacks the voxels that leaf pairs and their contacts need
};

/// The exception of the library, beside std::bad_alloc. `what()` names the place, the cause and the
/// remedy. Building and loading throw it; queries never do.
class IST_API Error : public std::runtime_error {
 public:
  /// Makes an error whose what() is `detail`.
  Error(ErrorCode code, const std::string& detail) : std::runtime_error(detail), code_(code) {}
  /// Returns the kind of the error.
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

/// Returns the code's name, such as "mesh-truncated": stable, for logs and tests.
[[nodiscard]] IST_API const char* to_string(ErrorCode code) noexcept;

}  // namespace ist
