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

/// The objects of handles, except Servo (ist_c_servo.cpp) and WorldObject (ist_c_world.cpp), and
/// the helpers that the functions on them share.
namespace ist::capi {

struct Mesh : OfHandle<ist_mesh, HandleKind::kMesh, HandleUse::kShared> {
  Mesh() = default;
  explicit Mesh(TriangleMesh made) : mesh(std::move(made)) {}
  TriangleMesh mesh;
};

struct Tree : OfHandle<ist_tree, HandleKind::kTree, HandleUse::kShared> {
  explicit Tree(SphereTree made) : tree(std::move(made)) {}
  SphereTree tree;
};

struct QueryObject : OfHandle<ist_query, HandleKind::kQuery, HandleUse::kAlone> {
  /// @param manifold_options empty: the query does not give contacts
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

/// Copies the nearest triangles to a result that has members for them. Returns whether there are
/// any.
template <typename Result>
[[nodiscard]] bool copy_nearest(const std::optional<NearPair>& nearest, Result& result) noexcept {
  if (!nearest) return false;
  copy(nearest->fixed_point, result.nearest_fixed);
  copy(nearest->moving_point, result.nearest_moving);
  copy(nearest->direction(), result.direction);
  result.nearest_triangles[0] = nearest->triangles.fixed;
  result.nearest_triangles[1] = nearest->triangles.moving;
  return true;
}

/// Converts a caller's budget. NULL leaves the default: no limit.
[[nodiscard]] Budget read_budget(Call& call, const ist_budget* given);

/// The options of a query, and of its contacts.
struct CQueryOptions {
  QueryOptions query;
  std::optional<ManifoldOptions> manifold = ManifoldOptions{};  // empty: no contacts
};
/// Converts a caller's options of a query (ist_c_query.cpp); NULL leaves the defaults.
[[nodiscard]] CQueryOptions read_query_options(Call& call, const ist_query_options* given);

/// Fails for a negative number and for NaN, for a number that is not finite, and for a number of
/// threads below 0 or above 1024.
void check_tolerance(Call& call, const char* name, double tolerance);
void check_finite(Call& call, const char* name, double number);
IST_LOOP_API void check_threads(Call& call, const char* name, std::int32_t threads);

/// Returns whether a query gives contacts; fails if not.
[[nodiscard]] bool gives_contacts(Call& call, const QueryObject& query);

/// Fails for a status other than kDone. Returns whether the query answered.
/// @param pose the pose that was asked about, or NULL
IST_LOOP_API bool answered(Call& call, QueryStatus status, const double* pose = nullptr);

/// Implements every ..._get_info by `info_of(object)`.
template <typename T, SizedStruct Info, typename Body>
[[nodiscard]] ist_status get_info(const char* function, const typename T::Handle* handle,
                                  Info* info, const Body& info_of) noexcept {
  return guarded(function, [&](Call& call) {
    clear_sized(call, "info", info);
    const Held<T> held(call, T::kName, handle);
    if (held) write_sized(info_of(*held), *info);
  });
}

/// Makes an object by `make()`, beside the caller's progress, and gives it to the caller. Does
/// nothing in a call that failed.
template <typename T, typename Make>
void make_object(Call& call, const ist_progress* progress, typename T::Handle** out,
                 const Make& make) {
  const Follower follower = read_follower(call, progress);
  if (call.status() != IST_OK) return;
  std::unique_ptr<T> made;
  const bool whole = followed(follower, [&](const Proceed&) { made = make(); });
  whole ? give(call, std::move(made), out) : cancelled(call);
}

/// Implements every function that makes an object of a file, by `read(path)`.
template <typename T, typename Read>
[[nodiscard]] ist_status read_object(const char* function, const char* path,
                                     const ist_progress* progress, typename T::Handle** out,
                                     const Read& read) noexcept {
  return guarded(function, [&](Call& call) {
    call.clear(T::kName, out);
    call.need("path", path);
    make_object<T>(call, progress, out, [&] { return std::make_unique<T>(read(path)); });
  });
}

}  // namespace ist::capi
