#include <algorithm>

#include "ist/capi/world/world_object.h"

namespace ist::capi {
namespace {

// The status of a pair, which is no error of the call.
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

ist_world_pair pair_of(const NearPair& near) {
  ist_world_pair out{};
  out.a = near.bodies.a;
  out.b = near.bodies.b;
  out.status = status_of_pair(near.status);
  out.distance_lower = near.roots.lower;
  out.distance_upper = near.roots.upper;
  return out;
}

// The members that the results of all verbs have in common.
template <class Pair>
ist_world_pair asked(const Pair& pair) {
  ist_world_pair out = pair_of(pair);
  out.status = status_of_pair(pair.result.status);
  out.complete = pair.result.complete;
  out.sphere_tests = pair.result.sphere_tests;
  out.rotation_error = pair.result.rotation_error;
  return out;
}

void set_leaf_pairs(const QueryResult& result, ist_world_pair& out) {
  out.found = result.leaf_pairs;
  out.truncated = result.truncated;
  out.resolution = result.resolution;
  if (!result.distance) return;
  out.distance_lower = result.distance->lower;
  out.distance_upper = result.distance->upper;
}

ist_world_pair convert(const NearPair& pair) { return pair_of(pair); }
ist_world_pair convert(const PairIntersection& pair) {
  ist_world_pair out = asked(pair);
  out.answer = answer_of(pair.result.answer);
  out.resolution = pair.result.resolution;
  return out;
}
ist_world_pair convert(const PairContacts& pair) {
  ist_world_pair out = asked(pair);
  set_leaf_pairs(pair.result, out);
  if (pair.manifold != nullptr) out.contacts = pair.manifold->points().size();
  return out;
}
ist_world_pair convert(const PairDistance& pair) {
  ist_world_pair out = asked(pair);
  if (pair.result.status == QueryStatus::kInvalidPose) return out;
  out.distance_lower = pair.result.distance.lower;
  out.distance_upper = pair.result.distance.upper;
  out.narrowest = pair.result.narrowest;
  return out;
}
ist_world_pair convert(const PairLeaves& pair) {
  ist_world_pair out = asked(pair);
  set_leaf_pairs(pair.result, out);
  out.written = pair.pairs.size();
  return out;
}
ist_world_pair convert(const PairTriangles& pair) {
  ist_world_pair out = asked(pair);
  out.found = pair.result.triangle_pairs;
  out.truncated = pair.result.truncated;
  out.written = pair.pairs.size();
  return out;
}

ist_status check_nothing(const Call&) { return IST_OK; }

// Implements every verb with one answer for each pair, by ask(world, budget); `check` sees to
// further arguments.
template <class Check, class Ask>
ist_status ask_pairs(const char* function, ist_world* world, const ist_budget* budget,
                     ist_world_pair* pairs, std::size_t capacity, ist_world_result* result,
                     const Check& check, const Ask& ask) noexcept {
  return guarded(function, [&](const Call& call) -> ist_status {
    if (const ist_status wrong = clear_sized(call, "result", result)) return wrong;
    if (const ist_status missing = call.need_array("pairs", pairs, capacity)) return missing;
    if (const ist_status wrong = check(call)) return wrong;
    Budget allowed;
    if (const ist_status wrong = read_budget(call, budget, allowed)) return wrong;
    const Held<WorldObject> held(call, "world", world);
    if (held.status() != IST_OK) return held.status();
    const auto found = ask(*held, allowed);
    if (const ist_status wrong = status_of_world(call, found.status)) return wrong;
    ist_world_result values{};
    values.near_pairs = found.near_pairs;
    values.written = std::min<std::uint64_t>(found.pairs.size(), capacity);
    values.sphere_tests = found.sphere_tests;
    values.complete = found.complete;
    values.truncated = values.written < found.near_pairs;
    std::uint64_t first = 0;
    for (std::size_t k = 0; k < values.written; ++k) {
      pairs[k] = convert(found.pairs[k]);
      pairs[k].first = first;
      first += pairs[k].written;
    }
    write_sized(values, *result);
    return IST_OK;
  });
}

ist_status check_tolerance(const Call& call, double tolerance) {
  if (tolerance >= 0) return IST_OK;
  return call.fail(IST_ARGUMENT_INVALID, "tolerance is {}: pass a number of at least 0", tolerance);
}

}  // namespace
}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_world_near_pairs(ist_world* world, ist_world_pair* pairs, size_t capacity,
                                ist_world_result* result) IST_NOEXCEPT {
  return ask_pairs(__func__, world, nullptr, pairs, capacity, result, check_nothing,
                   [](WorldObject& of, const ist::Budget&) { return of.world.near_pairs(); });
}

