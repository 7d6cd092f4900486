#include "ist/capi/status.h"

#include <array>

namespace ist::capi {
namespace {

struct Row {
  ErrorCode code;
  ist_status status;
};

// In the order of ErrorCode.
constexpr std::array kRows = {
    Row{ErrorCode::kFileUnreadable, IST_FILE_UNREADABLE},
    Row{ErrorCode::kFileUnwritable, IST_FILE_UNWRITABLE},
    Row{ErrorCode::kNotAMesh, IST_NOT_A_MESH},
    Row{ErrorCode::kMeshEmpty, IST_MESH_EMPTY},
    Row{ErrorCode::kMeshPointsOnly, IST_MESH_POINTS_ONLY},
    Row{ErrorCode::kMeshTruncated, IST_MESH_TRUNCATED},
    Row{ErrorCode::kMeshBadIndex, IST_MESH_BAD_INDEX},
    Row{ErrorCode::kMeshNotFinite, IST_MESH_NOT_FINITE},
    Row{ErrorCode::kMeshExtent, IST_MESH_EXTENT},
    Row{ErrorCode::kVoxelSizeInvalid, IST_VOXEL_SIZE_INVALID},
    Row{ErrorCode::kVoxelSizeTooSmall, IST_VOXEL_SIZE_TOO_SMALL},
    Row{ErrorCode::kMemoryLimit, IST_MEMORY_LIMIT},
    Row{ErrorCode::kNotATree, IST_NOT_A_TREE},
    Row{ErrorCode::kTreeVersion, IST_TREE_VERSION},
    Row{ErrorCode::kTreeTruncated, IST_TREE_TRUNCATED},
    Row{ErrorCode::kTreeCorrupt, IST_TREE_CORRUPT},
    Row{ErrorCode::kPolicyMissing, IST_POLICY_MISSING},
    Row{ErrorCode::kTrianglesMissing, IST_TRIANGLES_MISSING},
    Row{ErrorCode::kTargetMissing, IST_TARGET_MISSING},
    Row{ErrorCode::kPoseInvalid, IST_POSE_INVALID},
    Row{ErrorCode::kInputInvalid, IST_INPUT_INVALID},
    Row{ErrorCode::kFixedPointRange, IST_FIXED_POINT_RANGE},
};

constexpr bool in_order() {
  for (std::size_t i = 0; i < kRows.size(); ++i) {
    if (static_cast<std::size_t>(kRows[i].code) != i) return false;
  }
  return true;
}
static_assert(in_order(), "a code is missing here");

}  // namespace

ist_status status_of(ErrorCode code) noexcept {
  const auto at = static_cast<std::size_t>(code);
  return at < kRows.size() ? kRows[at].status : IST_INTERNAL_ERROR;
}

std::optional<ErrorCode> error_code_of(ist_status status) noexcept {
  for (const Row& row : kRows) {
    if (row.status == status) return row.code;
  }
  return std::nullopt;
}

}  // namespace ist::capi
