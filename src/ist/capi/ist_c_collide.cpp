#include <algorithm>
#include <span>

#include "ist/capi/ask.h"
#include "ist/capi/handle.h"
#include "ist/capi/objects.h"
#include "ist/capi/sized_struct.h"

namespace ist::capi {
namespace {

static_assert(sizeof(ist_contact) == sizeof(Contact) && alignof(ist_contact) == alignof(Contact) &&
              offsetof(ist_contact, fixed) == offsetof(Contact, fixed) &&
              offsetof(ist_contact, moving) == offsetof(Contact, moving));

ist_status read_budget(const Call& call, const ist_budget* given, Budget& budget) {
  if (const ist_status missing = call.need({{"budget", given}})) return missing;
  ist_budget known;
  if (const ist_status wrong = read_sized(call, "budget", *given, known)) return wrong;
  if (known.sphere_tests > 0) budget.sphere_tests = known.sphere_tests;
  if (known.nanoseconds > 0) {
    const Budget::Clock::time_point now = Budget::Clock::now();
    const auto longest = static_cast<std::uint64_t>((budget.deadline - now).count());
    if (known.nanoseconds < longest) {
      budget.deadline = now + std::chrono::nanoseconds(known.nanoseconds);
    }
  }
  return IST_OK;
}

// What both kinds of answer tell.
ist_query_result result_of(const Query& query, const QueryResult& found) {
  ist_query_result result{};
  result.contacts = found.contacts;
  result.sphere_tests = found.sphere_tests;
  result.complete = found.complete;
  result.level = found.level;
  result.gap_known = found.gap.has_value();
  if (found.gap) {
    result.gap_lower = found.gap->lower;
    result.gap_upper = found.gap->upper;
  }
  result.resolution = query.query.resolution(found);
  return result;
}

// `ask` asks a query, given a pose and what to put contacts into.
template <typename Ask>
ist_status collide(const Call& call, ist_query* query, const double* pose, ist_contact* contacts,
                   std::size_t capacity, ist_query_result* result, const Ask& ask) {
  if (const ist_status wrong = clear_sized(call, "result", result)) return wrong;
  if (const ist_status missing = call.need({{"pose", pose}})) return missing;
  if (const ist_status missing = call.need_array("contacts", contacts, capacity)) return missing;
  const Held<Query> held(call, "query", query);
  if (held.status() != IST_OK) return held.status();
  const QueryResult found = ask(held->query, to_isometry(pose),
                                std::span<Contact>(reinterpret_cast<Contact*>(contacts), capacity));
  if (const ist_status wrong = status_of(call, found.status)) return wrong;
  ist_query_result values = result_of(*held, found);
  values.written = std::min<std::uint64_t>(found.contacts, capacity);
  values.truncated = found.truncated;
  write_sized(values, *result);
  return IST_OK;
}

void copy(const Eigen::Vector3d& from, double (&to)[3]) { std::copy_n(from.data(), 3, to); }

ist_contact_point point_of(const ContactPoint& point) {
  ist_contact_point out;
  copy(point.position, out.position);
  copy(point.normal, out.normal);
  out.depth = point.depth;
  out.weight = point.weight;
  return out;
}

ist_contact_sums sums_of(const ContactSums& sums) {
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

// Both become zero where they can, whatever is wrong with the other.
ist_status clear_both(const Call& call, ist_contact_sums* sums, ist_query_result* result) {
  const ist_status wrong_sums = sums == nullptr ? IST_OK : clear_sized(call, "sums", sums);
  const ist_status wrong_result = clear_sized(call, "result", result);
  return wrong_result != IST_OK ? wrong_result : wrong_sums;
}

template <typename Ask>
ist_status contact_points(const Call& call, ist_query* query, const double* pose,
                          ist_contact_point* points, std::size_t capacity, ist_contact_sums* sums,
                          ist_query_result* result, const Ask& ask) {
  if (const ist_status wrong = clear_both(call, sums, result)) return wrong;
  if (const ist_status missing = call.need({{"pose", pose}})) return missing;
  if (const ist_status missing = call.need_array("points", points, capacity)) return missing;
  const Held<Query> held(call, "query", query);
  if (held.status() != IST_OK) return held.status();
  if (!held->points) {
    return call.fail(IST_NOT_PREPARED,
                     "the query was made without contact points: give contact_points, or leave it "
                     "0, when it is made");
  }
  const QueryResult found = ask(held->query, to_isometry(pose), *held->points);
  if (const ist_status wrong = status_of(call, found.status)) return wrong;
  const std::span<const ContactPoint> made = held->points->points();
  ist_query_result values = result_of(*held, found);
  values.points = made.size();
  values.written = std::min(made.size(), capacity);
  values.truncated = made.size() > capacity;
  std::transform(made.begin(), made.begin() + static_cast<std::ptrdiff_t>(values.written), points,
                 point_of);
  if (sums != nullptr) write_sized(sums_of(held->points->sums()), *sums);
  write_sized(values, *result);
  return IST_OK;
}

}  // namespace
}  // namespace ist::capi

using namespace ist::capi;
using Eigen::Isometry3d;

ist_status ist_query_collide(ist_query* query, const double pose[16], ist_contact* contacts,
                             size_t capacity, ist_query_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) {
    return collide(call, query, pose, contacts, capacity, result,
                   [](auto& asked, const Isometry3d& at, std::span<ist::Contact> out) {
                     return asked.collide(at, out);
                   });
  });
}

ist_status ist_query_collide_within(ist_query* query, const double pose[16],
                                    const ist_budget* budget, ist_contact* contacts,
                                    size_t capacity, ist_query_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status wrong = clear_sized(call, "result", result)) return wrong;
    ist::Budget allowed;
    if (const ist_status wrong = read_budget(call, budget, allowed)) return wrong;
    return collide(call, query, pose, contacts, capacity, result,
                   [&](auto& asked, const Isometry3d& at, std::span<ist::Contact> out) {
                     return asked.collide(at, out, allowed);
                   });
  });
}

ist_status ist_query_contact_points(ist_query* query, const double pose[16],
                                    ist_contact_point* points, size_t capacity,
                                    ist_contact_sums* sums, ist_query_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) {
    return contact_points(call, query, pose, points, capacity, sums, result,
                          [](auto& asked, const Isometry3d& at, ist::ContactPoints& made) {
                            return asked.contact_points(at, made);
                          });
  });
}

ist_status ist_query_contact_points_within(ist_query* query, const double pose[16],
                                           const ist_budget* budget, ist_contact_point* points,
                                           size_t capacity, ist_contact_sums* sums,
                                           ist_query_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status wrong = clear_both(call, sums, result)) return wrong;
    ist::Budget allowed;
    if (const ist_status wrong = read_budget(call, budget, allowed)) return wrong;
    return contact_points(call, query, pose, points, capacity, sums, result,
                          [&](auto& asked, const Isometry3d& at, ist::ContactPoints& made) {
                            return asked.contact_points(at, made, allowed);
                          });
  });
}
