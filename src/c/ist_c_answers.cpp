#include <algorithm>
#include <array>
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
static_assert(static_cast<int>(TrianglePart::kCorner0) == IST_PART_CORNER0 &&
              static_cast<int>(TrianglePart::kEdge0) == IST_PART_EDGE0 &&
              static_cast<int>(TrianglePart::kFace) == IST_PART_FACE);
static_assert(Query::kMostNearParts == IST_MOST_NEAR_PARTS);
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

ist_distance_result result_of(const DistanceResult& found) {
  ist_distance_result result{};
  result.lower = found.distance.lower;
  result.upper = found.distance.upper;
  result.sphere_tests = found.sphere_tests;
  result.complete = found.complete;
  result.narrowest = found.narrowest;
  result.rotation_error = found.rotation_error;
  result.nearest_known = copy_nearest(found.nearest, result);
  return result;
}

ist_near_pair near_pair_of(const NearPair& pair) {
  ist_near_pair out;
  out.fixed = pair.triangles.fixed;
  out.moving = pair.triangles.moving;
  out.distance = pair.distance;
  copy(pair.fixed_point, out.fixed_point);
  copy(pair.moving_point, out.moving_point);
  copy(pair.direction(), out.direction);
  out.fixed_part = static_cast<std::int32_t>(pair.fixed_part);
  out.moving_part = static_cast<std::int32_t>(pair.moving_part);
  return out;
}

// The library's pairs stand in the caller's array, so that none need other memory. The last pair is
// converted first: no element of the array then reaches a pair before its own.
static_assert(sizeof(NearPair) <= sizeof(ist_near_pair) &&
              alignof(NearPair) <= alignof(ist_near_pair));
std::span<NearPair> memory_in(ist_near_pair* pairs, std::size_t capacity) {
  return {reinterpret_cast<NearPair*>(pairs), capacity};
}
void convert(std::span<const NearPair> found, ist_near_pair* pairs) {
  for (std::size_t k = found.size(); k-- > 0;) pairs[k] = near_pair_of(NearPair(found[k]));
}

ist_near_pairs_result result_of(const NearPairsResult& found, std::size_t capacity) {
  ist_near_pairs_result result{};
  result.pairs = found.near_pairs;
  result.written = std::min<std::uint64_t>(found.near_pairs, capacity);
  result.sphere_tests = found.sphere_tests;
  result.truncated = found.near_pairs > capacity;
  result.complete = found.complete;
  result.found = static_cast<std::int32_t>(found.found);
  result.pad = found.pad;
  result.rotation_error = found.rotation_error;
  return result;
}

void check_margin(Call& call, double margin) {
  if (margin >= 0 && std::isfinite(margin)) return;
  call.fail(IST_ARGUMENT_INVALID, "margin is {}: pass a finite number of at least 0", margin);
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
    write_sized(result_of(found), *result);
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

ist_status ist_query_near_pairs(ist_query* query, const double pose[16], double margin,
                                const ist_budget* budget, ist_near_pair* pairs, size_t capacity,
                                ist_near_pairs_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "result", result);
    call.need("pose", pose);
    call.need_array("pairs", pairs, capacity);
    check_margin(call, margin);
    const ist::Budget allowed = read_budget(call, budget);
    const Held<QueryObject> held(call, "query", query);
    if (!held) return;
    const std::span<ist::NearPair> memory = memory_in(pairs, capacity);
    const ist::NearPairsResult found =
        held->query.near_pairs(to_isometry(pose), margin, memory, allowed);
    if (!answered(call, found.status, pose)) return;
    const ist_near_pairs_result values = result_of(found, capacity);
    convert(memory.first(static_cast<std::size_t>(values.written)), pairs);
    write_sized(values, *result);
  });
}

ist_status ist_query_near_parts(ist_query* query, const double pose[16], uint32_t fixed,
                                uint32_t moving, double margin, ist_near_pair* parts,
                                size_t capacity, ist_near_pairs_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "result", result);
    call.need("pose", pose);
    call.need_array("parts", parts, capacity);
    check_margin(call, margin);
    const Held<QueryObject> held(call, "query", query);
    if (!held) return;
    std::array<ist::NearPair, IST_MOST_NEAR_PARTS> all;
    const ist::NearPairsResult found =
        held->query.near_parts(to_isometry(pose), {fixed, moving}, margin, all);
    if (found.status == ist::QueryStatus::kNoSuchTriangle) {
      call.fail(
          IST_ARGUMENT_INVALID,
          "fixed is {} and moving is {}, and the meshes have {} and {} triangles: pass indices "
          "below these numbers",
          fixed, moving, held->query.fixed().triangles()->triangles.size(),
          held->query.moving().triangles()->triangles.size());
    }
    if (!answered(call, found.status, pose)) return;
    const ist_near_pairs_result values = result_of(found, capacity);
    convert({all.data(), static_cast<std::size_t>(values.written)}, parts);
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
