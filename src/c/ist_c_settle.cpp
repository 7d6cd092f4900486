#include <algorithm>
#include <limits>
#include <vector>

#include "c/objects.h"
#include "ist/capi/ist_measure.h"
#include "ist/measure/settle.h"

namespace ist::capi {
namespace {

constexpr std::int32_t kAllHeld = 63;

SettleOptions options_of(Call& call, const ist_settle_options& given) {
  SettleOptions options;
  const Eigen::Vector3d closing(given.closing[0], given.closing[1], given.closing[2]);
  if (!(closing.array() == 0).all()) options.closing = closing;
  if (given.has_load_point != 0) {
    options.load_point =
        Eigen::Vector3d(given.load_point[0], given.load_point[1], given.load_point[2]);
  }
  if (given.held < 0 || given.held > kAllHeld) {
    call.fail(IST_ARGUMENT_INVALID, "options->held is {}: add up values of IST_HOLD_...",
              given.held);
  }
  for (std::size_t i = 0; i < 6; ++i) options.held[i] = (given.held >> i & 1) != 0;
  options.largest_way = given.largest_way;
  options.largest_turn = given.largest_turn;
  options.reach = given.reach;
  if (given.steps > 0) {
    constexpr std::uint64_t kMost = std::numeric_limits<int>::max();
    options.steps = static_cast<int>(std::min(given.steps, kMost));
  }
  return options;
}

std::int32_t status_code(Settlement::Status status) {
  switch (status) {
    case Settlement::Status::kRests:
      return IST_SETTLE_RESTS;
    case Settlement::Status::kRestsLevel:
      return IST_SETTLE_RESTS_LEVEL;
    case Settlement::Status::kLeftTheBox:
      return IST_SETTLE_LEFT_THE_BOX;
    case Settlement::Status::kStopped:
      return IST_SETTLE_STOPPED;
    case Settlement::Status::kNoFreePose:
      return IST_SETTLE_NO_FREE_POSE;
    default:
      return IST_SETTLE_UNKNOWN;
  }
}

ist_settle_contact settle_contact_of(const SettleContact& contact) {
  ist_settle_contact out{};
  copy(contact.point, out.point);
  copy(contact.normal, out.normal);
  out.force = contact.force;
  out.gap = contact.gap;
  out.fixed = contact.triangles.fixed;
  out.moving = contact.triangles.moving;
  out.pairs = contact.pairs;
  return out;
}

ist_settlement settlement_of(const Settlement& settled) {
  ist_settlement out{};
  const Eigen::Isometry3d pose = settled.pose();
  std::copy_n(pose.matrix().data(), 16, out.pose);
  std::copy_n(settled.moved.data(), 6, out.moved);
  out.closed = settled.closed;
  out.distance_lower = settled.distance.lower;
  out.distance_upper = settled.distance.upper;
  out.residual = settled.residual;
  out.remaining = settled.remaining;
  out.second_order = settled.second_order;
  out.margin = settled.margin;
  for (std::size_t i = 0; i < settled.level.size(); ++i) {
    std::copy_n(settled.level[i].data(), 6, out.level + 6 * i);
  }
  copy(settled.load_point, out.load_point);
  out.radius = settled.radius;
  out.reach = settled.reach;
  out.rotation_error = settled.rotation_error;
  out.contacts = settled.contacts.size();
  out.status = status_code(settled.status);
  out.is_free = settled.free;
  out.rocks = settled.rocks;
  out.levels = static_cast<std::int32_t>(settled.level.size());
  out.load_guessed = settled.load_guessed;
  out.unit_guessed = settled.unit_guessed;
  out.opened = settled.opened;
  out.steps = settled.steps;
  return out;
}

}  // namespace
}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_query_settle(ist_query* query, const double pose[16],
                            const ist_settle_options* options, const ist_progress* progress,
                            ist_settle_contact* contacts, size_t capacity,
                            ist_settlement* result) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "result", result);
    call.need("pose", pose);
    call.need_array("contacts", contacts, capacity);
    ist::SettleOptions how = options_of(call, read_sized(call, "options", options));
    const Follower follower = read_follower(call, progress);
    const Held<QueryObject> held(call, "query", query);
    if (!held) return;
    ist::Settlement settled;
    const bool whole = followed(follower, [&](const ist::Proceed& proceed) {
      how.proceed = proceed;
      settled = ist::settle(held->query, to_isometry(pose), how);
    });
    if (!whole) return cancelled(call);
    const bool invalid = settled.status == ist::Settlement::Status::kInvalidPose;
    if (invalid && !answered(call, ist::QueryStatus::kInvalidPose, pose)) return;
    const std::size_t count = std::min(capacity, settled.contacts.size());
    std::transform(settled.contacts.begin(),
                   settled.contacts.begin() + static_cast<std::ptrdiff_t>(count), contacts,
                   settle_contact_of);
    write_sized(settlement_of(settled), *result);
  });
}
