#include <algorithm>
#include <optional>
#include <vector>

#include "ist/capi/world/world_object.h"

namespace ist::capi {
namespace {

ist_status read_world_options(const Call& call, const ist_world_options* given,
                              WorldOptions& options) {
  if (given == nullptr) return IST_OK;
  ist_world_options known;
  if (const ist_status wrong = read_sized(call, "options", *given, known)) return wrong;
  if (known.query != nullptr) {
    CQueryOptions query;
    if (const ist_status wrong = read_query_options(call, *known.query, query)) return wrong;
    options.query = query.query;
    if (query.manifold) options.manifold = *query.manifold;
    if (!query.manifold) options.manifold.points = 0;
  }
  options.reach = known.reach;
  if (known.most_near > 0) options.most_near = known.most_near;
  if (known.max_memory > 0) options.max_memory = known.max_memory;
  return IST_OK;
}

// The pairs of a caller; empty for all.
std::optional<std::vector<BodyPair>> pairs_of(const ist_body_pair* pairs, std::size_t count) {
  if (pairs == nullptr) return std::nullopt;
  std::vector<BodyPair> made;
  for (const auto& [a, b] : std::span(pairs, count)) made.push_back({a, b});
  return made;
}

}  // namespace

ist_status status_of_world(const Call& call, QueryStatus status, const double* pose) {
  if (status == QueryStatus::kNoSuchBody) {
    return call.fail(IST_ARGUMENT_INVALID, "no body has this number: pass one that was added");
  }
  if (status == QueryStatus::kNotPrepared) {
    return call.fail(IST_NOT_PREPARED,
                     "the world is not prepared: call ist_world_prepare after the last body");
  }
  return status_of(call, status, pose);
}

}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_world_create(const ist_world_options* options, ist_world** world) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status missing = call.need({{"world", world}})) return missing;
    *world = nullptr;
    ist::WorldOptions known;
    if (const ist_status wrong = read_world_options(call, options, known)) return wrong;
    return give(call, std::make_unique<WorldObject>(known), world);
  });
}

ist_status ist_world_add(ist_world* world, const ist_tree* tree, const double pose[16],
                         const char* name, uint32_t* body) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status missing = call.need({{"body", body}})) return missing;
    *body = 0;
    const Held<WorldObject> held(call, "world", world);
    if (held.status() != IST_OK) return held.status();
    const Held<Tree> of_tree(call, "tree", tree);
    if (of_tree.status() != IST_OK) return of_tree.status();
    const Eigen::Isometry3d at =
        pose == nullptr ? Eigen::Isometry3d::Identity() : to_isometry(pose);
    *body = held->world.add(of_tree->tree, at, name == nullptr ? "" : name);
    return IST_OK;
  });
}

ist_status ist_world_ignore(ist_world* world, uint32_t a, uint32_t b) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    const Held<WorldObject> held(call, "world", world);
    if (held.status() != IST_OK) return held.status();
    held->world.ignore(a, b);
    return IST_OK;
  });
}

ist_status ist_world_bytes_needed(ist_world* world, const ist_body_pair* pairs, size_t count,
                                  uint64_t* bytes) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status missing = call.need({{"bytes", bytes}})) return missing;
    *bytes = 0;
    if (const ist_status missing = call.need_array("pairs", pairs, count)) return missing;
    const Held<WorldObject> held(call, "world", world);
    if (held.status() != IST_OK) return held.status();
    const auto some = pairs_of(pairs, count);
    *bytes = some ? held->world.bytes_needed(*some) : held->world.bytes_needed();
    return IST_OK;
  });
}

ist_status ist_world_prepare(ist_world* world, const ist_body_pair* pairs, size_t count,
                             const ist_progress* progress) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status missing = call.need_array("pairs", pairs, count)) return missing;
    Follower follower;
    if (const ist_status wrong = read_follower(call, progress, follower)) return wrong;
    const Held<WorldObject> held(call, "world", world);
    if (held.status() != IST_OK) return held.status();
    const auto some = pairs_of(pairs, count);
    bool prepared = false;
    followed(follower, [&](const ist::Proceed& proceed) {
      held->world.prepare(some, proceed);
      prepared = true;
    });
    // A caller who says stop after the last pair is too late.
    return prepared ? IST_OK : cancelled(call);
  });
}

ist_status ist_world_get_info(ist_world* world, ist_world_info* info) IST_NOEXCEPT {
  return get_info<WorldObject>(__func__, world, info, [](const WorldObject& of) {
    return ist_world_info{0, of.world.bytes(), of.world.body_count()};
  });
}

ist_status ist_world_set_pose(ist_world* world, uint32_t body, const double pose[16]) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status missing = call.need({{"pose", pose}})) return missing;
    const Held<WorldObject> held(call, "world", world);
    if (held.status() != IST_OK) return held.status();
    return status_of_world(call, held->world.set_pose(body, to_isometry(pose)), pose);
  });
}

ist_status ist_world_get_pose(ist_world* world, uint32_t a, uint32_t b,
                              double pose[16]) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status missing = call.need({{"pose", pose}})) return missing;
    std::fill_n(pose, 16, 0.0);
    const Held<WorldObject> held(call, "world", world);
    if (held.status() != IST_OK) return held.status();
    if (std::max(a, b) >= held->world.body_count()) {
      return status_of_world(call, ist::QueryStatus::kNoSuchBody);
    }
    const auto found = held->world.pose_of(a, b);
    if (!found) return status_of(call, ist::QueryStatus::kInvalidPose);
    std::copy_n(found->matrix().data(), 16, pose);
    return IST_OK;
  });
}

ist_status ist_world_forget(ist_world* world) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    const Held<WorldObject> held(call, "world", world);
    if (held.status() != IST_OK) return held.status();
    held->world.forget();
    return IST_OK;
  });
}

ist_status ist_world_free(ist_world* world) IST_NOEXCEPT {
  return give_back<WorldObject>(__func__, world);
}
