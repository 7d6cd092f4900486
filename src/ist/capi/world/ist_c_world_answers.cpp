#include <algorithm>
#include <optional>

#include "ist/capi/world/world_object.h"

namespace ist::capi {
namespace {

// Returns the status of a pair. It is no error of the call.
ist_status status_of_pair(QueryStatus status) {
  switch (status) {
    case QueryStatus::kDone:
      return IST_OK;
    case QueryStatus::kInvalidPose:
      return IST_POSE_INVALID;
    case QueryStatus::kNoTriangles:
      return IST_TRIANGLES_MISSING;
    default:
      return IST_NOT_PREPARED;
  }
}

ist_world_pair pair_of(const WorldPair& pair) {
  ist_world_pair out{};
  out.a = pair.bodies.a;
  out.b = pair.bodies.b;
  out.status = status_of_pair(pair.status);
  out.answer = answer_of(pair.answer);
  out.complete = pair.complete;
  out.truncated = pair.truncated;
  out.distance_lower = pair.distance.lower;
  out.distance_upper = pair.distance.upper;
  out.found = pair.found;
  out.first = pair.first;
  out.written = pair.written;
  out.contacts = pair.manifold != nullptr ? pair.manifold->points().size() : 0;
  out.resolution = pair.resolution;
  out.narrowest = pair.narrowest;
  out.sphere_tests = pair.sphere_tests;
  out.rotation_error = pair.rotation_error;
  return out;
}

std::optional<WorldQuestion::Kind> kind_of(std::int32_t ask) {
  switch (ask) {
    case IST_ASK_NEAR:
      return WorldQuestion::kNear;
    case IST_ASK_INTERSECTS:
      return WorldQuestion::kIntersects;
    case IST_ASK_LEAF_PAIRS:
      return WorldQuestion::kLeafPairs;
    case IST_ASK_DISTANCE:
      return WorldQuestion::kDistance;
    case IST_ASK_CONTACTS:
      return WorldQuestion::kContacts;
    case IST_ASK_TRIANGLE_PAIRS:
      return WorldQuestion::kTrianglePairs;
    default:
      return std::nullopt;
  }
}

ist_status check_tolerance(const Call& call, const char* name, double tolerance) {
  if (tolerance >= 0) return IST_OK;
  return call.fail(IST_ARGUMENT_INVALID, "{} is {}: pass a number of at least 0", name, tolerance);
}

ist_status read_question(const Call& call, const ist_world_question* given,
                         WorldQuestion& question) {
  if (const ist_status missing = call.need({{"question", given}})) return missing;
  ist_world_question known;
  if (const ist_status wrong = read_sized(call, "question", *given, known)) return wrong;
  const auto kind = kind_of(known.ask);
  if (!kind) {
    return call.fail(IST_ARGUMENT_INVALID,
                     "question->ask is {}: pass one IST_ASK_... other than a penetration",
                     known.ask);
  }
  if (const ist_status wrong = check_tolerance(call, "question->tolerance", known.tolerance)) {
    return wrong;
  }
  if (const ist_status missing =
          call.need_array("question->leaf_pairs", known.leaf_pairs, known.leaf_capacity)) {
    return missing;
  }
  if (const ist_status missing =
          call.need_array("question->triangles", known.triangles, known.triangle_capacity)) {
    return missing;
  }
  question = {*kind,
              known.tolerance,
              {reinterpret_cast<LeafPair*>(known.leaf_pairs), known.leaf_capacity},
              {reinterpret_cast<TrianglePair*>(known.triangles), known.triangle_capacity}};
  return IST_OK;
}

}  // namespace
}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_world_ask(ist_world* world, const ist_world_question* question,
                         const ist_budget* budget, ist_world_pair* pairs, size_t capacity,
                         ist_world_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status wrong = clear_sized(call, "result", result)) return wrong;
    if (const ist_status missing = call.need_array("pairs", pairs, capacity)) return missing;
    ist::WorldQuestion asked;
    if (const ist_status wrong = read_question(call, question, asked)) return wrong;
    ist::Budget allowed;
    if (const ist_status wrong = read_budget(call, budget, allowed)) return wrong;
    const Held<WorldObject> held(call, "world", world);
    if (held.status() != IST_OK) return held.status();
    const ist::WorldAnswer found = held->world.ask(asked, allowed);
    if (const ist_status wrong = status_of_world(call, found.status)) return wrong;
    ist_world_result values{};
    values.near_pairs = found.near_pairs;
    values.written = std::min<std::uint64_t>(found.pairs.size(), capacity);
    values.sphere_tests = found.sphere_tests;
    values.complete = found.complete;
    values.truncated = values.written < found.near_pairs;
    std::transform(found.pairs.begin(),
                   found.pairs.begin() + static_cast<std::ptrdiff_t>(values.written), pairs,
                   pair_of);
    write_sized(values, *result);
    return IST_OK;
  });
}

ist_status ist_world_get_contacts(ist_world* world, uint32_t a, uint32_t b, ist_contact* contacts,
                                  size_t capacity, ist_contact_sums* sums,
                                  uint64_t* count) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status missing = call.need({{"count", count}})) return missing;
    *count = 0;
    if (sums != nullptr) {
      if (const ist_status wrong = clear_sized(call, "sums", sums)) return wrong;
    }
    if (const ist_status missing = call.need_array("contacts", contacts, capacity)) return missing;
    const Held<WorldObject> held(call, "world", world);
    if (held.status() != IST_OK) return held.status();
    const ist::ContactManifold* const manifold = held->world.manifold(a, b);
    if (manifold == nullptr) {
      return call.fail(IST_NOT_PREPARED,
                       "the last ist_world_ask for IST_ASK_CONTACTS did not ask bodies {} and {}: "
                       "prepare the pair, and look at its status",
                       a, b);
    }
    const std::span<const ist::Contact> made = manifold->points();
    *count = made.size();
    const std::size_t written = std::min(made.size(), capacity);
    std::transform(made.begin(), made.begin() + static_cast<std::ptrdiff_t>(written), contacts,
                   contact_of);
    if (sums != nullptr) write_sized(sums_of(manifold->sums()), *sums);
    return IST_OK;
  });
}

ist_status ist_world_distance(ist_world* world, double tolerance, const ist_budget* budget,
                              ist_least_distance* result) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status wrong = clear_sized(call, "result", result)) return wrong;
    if (const ist_status wrong = check_tolerance(call, "tolerance", tolerance)) return wrong;
    ist::Budget allowed;
    if (const ist_status wrong = read_budget(call, budget, allowed)) return wrong;
    const Held<WorldObject> held(call, "world", world);
    if (held.status() != IST_OK) return held.status();
    const ist::WorldDistance found = held->world.distance(tolerance, allowed);
    const bool lost = found.status == ist::QueryStatus::kInvalidPose;
    if (!lost) {
      if (const ist_status wrong = status_of_world(call, found.status)) return wrong;
    }
    const ist::BodyPair nearest = found.nearest.value_or(ist::BodyPair{});
    write_sized({0, found.distance.lower, found.distance.upper, found.sphere_tests, found.complete,
                 lost, found.nearest.has_value(), nearest.a, nearest.b, 0},
                *result);
    return IST_OK;
  });
}
