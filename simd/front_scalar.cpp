#include "simd/front_step.h"

namespace ist {

void turn_front_scalar(const FrontLanes& front, const SearchStep& step, const SearchPose& pose,
                       bool surfaces, FrontRows& rows) {
  const bool slabs = step.fixed.slabs != nullptr;
  for (std::size_t at = 0; at < front.row_count; ++at) {
    turn(pose, pads_of(pose, step), slabs, front.fixed, at, rows);
    if (!surfaces) continue;
    find_point(slabs, front.fixed, rows, at, rows.surface);
    const FloatVector n = turned(
        pose, {front.fixed.normal_x[at], front.fixed.normal_y[at], front.fixed.normal_z[at]});
    rows.surface.normal_x[at] = n.x;
    rows.surface.normal_y[at] = n.y;
    rows.surface.normal_z[at] = n.z;
  }
}

std::size_t select_front_scalar(const FrontLanes& front, const SearchStep& step,
                                const FrontRows& rows, std::size_t begin, std::size_t end,
                                std::uint32_t* out) {
  const bool slabs = step.fixed.slabs != nullptr;
  std::size_t count = 0;
  for (std::size_t at = begin; at < end; ++at) {
    const PairTest test(rows, front.moving.row[at], front.moving, at, slabs);
    if (test.overlap()) out[count++] = static_cast<std::uint32_t>(at);
  }
  return count;
}

void add_front_scalar(const FrontLanes& front, const SearchStep& step, const FrontRows& rows,
                      std::size_t begin, std::size_t end, ContactAdder& out) {
  const bool slabs = step.fixed.slabs != nullptr;
  const FrontRows::Surface& on = rows.surface;
  begin_terms(out);
  for (std::size_t at = begin; at < end; ++at) {
    const std::size_t row = front.moving.row[at];
    const PairTest test(rows, row, front.moving, at, slabs);
    if (!test.overlap()) continue;
    ++out.totals.pairs;
    const FrontLanes::Moving& m = front.moving;
    const PairTerms pair = pair_terms(
        out.rule, bound_share(out.rule, test, slabs), {on.x[row], on.y[row], on.z[row]},
        {m.x[at], m.y[at], m.z[at]}, {on.normal_x[row], on.normal_y[row], on.normal_z[row]},
        {m.normal_x[at], m.normal_y[at], m.normal_z[at]});
    if (!(pair.weight > 0)) continue;
    add_pair(out.rule, pair, out.totals);
    store_terms(pair, out.terms, out.terms.count);
    out.lanes.fixed[out.terms.count++] = front.fixed.address[row];
    if (out.terms.count == kContactBatch) hand_over_terms(out);
  }
  hand_over_terms(out);
}

}  // namespace ist
