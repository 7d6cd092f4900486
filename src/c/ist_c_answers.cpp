#include <algorithm>
#include <span>

#include "c/objects.h"
#include "ist/base/float_environment.h"
#include "ist/base/pose.h"

namespace ist::capi {
namespace {

static_assert(sizeof(ist_leaf_pair) == sizeof(LeafPair) &&
              alignof(ist_leaf_pair) == alignof(LeafPair) &&
              offsetof(ist_leaf_pair, fixed) == offsetof(LeafPair, fixed) &&
              offsetof(ist_leaf_pair, moving) == offsetof(LeafPair, moving));

static_assert(sizeof(ist_triangle_pair) == sizeof(TrianglePair) &&
              alignof(ist_triangle_pair) == alignof(TrianglePair) &&
              offsetof(ist_triangle_pair, fixed) == offsetof(TrianglePair, fixed) &&
              offsetof(ist_triangle_pair, moving) == offsetof(TrianglePair, moving));

static_assert(static_cast<int>(Found::kFresh) == IST_FOUND_FRESH &&
              static_cast<int>(Found::kKept) == IST_FOUND_KEPT &&
              static_cast<int>(Found::kClear) == IST_FOUND_CLEAR);
static_assert(answer_of(Answer::kUnknown) == IST_ANSWER_UNKNOWN && IST_ANSWER_UNKNOWN == 0 &&
              answer_of(Answer::kNo) == IST_ANSWER_NO &&
              answer_of(Answer::kNear) == IST_ANSWER_NEAR &&
              answer_of(Answer::kYes) == IST_ANSWER_YES);

// The members that leaf pairs and contacts have in common.
ist_query_result result_of(const QueryResult& found) {
  ist_query_result result{};
  result.leaf_pairs = found.leaf_pairs;
  result.sphere_tests = found.sphere_tests;
  result.complete = found.complete;
  result.level = found.level;
  result.distance_known = found.distance.has_value();
  if (found.distance) {
    result.distance_lower = found.distance->lower;
    result.distance_upper = found.distance->upper;
  }
  result.resolution = found.resolution;
  result.found = static_cast<std::int32_t>(found.found);
  result.rotation_error = found.rotation_error;
  return result;
}

}  // namespace
}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_query_leaf_pairs(ist_query* query, const double pose[16], const ist_budget* budget,
                                ist_leaf_pair* pairs, size_t capacity,
                                ist_query_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "result", result);
    call.need("pose", pose);
    call.need_array("pairs", pairs, capacity);
    ist::Budget allowed = read_budget(call, budget);
    // A budget gives the distance. One without limits counts as a limit that no search reaches.
    if (budget != nullptr && !allowed.has_tests() && !allowed.has_deadline()) --allowed.tests;
    const Held<QueryObject> held(call, "query", query);
    if (!held) return;
    const ist::QueryResult found = held->query.leaf_pairs(
        to_isometry(pose), {reinterpret_cast<ist::LeafPair*>(pairs), capacity}, allowed);
    if (!answered(call, found.status, pose)) return;
    ist_query_result values = result_of(found);
    values.written = std::min<std::uint64_t>(found.leaf_pairs, capacity);
    values.truncated = found.truncated;
    write_sized(values, *result);
  });
}

ist_status ist_query_contacts(ist_query* query, const double pose[16], const ist_budget* budget,
                              ist_contact* contacts, size_t capacity, ist_contact_sums* sums,
                              ist_query_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "result", result);
    if (sums != nullptr) clear_sized(call, "sums", sums);
    call.need("pose", pose);
    call.need_array("contacts", contacts, capacity);
    const ist::Budget allowed = read_budget(call, budget);
    const Held<QueryObject> held(call, "query", query);
    if (!held || !gives_contacts(call, *held)) return;
    const ist::QueryResult found =
        held->query.contacts(to_isometry(pose), *held->manifold, allowed);
    if (!answered(call, found.status, pose)) return;
    const std::span<const ist::Contact> made = held->manifold->points();
    ist_query_result values = result_of(found);
    values.contacts = made.size();
    values.written = std::min(made.size(), capacity);
    values.truncated = made.size() > capacity;
    std::transform(made.begin(), made.begin() + static_cast<std::ptrdiff_t>(values.written),
                   contacts, contact_of);
    if (sums != nullptr) write_sized(sums_of(held->manifold->sums()), *sums);
    write_sized(values, *result);
  });
}

