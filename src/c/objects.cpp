#include "c/objects.h"

#include <algorithm>

#include "ist/base/pose.h"

namespace ist::capi {

Eigen::Isometry3d to_isometry(const double pose[16]) noexcept {
  Eigen::Isometry3d isometry;
  isometry.matrix() = Eigen::Map<const Eigen::Matrix4d>(pose);
  return isometry;
}

void copy(const Eigen::Vector3d& from, double (&to)[3]) noexcept {
  std::copy_n(from.data(), 3, to);
}

ist_contact contact_of(const Contact& contact) noexcept {
  ist_contact out;
  copy(contact.position, out.position);
  copy(contact.normal, out.normal);
  out.depth = contact.depth;
  out.weight = contact.weight;
  return out;
}

ist_contact_sums sums_of(const ContactSums& sums) noexcept {
  ist_contact_sums out{};
  out.pairs = sums.pairs;
  out.weight = sums.weight;
  copy(sums.pressure.force, out.pressure_force);
  copy(sums.pressure.torque, out.pressure_torque);
  copy(sums.spring.force, out.spring_force);
  copy(sums.spring.torque, out.spring_torque);
  copy(sums.about, out.about);
  return out;
}

ist_status read_budget(const Call& call, const ist_budget* given, Budget& budget) {
  if (given == nullptr) return IST_OK;
  ist_budget known;
  if (const ist_status wrong = read_sized(call, "budget", *given, known)) return wrong;
  if (known.tests > 0) budget.tests = known.tests;
  if (known.nanoseconds > 0) {
    const Budget::Clock::time_point now = Budget::Clock::now();
    const auto longest = static_cast<std::uint64_t>((budget.deadline - now).count());
    if (known.nanoseconds < longest) {
      budget.deadline = now + std::chrono::nanoseconds(known.nanoseconds);
    }
  }
  return IST_OK;
}

ist_status need_contacts(const Call& call, const QueryObject& query) {
  if (!query.has_voxels()) return status_of(call, QueryStatus::kNoVoxels);
  if (query.manifold) return IST_OK;
  return call.fail(IST_NOT_PREPARED,
                   "the query was created without contacts: create it with a number of them");
}

ist_status status_of(const Call& call, QueryStatus status, const double* pose) {
  switch (status) {
    case QueryStatus::kDone:
      return IST_OK;
    case QueryStatus::kInvalidPose:
      return call.fail(IST_POSE_INVALID, "pose is not a rigid motion: {}",
                       pose != nullptr ? why_not_rigid(to_isometry(pose))
                                       : "set the poses of both bodies first");
    case QueryStatus::kNoTriangles:
      return call.fail(IST_TRIANGLES_MISSING,
                       "a tree has no triangles: build both trees with them");
    case QueryStatus::kNoVoxels:
      return call.fail(IST_VOXELS_MISSING,
                       "a tree has no voxels, which leaf pairs and contacts need: build both trees "
                       "with a voxel_size");
    case QueryStatus::kMarginInvalid:
      return call.fail(IST_ARGUMENT_INVALID, "margin is negative, infinite or NaN: pass a length");
    case QueryStatus::kNoSuchTriangle:
      return call.fail(IST_ARGUMENT_INVALID,
                       "a triangle's index is too large: pass indices of both meshes");
    case QueryStatus::kManifoldMismatch:  // each manifold belongs to its query
    case QueryStatus::kBusy:              // a handle is used by one thread at a time
    case QueryStatus::kNotPrepared:       // of a world
    case QueryStatus::kNoSuchBody:        // of a world
      break;
  }
  return call.fail(IST_INTERNAL_ERROR, "a query returned an unknown status: report this bug");
}

}  // namespace ist::capi
