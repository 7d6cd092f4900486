#include "simd/pair_cache_step.h"

namespace ist {

void turn_cache_scalar(const CacheLanes& cache, const SearchStep& step, const SearchPose& pose,
                       bool surfaces, CacheRows& rows) {
  const bool slabs = step.fixed.slabs != nullptr;
  for (std::size_t at = 0; at < cache.row_count; ++at) {
    turn(pose, pads_of(pose, step), slabs, cache.fixed, at, rows);
    if (!surfaces) continue;
    find_point(slabs, cache.fixed, rows, at, rows.surface);
    const FloatVector n = turned(
        pose, {cache.fixed.normal_x[at], cache.fixed.normal_y[at], cache.fixed.normal_z[at]});
    rows.surface.normal_x[at] = n.x;
    rows.surface.normal_y[at] = n.y;
    rows.surface.normal_z[at] = n.z;
  }
}

std::size_t select_cache_scalar(const CacheLanes& cache, const SearchStep& step,
                                const CacheRows& rows, std::size_t begin, std::size_t end,
                                std::uint32_t* out) {
  const bool slabs = step.fixed.slabs != nullptr;
  std::size_t count = 0;
  for (std::size_t at = begin; at < end; ++at) {
    const PairTest test(rows, cache.moving.row[at], cache.moving, at, slabs);
    if (test.overlap()) out[count++] = static_cast<std::uint32_t>(at);
  }
  return count;
}

void add_cache_scalar(const CacheLanes& cache, const SearchStep& step, const CacheRows& rows,
                      std::size_t begin, std::size_t end, ContactAdder& out) {
  const bool slabs = step.fixed.slabs != nullptr;
  const CacheRows::Surface& on = rows.surface;
  begin_terms(out);
  for (std::size_t at = begin; at < end; ++at) {
    const std::size_t row = cache.moving.row[at];
    const PairTest test(rows, row, cache.moving, at, slabs);
    if (!test.overlap()) continue;
    ++out.totals.pairs;
    const CacheLanes::Moving& m = cache.moving;
    const PairTerms pair = pair_terms(
        out.rule, bound_share(out.rule, test, slabs), {on.x[row], on.y[row], on.z[row]},
        {m.x[at], m.y[at], m.z[at]}, {on.normal_x[row], on.normal_y[row], on.normal_z[row]},
        {m.normal_x[at], m.normal_y[at], m.normal_z[at]});
    if (!(pair.weight > 0)) continue;
    add_pair(out.rule, pair, out.totals);
    store_terms(pair, out.terms, out.terms.count);
    out.lanes.fixed[out.terms.count++] = cache.fixed.address[row];
    if (out.terms.count == kContactBatch) hand_over_terms(out);
  }
  hand_over_terms(out);
}

}  // namespace ist