ist_status ist_contact_sums_wrench(const ist_contact_sums* sums, double stiffness, double force[3],
                                   double torque[3]) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    if (force != nullptr) std::fill_n(force, 3, 0.0);
    if (torque != nullptr) std::fill_n(torque, 3, 0.0);
    call.need("sums", sums);
    call.need("force", force);
    call.need("torque", torque);
    const ist_contact_sums known = read_sized(call, "sums", sums);
    check_finite(call, "stiffness", stiffness);
    if (call.status() != IST_OK) return;
    const ist::ScopedFloatEnvironment environment;
    for (int i = 0; i < 3; ++i) {
      force[i] = stiffness * known.spring_force[i];
      torque[i] = stiffness * known.spring_torque[i];
    }
  });
}

ist_status ist_query_distance(ist_query* query, const double pose[16], double tolerance,
                              const ist_budget* budget, ist_distance_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "result", result);
    call.need("pose", pose);
    check_tolerance(call, "tolerance", tolerance);
    const ist::Budget allowed = read_budget(call, budget);
    const Held<QueryObject> held(call, "query", query);
    if (!held) return;
    const ist::DistanceResult found = held->query.distance(to_isometry(pose), tolerance, allowed);
    if (!answered(call, found.status, pose)) return;
    write_sized({0, found.distance.lower, found.distance.upper, found.sphere_tests, found.complete,
                 0, found.narrowest, found.rotation_error},
                *result);
  });
}

ist_status ist_query_intersects(ist_query* query, const double pose[16], const ist_budget* budget,
                                int32_t* answer) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.clear("answer", answer);  // IST_ANSWER_UNKNOWN
    call.need("pose", pose);
    const ist::Budget allowed = read_budget(call, budget);
    const Held<QueryObject> held(call, "query", query);
    if (!held) return;
    const ist::IntersectionResult found = held->query.intersects(to_isometry(pose), allowed);
    if (!answered(call, found.status, pose)) return;
    *answer = answer_of(found.answer);
  });
}

ist_status ist_rotation_error(const double pose[16], double* error) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.clear("error", error);
    if (!call.need("pose", pose) || error == nullptr) return;
    *error = ist::rotation_error(to_isometry(pose));
  });
}

ist_status ist_query_triangle_pairs(ist_query* query, const double pose[16],
                                    const ist_budget* budget, ist_triangle_pair* pairs,
                                    size_t capacity,
                                    ist_triangle_pairs_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "result", result);
    call.need("pose", pose);
    call.need_array("pairs", pairs, capacity);
    const ist::Budget allowed = read_budget(call, budget);
    const Held<QueryObject> held(call, "query", query);
    if (!held) return;
    const ist::TrianglePairsResult found = held->query.triangle_pairs(
        to_isometry(pose), {reinterpret_cast<ist::TrianglePair*>(pairs), capacity}, allowed);
    if (!answered(call, found.status, pose)) return;
    ist_triangle_pairs_result values{};
    values.pairs = found.triangle_pairs;
    values.written = std::min<std::uint64_t>(found.triangle_pairs, capacity);
    values.sphere_tests = found.sphere_tests;
    values.truncated = found.truncated;
    values.complete = found.complete;
    values.rotation_error = found.rotation_error;
    write_sized(values, *result);
  });
}

ist_status ist_query_forget(ist_query* query) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    const Held<QueryObject> held(call, "query", query);
    if (!held) return;
    held->query.forget();
  });
}
