#include <algorithm>
#include <optional>
#include <vector>

#include "c/objects.h"
#include "ist/capi/ist_world.h"
#include "ist/query/world/world.h"

namespace ist::capi {
namespace {

static_assert(IST_MOST_BODIES == kMostBodies);
static_assert(IST_MOST_THREADS == kMostThreads);

struct WorldObject : OfHandle<ist_world, HandleKind::kWorld, HandleUse::kAlone> {
  explicit WorldObject(const WorldOptions& options) : world(options) {}
  World world;
};

// Returns whether a whole answer is there; fails if not. `pose` is the pose that was asked about,
// or null.
bool world_answered(Call& call, QueryStatus status, const double* pose = nullptr) {
  if (status == QueryStatus::kNoSuchBody) {
    call.fail(IST_ARGUMENT_INVALID, "no body has this number: pass one that was added");
  } else if (status == QueryStatus::kNotPrepared) {
    call.fail(IST_NOT_PREPARED,
              "the world is not prepared: call ist_world_reserve after the last body");
  }
  return answered(call, status, pose);
}

WorldOptions read_world_options(Call& call, const ist_world_options* given) {
  const ist_world_options known = read_sized(call, "options", given);
  WorldOptions options;
  if (known.query != nullptr) {
    const CQueryOptions query = read_query_options(call, known.query);
    options.query = query.query;
    if (query.manifold) options.manifold = *query.manifold;
    if (!query.manifold) options.manifold.points = 0;
  }
  if (given != nullptr) options.reach = known.reach;
  if (known.pair_caches > 0) options.pair_caches = known.pair_caches;
  if (known.threads < 0) {
    call.fail(IST_ARGUMENT_INVALID, "options->threads is {}: pass 1 to {}", known.threads,
              IST_MOST_THREADS);
  } else if (known.threads > 0) {
    options.threads = static_cast<std::size_t>(known.threads);
  }
  if (known.max_memory > 0) options.max_memory = known.max_memory;
  return options;
}

// Returns the status of a pair. The call itself succeeds.
ist_status status_of_pair(QueryStatus status) {
  switch (status) {
    case QueryStatus::kDone:
      return IST_OK;
    case QueryStatus::kInvalidPose:
      return IST_POSE_INVALID;
    case QueryStatus::kNoTriangles:
      return IST_TRIANGLES_MISSING;
    case QueryStatus::kNoVoxels:
      return IST_VOXELS_MISSING;
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
  out.nearest_known = copy_nearest(pair.nearest, out);
  return out;
}

ist_least_distance least_of(const WorldDistance& found) {
  ist_least_distance out{};
  out.lower = found.distance.lower;
  out.upper = found.distance.upper;
  out.sphere_tests = found.sphere_tests;
  out.complete = found.complete;
  out.pose_missing = found.status == QueryStatus::kInvalidPose;
  if (!found.nearest) return out;
  out.nearest_known = 1;
  out.a = found.nearest->a;
  out.b = found.nearest->b;
  for (const WorldPair& pair : found.pairs) {
    if (pair.bodies == *found.nearest) out.points_known = copy_nearest(pair.nearest, out);
  }
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

WorldQuestion read_question(Call& call, const ist_world_question* given) {
  call.need("question", given);
  const ist_world_question known = read_sized(call, "question", given);
  const auto kind = kind_of(known.ask);
  if (!kind) {
    call.fail(IST_ARGUMENT_INVALID,
              "question->ask is {}: pass one IST_ASK_... other than a penetration", known.ask);
  }
  check_tolerance(call, "question->tolerance", known.tolerance);
  call.need_array("question->leaf_pairs", known.leaf_pairs, known.leaf_capacity);
  call.need_array("question->triangles", known.triangles, known.triangle_capacity);
  return {kind.value_or(WorldQuestion::kNear),
          known.tolerance,
          {reinterpret_cast<LeafPair*>(known.leaf_pairs), known.leaf_capacity},
          {reinterpret_cast<TrianglePair*>(known.triangles), known.triangle_capacity}};
}

}  // namespace

}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_world_create(const ist_world_options* options, ist_world** world) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.clear("world", world);
    const ist::WorldOptions known = read_world_options(call, options);
    if (call.status() == IST_OK) give(call, std::make_unique<WorldObject>(known), world);
  });
}

ist_status ist_world_add(ist_world* world, const ist_tree* tree, const double pose[16],
                         const char* name, uint32_t* body) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.clear("body", body);
    const Held<WorldObject> held(call, "world", world);
    if (!held) return;
    const Held<Tree> of_tree(call, "tree", tree);
    if (!of_tree) return;
    const Eigen::Isometry3d at =
        pose == nullptr ? Eigen::Isometry3d::Identity() : to_isometry(pose);
    *body = held->world.add(of_tree->tree, at, name == nullptr ? "" : name);
  });
}

