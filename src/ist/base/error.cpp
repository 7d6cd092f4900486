#include "ist/base/error.h"

#include <array>

namespace ist {
namespace {

// In the order of ErrorCode.
constexpr std::array kNames = {
    "file-unreadable",  "file-unwritable",    "not-a-mesh",           "mesh-empty",
    "mesh-points-only", "mesh-truncated",     "mesh-bad-index",       "mesh-not-finite",
    "mesh-extent",      "voxel-size-invalid", "voxel-size-too-small", "memory-limit",
    "not-a-tree",       "tree-version",       "tree-truncated",       "tree-corrupt",
    "policy-missing",   "triangles-missing",  "target-missing",       "pose-invalid",
    "argument-invalid", "input-invalid",      "fixed-point-range",    "mesh-too-large",
    "cancelled",        "part-busy",          "voxels-missing"};
static_assert(kNames.size() == static_cast<std::size_t>(ErrorCode::kVoxelsMissing) + 1);

}  // namespace

const char* to_string(ErrorCode code) noexcept {
  const auto at = static_cast<std::size_t>(code);
  return at < kNames.size() ? kNames[at] : "unknown";
}

}  // namespace ist
