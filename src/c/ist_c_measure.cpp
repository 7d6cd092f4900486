#include <algorithm>
#include <limits>
#include <vector>

#include "c/objects.h"
#include "ist/capi/ist_measure.h"
#include "ist/measure/comparison.h"
#include "ist/measure/first_contact.h"
#include "ist/measure/occlusion.h"
#include "ist/measure/penetration.h"
#include "ist/measure/row_numbers.h"
#include "ist/measure/signed_distance.h"

namespace ist::capi {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

ist_surface_distance surface_distance_of(const SurfaceDistance& found) noexcept {
  ist_surface_distance out;
  out.distance = found.distance;
  copy(found.closest, out.closest);
  out.triangle = found.triangle;
  out.is_signed = found.is_signed;
  out.self_intersecting = found.self_intersecting;
  return out;
}

ist_penetration penetration_of(const Penetration& found) {
  ist_penetration out{};
  const bool answered = found.status == Penetration::Status::kDone;
  out.lower = answered ? found.lower : kNoNumber;
  out.upper = answered ? found.upper : kNoNumber;
  copy(found.point, out.point);
  copy(found.direction, out.direction);
  out.of_moving = found.of_moving;
  out.triangle = found.triangle;
  out.complete = found.complete;
  out.not_closed = not_closed_code(found);
  out.narrowest = found.narrowest;
  out.points = found.points;
  out.self_intersecting = self_intersecting_code(found);
  out.capped = found.capped;
  out.rotation_error = found.rotation_error;
  return out;
}

Penetration penetration_of(const ist_penetration& given) {
  Penetration last;
  last.lower = given.lower;
  last.upper = given.upper;
  last.point = Eigen::Vector3d(given.point[0], given.point[1], given.point[2]);
  last.of_moving = given.of_moving != 0;
  last.triangle = given.triangle;
  return last;
}

ist_first_contact first_contact_of(const FirstContact& found) {
  ist_first_contact out{};
  out.lower = found.lower;
  out.upper = found.upper;
  out.distance_lower = found.distance.lower;
  out.distance_upper = found.distance.upper;
  out.outcome = static_cast<std::int32_t>(found.status) + IST_FIRST_CONTACT;
  out.grazed = found.grazed;
  out.passes = found.passes;
  out.triangles_known = found.triangles.has_value();
  if (found.triangles) {
    out.fixed = found.triangles->fixed;
    out.moving = found.triangles->moving;
  }
  out.narrowest = found.narrowest;
  out.distances = found.distances;
  out.self_intersecting = self_intersecting_code(found);
  out.rotation_error = found.rotation_error;
  out.place_known = found.place.has_value();
  if (found.place) {
    copy(found.place->fixed_point, out.place_fixed);
    copy(found.place->moving_point, out.place_moving);
    copy(found.normal, out.normal);
    out.place_triangles[0] = found.place->triangles.fixed;
    out.place_triangles[1] = found.place->triangles.moving;
  }
  return out;
}
static_assert(static_cast<int>(FirstContact::Status::kContact) + IST_FIRST_CONTACT ==
                  IST_FIRST_CONTACT &&
              static_cast<int>(FirstContact::Status::kStopped) + IST_FIRST_CONTACT ==
                  IST_FIRST_STOPPED);

Motion motion_of(const ist_motion& given) {
  const Eigen::Isometry3d from = to_isometry(given.from);
  if (given.to != nullptr) return Motion::between(from, to_isometry(given.to));
  const auto vector = [](const double(&v)[3]) { return Eigen::Vector3d(v[0], v[1], v[2]); };
  return Motion::screw(from, vector(given.point), vector(given.direction), given.angle,
                       given.along);
}

OcclusionOptions read_options(Call& call, const ist_occlusion_options* given) {
  const ist_occlusion_options known = read_sized(call, "options", given);
  call.need_array("options->limits", known.limits, known.limit_count);
  OcclusionOptions options;
  options.limits.clear();
  if (call.status() != IST_OK) return options;
  const auto take = [](double value, double& option) {
    if (value != 0) option = value == -1 ? 0 : value;  // a NaN too, which is refused below
  };
  take(known.reach, options.reach);
  take(known.contact, options.contact);
  take(known.least_area, options.least_area);
  take(known.longest_edge, options.longest_edge);
  take(known.foundation, options.foundation);
  take(known.change, options.change);
  options.limits.assign(known.limits, known.limits + known.limit_count);
  return options;
}

ist_occlusion_arrays read_arrays(Call& call, const char* name, const ist_occlusion_arrays* given) {
  const ist_occlusion_arrays arrays = read_sized(call, name, given);
  call.need_array("arrays->distances", arrays.distances, arrays.distance_capacity);
  call.need_array("arrays->regions", arrays.regions, arrays.region_capacity);
  return arrays;
}

ist_contact_region region_of(const ContactRegion& region) {
  ist_contact_region out{};
  out.area = region.area;
  copy(region.centre, out.centre);
  out.least_distance = region.least_distance;
  copy(region.closest, out.closest);
  out.penetrating_area = region.penetrating_area;
  out.depth_integral = region.depth_integral;
  out.share = region.share;
  out.share_thinner = region.share_thinner;
  out.share_thicker = region.share_thicker;
  out.triangle = region.triangle;
  out.partner = region.partner ? static_cast<std::int32_t>(*region.partner) : -1;
  return out;
}

void give_surface(const SurfaceOcclusion& found, double rotation_error,
                  const ist_occlusion_arrays& arrays, ist_occlusion& out) {
  const auto copy_first = [](const auto& from, auto* to, std::size_t capacity, auto convert) {
    const auto count = static_cast<std::ptrdiff_t>(std::min(capacity, from.size()));
    std::transform(from.begin(), from.begin() + count, to, convert);
  };
  copy_first(found.vertices, arrays.distances, arrays.distance_capacity, surface_distance_of);
  copy_first(found.regions, arrays.regions, arrays.region_capacity, region_of);
  if (arrays.areas != nullptr) std::copy(found.areas.begin(), found.areas.end(), arrays.areas);
  ist_occlusion values{};
  values.vertices = found.vertices.size();
  values.regions = found.regions.size();
  values.total_area = found.total_area;
  values.penetrating_area = found.penetrating_area;
  values.depth_integral = found.depth_integral;
  values.depth_at_vertices = found.depth_at_vertices;
  values.rotation_error = rotation_error;
  write_sized(values, out);
}

ist_pose_change pose_change_of(const PoseChange& found) {
  ist_pose_change out{};
  copy(found.about, out.about);
  copy(found.translation, out.translation);
  copy(found.rotation, out.rotation);
  copy(found.axis, out.axis);
  if (found.axis_point) copy(*found.axis_point, out.axis_point);
  out.angle = found.angle;
  out.along = found.along;
  out.rotation_error = found.rotation_error;
  out.turns = found.axis_point.has_value();
  return out;
}

std::vector<PlacedContact> contacts_of(const ist_placed_contact* given, std::size_t count) {
  std::vector<PlacedContact> contacts(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double(&at)[3] = given[i].centre;
    contacts[i] = {{at[0], at[1], at[2]}, given[i].tooth};
  }
  return contacts;
}

}  // namespace

