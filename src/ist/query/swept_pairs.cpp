#include "ist/query/swept_pairs.h"

#include <limits>
#include <optional>

#include "ist/base/access.h"
#include "ist/base/float_environment.h"
#include "ist/query/query_state.h"

namespace ist {

SweptPairsResult swept_pairs(Query& query, const ScrewPart& part, std::size_t most,
                             const Budget& until, SweptList& out) {
  const ScopedFloatEnvironment environment;
  detail::QueryState& s = detail::Access::state(query);
  out.pairs.clear();
  out.codes.clear();
  out.groups.clear();
  out.reserve(most);
  const detail::Use use(s);
  if (!use) return {.status = QueryStatus::kBusy, .complete = false};
  const Eigen::Isometry3d middle = to_isometry(part.middle);
  const double way = part.speed * part.half + 2 * part.pad;
  const std::optional<detail::Approach> bodies = s.approach(middle, way + s.triangle_error(middle));
  if (!bodies) return {.status = QueryStatus::kInvalidPose, .complete = false};
  if (!bodies->roots.overlap) return {};
  if (s.triangles->is_too_far(bodies->relative)) return {.fits = false};
  const Budget in_time{std::numeric_limits<std::uint64_t>::max(), until.deadline};
  const TriangleSearch::Swept end = s.triangles->swept(bodies->relative, part, in_time, most, out);
  return {.complete = end.complete, .fits = end.fits};
}

}  // namespace ist
