#pragma once

#include <memory>
#include <optional>

#include "ist/capi/handle_table.h"
#include "ist/mesh/triangle_mesh.h"
#include "ist/query/collision_query.h"
#include "ist/tree/sphere_tree.h"

/// What handles are of; a servo's stands by its functions.
namespace ist::capi {

struct Mesh {
  using Handle = ist_mesh;
  static constexpr HandleKind kKind = HandleKind::kMesh;
  static constexpr HandleUse kUse = HandleUse::kShared;
  static constexpr const char* kName = "mesh";

  TriangleMesh mesh;
};

struct Tree {
  using Handle = ist_tree;
  static constexpr HandleKind kKind = HandleKind::kTree;
  static constexpr HandleUse kUse = HandleUse::kShared;
  static constexpr const char* kName = "tree";

  explicit Tree(SphereTree made) : tree(std::make_shared<const SphereTree>(std::move(made))) {}
  std::shared_ptr<const SphereTree> tree;
};

struct Query {
  using Handle = ist_query;
  static constexpr HandleKind kKind = HandleKind::kQuery;
  static constexpr HandleUse kUse = HandleUse::kAlone;
  static constexpr const char* kName = "query";

  Query(std::shared_ptr<const SphereTree> fixed_tree, std::shared_ptr<const SphereTree> moving_tree,
        const CollisionOptions& options)
      : fixed(std::move(fixed_tree)),
        moving(std::move(moving_tree)),
        query(*fixed, *moving, options) {}

  /// Contact points, at most so many; 0: none will be asked for.
  void prepare_points(std::size_t most) {
    most_points = most;
    if (most > 0) points.emplace(*fixed, *moving, query.policy(), ContactPointOptions{most});
  }

  std::shared_ptr<const SphereTree> fixed, moving;  // the query refers to them
  CollisionQuery query;
  std::optional<ContactPoints> points;
  std::size_t most_points = 0;
};

/// IST_SPHERES_... of a policy.
[[nodiscard]] constexpr std::int32_t spheres_of(SpherePolicy policy) noexcept {
  return static_cast<std::int32_t>(policy) + IST_SPHERES_SIMPLE;
}
static_assert(spheres_of(SpherePolicy::kSimple) == IST_SPHERES_SIMPLE &&
              spheres_of(SpherePolicy::kTable) == IST_SPHERES_TABLE &&
              spheres_of(SpherePolicy::kTight) == IST_SPHERES_TIGHT &&
              spheres_of(SpherePolicy::kSlab) == IST_SPHERES_SLAB);

[[nodiscard]] constexpr bool are_spheres(std::int32_t spheres) noexcept {
  return spheres >= IST_SPHERES_DEFAULT && spheres <= IST_SPHERES_SLAB;
}
/// The other way; nothing for the default. Precondition: are_spheres.
[[nodiscard]] constexpr std::optional<SpherePolicy> policy_of(std::int32_t spheres) noexcept {
  if (spheres == IST_SPHERES_DEFAULT) return std::nullopt;
  return static_cast<SpherePolicy>(spheres - IST_SPHERES_SIMPLE);
}

}  // namespace ist::capi
