#include <algorithm>
#include <cmath>
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
static_assert(answer_of(Answer::kUnknown) == IST_ANSWER_UNKNOWN &&
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

// Clears each struct that can be cleared, even if the other one is invalid.
ist_status clear_both(const Call& call, ist_contact_sums* sums, ist_query_result* result) {
  const ist_status wrong_sums = sums == nullptr ? IST_OK : clear_sized(call, "sums", sums);
  const ist_status wrong_result = clear_sized(call, "result", result);
  return wrong_result != IST_OK ? wrong_result : wrong_sums;
}

}  // namespace
}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_query_leaf_pairs(ist_query* query, const double pose[16], const ist_budget* budget,
                                ist_leaf_pair* pairs, size_t capacity,
                                ist_query_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status wrong = clear_sized(call, "result", result)) return wrong;
    if (const ist_status missing = call.need({{"pose", pose}})) return missing;
    if (const ist_status missing = call.need_array("pairs", pairs, capacity)) return missing;
    ist::Budget allowed;
    if (const ist_status wrong = read_budget(call, budget, allowed)) return wrong;
    // A budget gives the distance. One without limits counts as a limit that no search reaches.
    if (budget != nullptr && !allowed.has_tests() && !allowed.has_deadline()) --allowed.tests;
    const Held<QueryObject> held(call, "query", query);
    if (held.status() != IST_OK) return held.status();
    const ist::QueryResult found = held->query.leaf_pairs(
        to_isometry(pose), {reinterpret_cast<ist::LeafPair*>(pairs), capacity}, allowed);
    if (const ist_status wrong = status_of(call, found.status, pose)) return wrong;
    ist_query_result values = result_of(found);
    values.written = std::min<std::uint64_t>(found.leaf_pairs, capacity);
    values.truncated = found.truncated;
    write_sized(values, *result);
    return IST_OK;
  });
}

ist_status ist_query_contacts(ist_query* query, const double pose[16], const ist_budget* budget,
                              ist_contact* contacts, size_t capacity, ist_contact_sums* sums,
                              ist_query_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status wrong = clear_both(call, sums, result)) return wrong;
    if (const ist_status missing = call.need({{"pose", pose}})) return missing;
    if (const ist_status missing = call.need_array("contacts", contacts, capacity)) return missing;
    ist::Budget allowed;
    if (const ist_status wrong = read_budget(call, budget, allowed)) return wrong;
    const Held<QueryObject> held(call, "query", query);
    if (held.status() != IST_OK) return held.status();
    if (const ist_status wrong = need_contacts(call, *held)) return wrong;
    const ist::QueryResult found =
        held->query.contacts(to_isometry(pose), *held->manifold, allowed);
    if (const ist_status wrong = status_of(call, found.status, pose)) return wrong;
    const std::span<const ist::Contact> made = held->manifold->points();
    ist_query_result values = result_of(found);
    values.contacts = made.size();
    values.written = std::min(made.size(), capacity);
    values.truncated = made.size() > capacity;
    std::transform(made.begin(), made.begin() + static_cast<std::ptrdiff_t>(values.written),
                   contacts, contact_of);
    if (sums != nullptr) write_sized(sums_of(held->manifold->sums()), *sums);
    write_sized(values, *result);
    return IST_OK;
  });
}

ist_status ist_contact_sums_wrench(const ist_contact_sums* sums, double stiffness, double force[3],
                                   double torque[3]) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (force != nullptr) std::fill_n(force, 3, 0.0);
    if (torque != nullptr) std::fill_n(torque, 3, 0.0);
    if (const auto missing = call.need({{"sums", sums}, {"force", force}, {"torque", torque}})) {
      return missing;
    }
    ist_contact_sums known;
    if (const ist_status wrong = read_sized(call, "sums", *sums, known)) return wrong;
    if (!std::isfinite(stiffness)) {
      return call.fail(IST_ARGUMENT_INVALID, "stiffness is {}: pass a finite number", stiffness);
    }
    const ist::ScopedFloatEnvironment environment;
    for (int i = 0; i < 3; ++i) {
      force[i] = stiffness * known.spring_force[i];
      torque[i] = stiffness * known.spring_torque[i];
    }
    return IST_OK;
  });
}

