#pragma once

#include "ist/capi/ist_world.h"
#include "ist/capi/objects.h"
#include "ist/query/world/world.h"

namespace ist::capi {

static_assert(IST_MOST_BODIES == kMostBodies);

struct WorldObject {
  using Handle = ist_world;
  static constexpr HandleKind kKind = HandleKind::kWorld;
  static constexpr HandleUse kUse = HandleUse::kAlone;
  static constexpr const char* kName = "world";

  explicit WorldObject(const WorldOptions& options) : world(options) {}
  World world;
};

/// Converts the status of a whole answer; stores the message of an error.
/// @param pose the pose that was asked about, or NULL
[[nodiscard]] ist_status status_of_world(const Call& call, QueryStatus status,
                                         const double* pose = nullptr);

}  // namespace ist::capi
