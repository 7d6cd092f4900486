#include <algorithm>

#include "ist/capi/ist_measure.h"
#include "ist/capi/measure/measure_answers.h"
#include "ist/capi/objects.h"
#include "ist/measure/occlusion.h"

namespace ist::capi {
namespace {

ist_status read_options(const Call& call, const ist_occlusion_options* given,
                        OcclusionOptions& options) {
  options.limits.clear();
  if (given == nullptr) return IST_OK;
  ist_occlusion_options known;
  if (const ist_status wrong = read_sized(call, "options", *given, known)) return wrong;
  if (const ist_status wrong =
          call.need_array("options->limits", known.limits, known.limit_count)) {
    return wrong;
  }
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
  return IST_OK;
}

ist_status read_arrays(const Call& call, const char* name, const ist_occlusion_arrays* given,
                       ist_occlusion_arrays& arrays) {
  arrays = {};
  if (given == nullptr) return IST_OK;
  if (const ist_status wrong = read_sized(call, name, *given, arrays)) return wrong;
  if (const ist_status missing =
          call.need_array("arrays->distances", arrays.distances, arrays.distance_capacity)) {
    return missing;
  }
  return call.need_array("arrays->regions", arrays.regions, arrays.region_capacity);
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

}  // namespace
}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_query_occlusion(ist_query* query, const double pose[16],
                               const ist_occlusion_options* options, const ist_progress* progress,
                               const ist_occlusion_arrays* fixed_arrays,
                               const ist_occlusion_arrays* moving_arrays, ist_occlusion* fixed,
                               ist_occlusion* moving) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    const ist_status wrong_fixed = clear_sized(call, "fixed", fixed);
    const ist_status wrong_moving = clear_sized(call, "moving", moving);
    if (wrong_fixed != IST_OK || wrong_moving != IST_OK) {
      return wrong_fixed != IST_OK ? wrong_fixed : wrong_moving;
    }
    if (const ist_status missing = call.need({{"pose", pose}})) return missing;
    ist::OcclusionOptions asked;
    if (const ist_status wrong = read_options(call, options, asked)) return wrong;
    Follower follower;
    if (const ist_status wrong = read_follower(call, progress, follower)) return wrong;
    ist_occlusion_arrays of_fixed, of_moving;
    if (const ist_status wrong = read_arrays(call, "fixed_arrays", fixed_arrays, of_fixed)) {
      return wrong;
    }
    if (const ist_status wrong = read_arrays(call, "moving_arrays", moving_arrays, of_moving)) {
      return wrong;
    }
    const Held<QueryObject> held(call, "query", query);
    if (held.status() != IST_OK) return held.status();
    ist::Occlusion found;
    const bool whole = followed(follower, [&](const ist::Proceed& proceed) {
      asked.proceed = proceed;
      found = ist::occlusion(held->query, to_isometry(pose), asked);
    });
    if (!whole) return cancelled(call);
    give_surface(found.fixed, found.rotation_error, of_fixed, *fixed);
    give_surface(found.moving, found.rotation_error, of_moving, *moving);
    return IST_OK;
  });
}