ist_status ist_query_distance(ist_query* query, const double pose[16], double tolerance,
                              const ist_budget* budget, ist_distance_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status wrong = clear_sized(call, "result", result)) return wrong;
    if (const ist_status missing = call.need({{"pose", pose}})) return missing;
    if (!(tolerance >= 0)) {
      return call.fail(IST_ARGUMENT_INVALID, "tolerance is {}: pass a number of at least 0",
                       tolerance);
    }
    ist::Budget allowed;
    if (const ist_status wrong = read_budget(call, budget, allowed)) return wrong;
    const Held<QueryObject> held(call, "query", query);
    if (held.status() != IST_OK) return held.status();
    const ist::DistanceResult found = held->query.distance(to_isometry(pose), tolerance, allowed);
    if (const ist_status wrong = status_of(call, found.status, pose)) return wrong;
    write_sized({0, found.distance.lower, found.distance.upper, found.sphere_tests, found.complete,
                 0, found.narrowest, found.rotation_error},
                *result);
    return IST_OK;
  });
}

ist_status ist_query_intersects(ist_query* query, const double pose[16], const ist_budget* budget,
                                int32_t* answer) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status missing = call.need({{"answer", answer}})) return missing;
    *answer = IST_ANSWER_UNKNOWN;
    if (const ist_status missing = call.need({{"pose", pose}})) return missing;
    ist::Budget allowed;
    if (const ist_status wrong = read_budget(call, budget, allowed)) return wrong;
    const Held<QueryObject> held(call, "query", query);
    if (held.status() != IST_OK) return held.status();
    const ist::IntersectionResult found = held->query.intersects(to_isometry(pose), allowed);
    if (const ist_status wrong = status_of(call, found.status, pose)) return wrong;
    *answer = answer_of(found.answer);
    return IST_OK;
  });
}

ist_status ist_rotation_error(const double pose[16], double* error) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status missing = call.need({{"error", error}})) return missing;
    *error = 0;
    if (const ist_status missing = call.need({{"pose", pose}})) return missing;
    *error = ist::rotation_error(to_isometry(pose));
    return IST_OK;
  });
}

ist_status ist_query_triangle_pairs(ist_query* query, const double pose[16],
                                    const ist_budget* budget, ist_triangle_pair* pairs,
                                    size_t capacity,
                                    ist_triangle_pairs_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status wrong = clear_sized(call, "result", result)) return wrong;
    if (const ist_status missing = call.need({{"pose", pose}})) return missing;
    if (const ist_status missing = call.need_array("pairs", pairs, capacity)) return missing;
    ist::Budget allowed;
    if (const ist_status wrong = read_budget(call, budget, allowed)) return wrong;
    const Held<QueryObject> held(call, "query", query);
    if (held.status() != IST_OK) return held.status();
    const ist::TrianglePairsResult found = held->query.triangle_pairs(
        to_isometry(pose), {reinterpret_cast<ist::TrianglePair*>(pairs), capacity}, allowed);
    if (const ist_status wrong = status_of(call, found.status, pose)) return wrong;
    ist_triangle_pairs_result values{};
    values.pairs = found.triangle_pairs;
    values.written = std::min<std::uint64_t>(found.triangle_pairs, capacity);
    values.sphere_tests = found.sphere_tests;
    values.truncated = found.truncated;
    values.complete = found.complete;
    values.rotation_error = found.rotation_error;
    write_sized(values, *result);
    return IST_OK;
  });
}

ist_status ist_query_forget(ist_query* query) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    const Held<QueryObject> held(call, "query", query);
    if (held.status() != IST_OK) return held.status();
    held->query.forget();
    return IST_OK;
  });
}
