#include "ist/base/error.h"

namespace ist {

const char* to_string(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::kFileUnreadable:
      return "file-unreadable";
    case ErrorCode::kFileUnwritable:
      return "file-unwritable";
    case ErrorCode::kNotAMesh:
      return "not-a-mesh";
    case ErrorCode::kMeshEmpty:
      return "mesh-empty";
    case ErrorCode::kMeshPointsOnly:
      return "mesh-points-only";
    case ErrorCode::kMeshTruncated:
      return "mesh-truncated";
    case ErrorCode::kMeshBadIndex:
      return "mesh-bad-index";
    case ErrorCode::kMeshNotFinite:
      return "mesh-not-finite";
    case ErrorCode::kMeshExtent:
      return "mesh-extent";
    case ErrorCode::kVoxelSizeInvalid:
      return "voxel-size-invalid";
    case ErrorCode::kVoxelSizeTooSmall:
      return "voxel-size-too-small";
    case ErrorCode::kMemoryLimit:
      return "memory-limit";
    case ErrorCode::kNotATree:
      return "not-a-tree";
    case ErrorCode::kTreeVersion:
      return "tree-version";
    case ErrorCode::kTreeTruncated:
      return "tree-truncated";
    case ErrorCode::kTreeCorrupt:
      return "tree-corrupt";
    case ErrorCode::kPolicyMissing:
      return "policy-missing";
    case ErrorCode::kTrianglesMissing:
      return "triangles-missing";
    case ErrorCode::kTargetMissing:
      return "target-missing";
    case ErrorCode::kPoseInvalid:
      return "pose-invalid";
    case ErrorCode::kInputInvalid:
      return "input-invalid";
    case ErrorCode::kFixedPointRange:
      return "fixed-point-range";
  }
  return "unknown";
}

}  // namespace ist
