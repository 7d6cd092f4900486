#include "ist/haptics/recording.h"

#include "ist/base/throw_error.h"

namespace ist {

namespace {

ContactRecord record_of(const ContactPoint& point) noexcept {
  ContactRecord record{};
  std::copy_n(point.position.data(), 3, record.position.begin());
  std::copy_n(point.normal.data(), 3, record.normal.begin());
  std::copy_n(point.force.data(), 3, record.force.begin());
  record.gap = point.gap;
  record.fixed_triangle = point.triangles.fixed;
  record.held_triangle = point.triangles.moving;
  record.fixed = static_cast<std::uint32_t>(point.fixed);
  record.held = static_cast<std::uint32_t>(point.held);
  return record;
}

}  // namespace

TickRecord record_of(std::uint64_t number, double dt, const Tick& tick,
                     bool device_known) noexcept {
  TickRecord record{};
  record.tick = number;
  record.dt = dt;
  record.device = to_numbers(tick.device);
  record.tool = to_numbers(tick.tool);
  std::copy_n(tick.wrench.data(), 6, record.wrench.begin());
  record.device_known = device_known;
  record.fault = tick.fault;
  record.held = tick.held;
  record.halved = tick.halved;
  record.steps = tick.steps;
  for (const ContactPoint& point : tick.points) {
    record.points[record.point_count++] = record_of(point);
  }
  record.contacts = tick.contacts;
  record.proximity = tick.proximity;
  record.leaf_pairs = tick.leaf_pairs;
  record.change = tick.change;
  return record;
}

TickRecord replay(const RecordedTick& recorded, Simulation& simulation) noexcept {
  return record_of(recorded.tick, simulation.dt(),
                   simulation.tick(recorded.device, recorded.budget), recorded.device.has_value());
}

TickRecord::Pose to_numbers(const Placement& placement) noexcept {
  TickRecord::Pose numbers;
  std::copy_n(placement.translation.data(), 3, numbers.begin());
  std::copy_n(placement.rotation.data(), 9, numbers.begin() + 3);
  return numbers;
}

std::optional<Placement> to_placement(const TickRecord::Pose& numbers) noexcept {
  Placement placement;
  std::copy_n(numbers.begin(), 3, placement.translation.data());
  std::copy_n(numbers.begin() + 3, 9, placement.rotation.data());
  if (!Placement::from(placement.isometry())) return std::nullopt;
  return placement;
}

std::size_t detail::ring_capacity(std::size_t asked) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 32;
  if (asked == 0 || std::uint64_t{asked} > kMost) {
    throw_error(ErrorCode::kArgumentInvalid, "a ring for {} records: give a capacity from 1 to {}",
                asked, kMost);
  }
  return std::bit_ceil(asked);
}

}  // namespace ist
