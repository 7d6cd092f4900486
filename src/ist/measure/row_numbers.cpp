#include "ist/measure/row_numbers.h"

namespace ist {

std::int32_t not_closed_code(const Penetration& found) noexcept {
  if (found.status == Penetration::Status::kFixedNotClosed) return 1;
  return found.status == Penetration::Status::kMovingNotClosed ? 2 : 0;
}

RowNumbers numbers_of(const PoseRow& row, double stiffness) {
  RowNumbers numbers;
  numbers.rotation_error = row.rotation_error;
  if (row.status != QueryStatus::kDone) {
    numbers.pose_is_valid = false;
    return numbers;
  }
  numbers.complete = true;
  const auto count = [&](const auto& answer) {
    numbers.complete = numbers.complete && answer.complete;
    numbers.sphere_tests += answer.sphere_tests;
  };
  if (row.intersects) {
    count(*row.intersects);
    numbers.intersects = static_cast<std::int32_t>(row.intersects->answer);
  }
  if (row.leaf_pairs) {
    count(*row.leaf_pairs);
    numbers.leaf_pairs = row.leaf_pairs->leaf_pairs;
  }
  if (row.distance) {
    count(*row.distance);
    numbers.distance_lower = row.distance->distance.lower;
    numbers.distance_upper = row.distance->distance.upper;
  }
  if (row.contacts) {
    count(*row.contacts);
    if (!row.leaf_pairs) numbers.leaf_pairs = row.contacts->leaf_pairs;
    numbers.area = row.sums.weight;
    numbers.force = stiffness * row.sums.spring.force;
    numbers.torque = stiffness * row.sums.spring.torque;
  }
  if (row.penetration) {
    numbers.complete = numbers.complete && row.penetration->complete;
    numbers.not_closed = not_closed_code(*row.penetration);
    numbers.self_intersecting = self_intersecting_code(*row.penetration);
    numbers.capped = row.penetration->capped;
    if (row.penetration->status == Penetration::Status::kDone) {
      numbers.depth_lower = row.penetration->lower;
      numbers.depth_upper = row.penetration->upper;
    }
  }
  return numbers;
}

}  // namespace ist
