#include "c/status.h"

#include <iterator>

namespace ist::capi {
namespace {

using enum ErrorCode;

// Sorted by ErrorCode.
constexpr struct {
  ErrorCode code;
  ist_status status;
} kRows[] = {{kFileUnreadable, IST_FILE_UNREADABLE},
             {kFileUnwritable, IST_FILE_UNWRITABLE},
             {kNotAMesh, IST_NOT_A_MESH},
             {kMeshEmpty, IST_MESH_EMPTY},
             {kMeshPointsOnly, IST_MESH_POINTS_ONLY},
             {kMeshTruncated, IST_MESH_TRUNCATED},
             {kMeshBadIndex, IST_MESH_BAD_INDEX},
             {kMeshNotFinite, IST_MESH_NOT_FINITE},
             {kMeshExtent, IST_MESH_EXTENT},
             {kVoxelSizeInvalid, IST_VOXEL_SIZE_INVALID},
             {kVoxelSizeTooSmall, IST_VOXEL_SIZE_TOO_SMALL},
             {kMemoryLimit, IST_MEMORY_LIMIT},
             {kNotATree, IST_NOT_A_TREE},
             {kTreeVersion, IST_TREE_VERSION},
             {kTreeTruncated, IST_TREE_TRUNCATED},
             {kTreeCorrupt, IST_TREE_CORRUPT},
             {kPolicyMissing, IST_POLICY_MISSING},
             {kTrianglesMissing, IST_TRIANGLES_MISSING},
             {kTargetMissing, IST_TARGET_MISSING},
             {kPoseInvalid, IST_POSE_INVALID},
             {kArgumentInvalid, IST_ARGUMENT_INVALID},
             {kInputInvalid, IST_INPUT_INVALID},
             {kFixedPointRange, IST_FIXED_POINT_RANGE},
             {kMeshTooLarge, IST_MESH_TOO_LARGE},
             {kCancelled, IST_CANCELLED},
             {kPartBusy, IST_PART_BUSY},
             {kVoxelsMissing, IST_VOXELS_MISSING}};

constexpr bool in_order() {
  for (std::size_t i = 0; i < std::size(kRows); ++i)
    if (static_cast<std::size_t>(kRows[i].code) != i) return false;
  return true;
}
static_assert(in_order(), "an ErrorCode is missing in kRows");

}  // namespace

ist_status status_of(ErrorCode code) noexcept {
  const auto at = static_cast<std::size_t>(code);
  return at < std::size(kRows) ? kRows[at].status : IST_INTERNAL_ERROR;
}

std::optional<ErrorCode> error_code_of(ist_status status) noexcept {
  for (const auto& [code, number] : kRows)
    if (number == status) return code;
  return std::nullopt;
}

}  // namespace ist::capi