ist_status ist_world_ignore(ist_world* world, uint32_t a, uint32_t b) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    const Held<WorldObject> held(call, "world", world);
    if (!held) return;
    held->world.ignore(a, b);
  });
}

ist_status ist_world_bytes_needed(ist_world* world, uint64_t near_pairs,
                                  uint64_t* bytes) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.clear("bytes", bytes);
    const Held<WorldObject> held(call, "world", world);
    if (!held) return;
    *bytes = held->world.bytes_needed(near_pairs);
  });
}

ist_status ist_world_reserve(ist_world* world, uint64_t near_pairs) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    const Held<WorldObject> held(call, "world", world);
    if (!held) return;
    held->world.reserve(near_pairs);
  });
}

ist_status ist_world_get_info(ist_world* world, ist_world_info* info) IST_NOEXCEPT {
  return get_info<WorldObject>(__func__, world, info, [](const WorldObject& of) {
    return ist_world_info{0, of.world.bytes(), of.world.body_count()};
  });
}

ist_status ist_world_set_pose(ist_world* world, uint32_t body, const double pose[16]) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.need("pose", pose);
    const Held<WorldObject> held(call, "world", world);
    if (!held) return;
    world_answered(call, held->world.set_pose(body, to_isometry(pose)), pose);
  });
}

ist_status ist_world_get_pose(ist_world* world, uint32_t a, uint32_t b,
                              double pose[16]) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    if (call.need("pose", pose)) std::fill_n(pose, 16, 0.0);
    const Held<WorldObject> held(call, "world", world);
    if (!held) return;
    if (std::max(a, b) >= held->world.body_count()) {
      return static_cast<void>(world_answered(call, ist::QueryStatus::kNoSuchBody));
    }
    const auto found = held->world.pose_of(a, b);
    if (!answered(call, found ? ist::QueryStatus::kDone : ist::QueryStatus::kInvalidPose)) return;
    std::copy_n(found->matrix().data(), 16, pose);
  });
}

ist_status ist_world_forget(ist_world* world) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    const Held<WorldObject> held(call, "world", world);
    if (!held) return;
    held->world.forget();
  });
}

ist_status ist_world_free(ist_world* world) IST_NOEXCEPT {
  return give_back<WorldObject>(__func__, world);
}

ist_status ist_world_ask(ist_world* world, const ist_world_question* question,
                         const ist_budget* budget, ist_world_pair* pairs, size_t capacity,
                         ist_world_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "result", result);
    call.need_array("pairs", pairs, capacity);
    const ist::WorldQuestion asked = read_question(call, question);
    const ist::Budget allowed = read_budget(call, budget);
    const Held<WorldObject> held(call, "world", world);
    if (!held) return;
    const ist::WorldAnswer found = held->world.ask(asked, allowed);
    if (!world_answered(call, found.status)) return;
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
  });
}

ist_status ist_world_get_contacts(ist_world* world, uint32_t a, uint32_t b, ist_contact* contacts,
                                  size_t capacity, ist_contact_sums* sums,
                                  uint64_t* count) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.clear("count", count);
    if (sums != nullptr) clear_sized(call, "sums", sums);
    call.need_array("contacts", contacts, capacity);
    const Held<WorldObject> held(call, "world", world);
    if (!held) return;
    const ist::ContactManifold* const manifold = held->world.manifold(a, b);
    if (manifold == nullptr) {
      return call.fail(IST_NOT_PREPARED,
                       "the last ist_world_ask for IST_ASK_CONTACTS did not ask bodies {} and {}: "
                       "look at the pair's status, and reserve for more near pairs",
                       a, b);
    }
    const std::span<const ist::Contact> made = manifold->points();
    *count = made.size();
    const std::size_t written = std::min(made.size(), capacity);
    std::transform(made.begin(), made.begin() + static_cast<std::ptrdiff_t>(written), contacts,
                   contact_of);
    if (sums != nullptr) write_sized(sums_of(manifold->sums()), *sums);
  });
}

ist_status ist_world_distance(ist_world* world, double tolerance, const ist_budget* budget,
                              ist_least_distance* result) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "result", result);
    check_tolerance(call, "tolerance", tolerance);
    const ist::Budget allowed = read_budget(call, budget);
    const Held<WorldObject> held(call, "world", world);
    if (!held) return;
    const ist::WorldDistance found = held->world.distance(tolerance, allowed);
    const ist_least_distance values = least_of(found);
    if (values.pose_missing == 0 && !world_answered(call, found.status)) return;
    write_sized(values, *result);
  });
}