ist_status ist_world_intersects(ist_world* world, const ist_budget* budget, ist_world_pair* pairs,
                                size_t capacity, ist_world_result* result) IST_NOEXCEPT {
  return ask_pairs(
      __func__, world, budget, pairs, capacity, result, check_nothing,
      [](WorldObject& of, const ist::Budget& allowed) { return of.world.intersects(allowed); });
}

ist_status ist_world_contacts(ist_world* world, const ist_budget* budget, ist_world_pair* pairs,
                              size_t capacity, ist_world_result* result) IST_NOEXCEPT {
  return ask_pairs(__func__, world, budget, pairs, capacity, result, check_nothing,
                   [](WorldObject& of, const ist::Budget& allowed) {
                     const auto found = of.world.contacts(allowed);
                     of.contacts = found.pairs;
                     return found;
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
    const ist::BodyPair bodies{std::min(a, b), std::max(a, b)};
    const auto pair = std::lower_bound(
        held->contacts.begin(), held->contacts.end(), bodies,
        [](const ist::PairContacts& one, ist::BodyPair wanted) { return one.bodies < wanted; });
    if (pair == held->contacts.end() || pair->bodies != bodies || pair->manifold == nullptr) {
      return call.fail(
          IST_NOT_PREPARED,
          "the last ist_world_contacts did not ask bodies {} and {}: prepare the pair, "
          "and look at its status",
          a, b);
    }
    const std::span<const ist::Contact> made = pair->manifold->points();
    *count = made.size();
    const std::size_t written = std::min(made.size(), capacity);
    std::transform(made.begin(), made.begin() + static_cast<std::ptrdiff_t>(written), contacts,
                   contact_of);
    if (sums != nullptr) write_sized(sums_of(pair->manifold->sums()), *sums);
    return IST_OK;
  });
}

ist_status ist_world_leaf_pairs(ist_world* world, const ist_budget* budget,
                                ist_leaf_pair* leaf_pairs, size_t leaf_capacity,
                                ist_world_pair* pairs, size_t capacity,
                                ist_world_result* result) IST_NOEXCEPT {
  return ask_pairs(
      __func__, world, budget, pairs, capacity, result,
      [&](const Call& call) { return call.need_array("leaf_pairs", leaf_pairs, leaf_capacity); },
      [&](WorldObject& of, const ist::Budget& allowed) {
        return of.world.leaf_pairs({reinterpret_cast<ist::LeafPair*>(leaf_pairs), leaf_capacity},
                                   allowed);
      });
}

ist_status ist_world_triangle_pairs(ist_world* world, const ist_budget* budget,
                                    ist_triangle_pair* triangles, size_t triangle_capacity,
                                    ist_world_pair* pairs, size_t capacity,
                                    ist_world_result* result) IST_NOEXCEPT {
  return ask_pairs(
      __func__, world, budget, pairs, capacity, result,
      [&](const Call& call) { return call.need_array("triangles", triangles, triangle_capacity); },
      [&](WorldObject& of, const ist::Budget& allowed) {
        return of.world.triangle_pairs(
            {reinterpret_cast<ist::TrianglePair*>(triangles), triangle_capacity}, allowed);
      });
}

ist_status ist_world_distances(ist_world* world, double tolerance, const ist_budget* budget,
                               ist_world_pair* pairs, size_t capacity,
                               ist_world_result* result) IST_NOEXCEPT {
  return ask_pairs(
      __func__, world, budget, pairs, capacity, result,
      [&](const Call& call) { return check_tolerance(call, tolerance); },
      [&](WorldObject& of, const ist::Budget& allowed) {
        return of.world.distances(tolerance, allowed);
      });
}

ist_status ist_world_distance(ist_world* world, double tolerance, const ist_budget* budget,
                              ist_least_distance* result) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status wrong = clear_sized(call, "result", result)) return wrong;
    if (const ist_status wrong = check_tolerance(call, tolerance)) return wrong;
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
