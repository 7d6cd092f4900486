#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>

#include "c/follower.h"
#include "c/handle_table.h"
#include "c/sized_struct.h"
#include "ist/base/api.h"
#include "ist/mesh/mesh.h"
#include "ist/query/query.h"
#include "ist/tree/sphere_tree.h"

/// The objects of handles, except Servo (ist_c_servo.cpp) and WorldObject (world/), and what the
/// functions on them share.
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

  SphereTree tree;
};

struct QueryObject {
  using Handle = ist_query;
  static constexpr HandleKind kKind = HandleKind::kQuery;
  static constexpr HandleUse kUse = HandleUse::kAlone;
  static constexpr const char* kName = "query";

  /// @param manifold_options empty: the query gives no contacts, as without voxels
  QueryObject(const SphereTree& fixed, const SphereTree& moving, const QueryOptions& options,
              const std::optional<ManifoldOptions>& manifold_options)
      : query(fixed, moving, options), query_options(options) {
    if (!manifold_options || !has_voxels()) return;
    contact_options = *manifold_options;
    max_contacts = manifold_options->points;
    manifold.emplace(fixed, moving, query.policy(), *manifold_options);
  }

  [[nodiscard]] bool has_voxels() const noexcept {
    return query.fixed().has_voxels() && query.moving().has_voxels();
  }

  Query query;
  QueryOptions query_options;  // for further queries of the same bodies
  ManifoldOptions contact_options;
  std::optional<ContactManifold> manifold;
  std::size_t max_contacts = 0;
};

/// Converts a policy to its IST_SPHERES_...
[[nodiscard]] constexpr std::int32_t spheres_of(SpherePolicy policy) noexcept {
  return static_cast<std::int32_t>(policy) + IST_SPHERES_SIMPLE;
}
/// Converts the policy of a tree or a query; IST_SPHERES_DEFAULT if it lacks voxels.
[[nodiscard]] constexpr std::int32_t spheres_of(SpherePolicy policy, bool has_voxels) noexcept {
  return has_voxels ? spheres_of(policy) : IST_SPHERES_DEFAULT;
}
static_assert(spheres_of(SpherePolicy::kSimple) == IST_SPHERES_SIMPLE &&
              spheres_of(SpherePolicy::kTable) == IST_SPHERES_TABLE &&
              spheres_of(SpherePolicy::kTight) == IST_SPHERES_TIGHT &&
              spheres_of(SpherePolicy::kSlab) == IST_SPHERES_SLAB);

[[nodiscard]] constexpr bool are_spheres(std::int32_t spheres) noexcept {
  return spheres >= IST_SPHERES_DEFAULT && spheres <= IST_SPHERES_SLAB;
}
/// Converts an IST_SPHERES_... to its policy; empty for the default. Precondition: are_spheres.
[[nodiscard]] constexpr std::optional<SpherePolicy> policy_of(std::int32_t spheres) noexcept {
  if (spheres == IST_SPHERES_DEFAULT) return std::nullopt;
  return static_cast<SpherePolicy>(spheres - IST_SPHERES_SIMPLE);
}

/// Converts an answer to its IST_ANSWER_...
[[nodiscard]] constexpr std::int32_t answer_of(Answer answer) noexcept {
  return static_cast<std::int32_t>(answer);
}
/// Converts a contact, and sums.
[[nodiscard]] ist_contact contact_of(const Contact& contact) noexcept;
[[nodiscard]] ist_contact_sums sums_of(const ContactSums& sums) noexcept;

/// Converts 16 numbers in column-major order, without a check.
[[nodiscard]] IST_LOOP_API Eigen::Isometry3d to_isometry(const double pose[16]) noexcept;

void copy(const Eigen::Vector3d& from, double (&to)[3]) noexcept;

/// Converts a caller's budget; NULL leaves the default, which has no limit.
[[nodiscard]] ist_status read_budget(const Call& call, const ist_budget* given, Budget& budget);

/// The options of a query, and of its contacts.
struct CQueryOptions {
  QueryOptions query;
  std::optional<ManifoldOptions> manifold = ManifoldOptions{};  // empty: no contacts
};
/// Converts a caller's options of a query (ist_c_query.cpp).
[[nodiscard]] ist_status read_query_options(const Call& call, const ist_query_options& given,
                                            CQueryOptions& options);

/// Returns IST_OK if a query gives contacts; else stores the message of an error.
[[nodiscard]] ist_status need_contacts(const Call& call, const QueryObject& query);

/// Converts a query's status; stores the message of an error.
/// @param pose the pose that was asked about, or NULL
[[nodiscard]] IST_LOOP_API ist_status status_of(const Call& call, QueryStatus status,
                                                const double* pose = nullptr);

/// Implements every ..._get_info by `info_of(object)`.
template <typename T, SizedStruct Info, typename Body>
[[nodiscard]] ist_status get_info(const char* function, const typename T::Handle* handle,
                                  Info* info, const Body& info_of) noexcept {
  return guarded(function, [&](const Call& call) -> ist_status {
    if (const ist_status wrong = clear_sized(call, "info", info)) return wrong;
    const Held<T> held(call, T::kName, handle);
    if (held.status() != IST_OK) return held.status();
    write_sized(info_of(*held), *info);
    return IST_OK;
  });
}

/// Implements every function that makes an object of a file, by `read(path)`.
template <typename T, typename Read>
[[nodiscard]] ist_status read_object(const char* function, const char* path,
                                     const ist_progress* progress, typename T::Handle** out,
                                     const Read& read) noexcept {
  return guarded(function, [&](const Call& call) -> ist_status {
    if (const ist_status missing = call.need({{T::kName, out}})) return missing;
    *out = nullptr;
    if (const ist_status missing = call.need({{"path", path}})) return missing;
    Follower follower;
    if (const ist_status wrong = read_follower(call, progress, follower)) return wrong;
    std::unique_ptr<T> made;
    const bool whole =
        followed(follower, [&](const Proceed&) { made = std::make_unique<T>(read(path)); });
    return whole ? give(call, std::move(made), out) : cancelled(call);
  });
}

}  // namespace ist::capi