static_assert(IST_FIXED_SELF_INTERSECTING == 1 && IST_MOVING_SELF_INTERSECTING == 2);
static_assert(IST_CLOSED == 0 && IST_FIXED_NOT_CLOSED == 1 && IST_MOVING_NOT_CLOSED == 2);
static_assert(SurfaceDistance::kNoTriangle == IST_NO_TRIANGLE);

}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_tree_signed_distance(const ist_tree* tree, const double* points, size_t count,
                                    double reach, const ist_progress* progress,
                                    ist_surface_distance* distances) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.need_array("points", points, count);
    call.need_array("distances", distances, count);
    const Follower follower = read_follower(call, progress);
    const Held<Tree> held(call, "tree", tree);
    if (!held) return;
    std::vector<Eigen::Vector3d> at(count);
    for (std::size_t i = 0; i < count; ++i) {
      at[i] = Eigen::Vector3d(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
    }
    std::vector<ist::SurfaceDistance> found;
    const bool whole = followed(follower, [&](const ist::Proceed& proceed) {
      found = ist::signed_distance(held->tree, at, reach, proceed);
    });
    if (!whole) return cancelled(call);
    std::transform(found.begin(), found.end(), distances, surface_distance_of);
  });
}

ist_status ist_tree_distance_map(const ist_tree* body, const ist_tree* other, const double pose[16],
                                 double reach, const ist_progress* progress,
                                 ist_surface_distance* distances, size_t capacity,
                                 uint64_t* vertices) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.clear("vertices", vertices);
    call.need("pose", pose);
    call.need_array("distances", distances, capacity);
    const Follower follower = read_follower(call, progress);
    const Held<Tree> held_body(call, "body", body);
    const Held<Tree> held_other(call, "other", other);
    if (!held_other) return;
    const ist::SphereTree& of = held_body->tree;
    std::vector<ist::SurfaceDistance> found;
    const bool whole = followed(follower, [&](const ist::Proceed& proceed) {
      found = ist::distance_map(of, held_other->tree, to_isometry(pose), reach, proceed);
    });
    if (!whole) return cancelled(call);
    *vertices = found.size();
    const std::size_t count = std::min(capacity, found.size());
    std::transform(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count), distances,
                   surface_distance_of);
  });
}

