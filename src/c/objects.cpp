#include "c/objects.h"

#include <algorithm>
#include <cmath>

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

Budget read_budget(Call& call, const ist_budget* given) {
  Budget budget;
  const ist_budget known = read_sized(call, "budget", given);
  if (known.tests > 0) budget.tests = known.tests;
  if (known.nanoseconds > 0) {
    const Budget::Clock::time_point now = Budget::Clock::now();
    const auto longest = static_cast<std::uint64_t>((budget.deadline - now).count());
    if (known.nanoseconds < longest) {
      budget.deadline = now + std::chrono::nanoseconds(known.nanoseconds);
    }
  }
  return budget;
}

void check_tolerance(Call& call, const char* name, double tolerance) {
  if (tolerance >= 0) return;
  call.fail(IST_ARGUMENT_INVALID, "{} is {}: pass a number of at least 0", name, tolerance);
}

void check_finite(Call& call, const char* name, double number) {
  if (std::isfinite(number)) return;
  call.fail(IST_ARGUMENT_INVALID, "{} is {}: pass a finite number", name, number);
}

void check_threads(Call& call, const char* name, std::int32_t threads) {
  constexpr std::int32_t kMost = 1024;
  if (threads >= 0 && threads <= kMost) return;
  call.fail(IST_ARGUMENT_INVALID, "{} is {}: pass 1 to {}, or 0 for one for each core", name,
            threads, kMost);
}

bool gives_contacts(Call& call, const QueryObject& query) {
  if (!query.has_voxels()) return answered(call, QueryStatus::kNoVoxels);
  if (query.manifold) return true;
  call.fail(IST_NOT_PREPARED,
            "the query was created without contacts: create it with a number of them");
  return false;
}

bool answered(Call& call, QueryStatus status, const double* pose) {
  switch (status) {
    case QueryStatus::kDone:
      return true;
    case QueryStatus::kInvalidPose:
      call.fail(IST_POSE_INVALID, "pose is not a rigid motion: {}",
                pose != nullptr ? why_not_rigid(to_isometry(pose))
                                : "set the poses of both bodies first");
      return false;
    case QueryStatus::kNoTriangles:
      call.fail(IST_TRIANGLES_MISSING, "a tree has no triangles: build both trees with them");
      return false;
    case QueryStatus::kNoVoxels:
      call.fail(IST_VOXELS_MISSING,
                "a tree has no voxels, which leaf pairs and contacts need: build both trees with a "
                "voxel_size");
      return false;
    case QueryStatus::kManifoldMismatch:  // each manifold belongs to its query
    case QueryStatus::kBusy:              // a handle is used by one thread at a time
    case QueryStatus::kNotPrepared:       // of a world
    case QueryStatus::kNoSuchBody:        // of a world
    case QueryStatus::kMarginInvalid:     // the margin was checked before
    case QueryStatus::kNoSuchTriangle:    // of ist_query_near_parts, which reports it
      break;
  }
  call.fail(IST_INTERNAL_ERROR, "a query returned an unknown status: report this bug");
  return false;
}

}  // namespace ist::capi