ist_status ist_query_penetration(ist_query* query, const double pose[16], double tolerance,
                                 const ist_penetration* last, const ist_budget* budget,
                                 const ist_progress* progress,
                                 ist_penetration* result) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    // Read before the result is cleared: it may be the same struct.
    const ist_penetration known = read_sized(call, "last", last);
    clear_sized(call, "result", result);
    call.need("pose", pose);
    ist::PenetrationOptions options;
    options.budget = read_budget(call, budget);
    const Follower follower = read_follower(call, progress);
    const ist::Penetration before = penetration_of(known);
    if (last != nullptr) options.last = &before;
    const Held<QueryObject> held(call, "query", query);
    if (!held) return;
    ist::Penetration found;
    const bool whole = followed(follower, [&](const ist::Proceed& proceed) {
      options.proceed = proceed;
      found = ist::penetration(held->query, to_isometry(pose), tolerance, options);
    });
    if (!whole) return cancelled(call);
    const bool invalid = found.status == ist::Penetration::Status::kInvalidPose;
    if (invalid && !answered(call, ist::QueryStatus::kInvalidPose, pose)) return;
    write_sized(penetration_of(found), *result);
  });
}

ist_status ist_query_first_contact(ist_query* query, const ist_motion* motion, double tolerance,
                                   const ist_budget* budget, const ist_progress* progress,
                                   ist_first_contact* result) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "result", result);
    call.need("motion", motion);
    const ist_motion known = read_sized(call, "motion", motion);
    call.need("motion->from", known.from);
    ist::FirstContactOptions options;
    options.budget = read_budget(call, budget);
    const Follower follower = read_follower(call, progress);
    const Held<QueryObject> held(call, "query", query);
    if (!held) return;
    ist::FirstContact found;
    const bool whole = followed(follower, [&](const ist::Proceed& proceed) {
      options.proceed = proceed;
      found = ist::first_contact(held->query, motion_of(known), tolerance, options);
    });
    if (!whole) return cancelled(call);
    write_sized(first_contact_of(found), *result);
  });
}

ist_status ist_query_occlusion(ist_query* query, const double pose[16],
                               const ist_occlusion_options* options, const ist_progress* progress,
                               const ist_occlusion_arrays* fixed_arrays,
                               const ist_occlusion_arrays* moving_arrays, ist_occlusion* fixed,
                               ist_occlusion* moving) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "fixed", fixed);
    clear_sized(call, "moving", moving);
    call.need("pose", pose);
    ist::OcclusionOptions asked = read_options(call, options);
    const Follower follower = read_follower(call, progress);
    const ist_occlusion_arrays of_fixed = read_arrays(call, "fixed_arrays", fixed_arrays);
    const ist_occlusion_arrays of_moving = read_arrays(call, "moving_arrays", moving_arrays);
    const Held<QueryObject> held(call, "query", query);
    if (!held) return;
    ist::Occlusion found;
    const bool whole = followed(follower, [&](const ist::Proceed& proceed) {
      asked.proceed = proceed;
      found = ist::occlusion(held->query, to_isometry(pose), asked);
    });
    if (!whole) return cancelled(call);
    give_surface(found.fixed, found.rotation_error, of_fixed, *fixed);
    give_surface(found.moving, found.rotation_error, of_moving, *moving);
  });
}

ist_status ist_motion_between(const double before[16], const double after[16],
                              const double about[3], ist_pose_change* result) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "result", result);
    call.need("before", before);
    call.need("after", after);
    call.need("about", about);
    if (call.status() != IST_OK) return;
    write_sized(pose_change_of(ist::pose_change(to_isometry(before), to_isometry(after),
                                                Eigen::Vector3d(about[0], about[1], about[2]))),
                *result);
  });
}

ist_status ist_match_contacts(const ist_placed_contact* before, size_t before_count,
                              const ist_placed_contact* after, size_t after_count, double within,
                              int32_t* matches) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.need_array("before", before, before_count);
    call.need_array("after", after, after_count);
    call.need_array("matches", matches, before_count);
    if (call.status() != IST_OK) return;
    for (const ist::ContactMatch& match : ist::match_contacts(
             contacts_of(before, before_count), contacts_of(after, after_count), within)) {
      if (!match.before) continue;
      matches[*match.before] = match.after ? static_cast<std::int32_t>(*match.after) : -1;
    }
  });
}
