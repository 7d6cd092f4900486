#include <algorithm>

#include "simd/contact_lanes.h"
#include "simd/dispatch.h"
#include "simd/lanes.h"
#include "simd/pair_cache_step.h"
#include "simd/step.h"

namespace ist {
namespace {

// Decodes moving nodes [begin, end) of a frontier. Returns the number of lanes.
std::size_t decode_piece(const SearchSide& side, const Frontier& in, std::uint32_t begin,
                         std::uint32_t end, MovingLanes& lanes) {
  std::size_t count = 0;
  for (std::uint32_t i = begin; i < end; ++i) count += decode(side, in.moving[i], lanes, count);
  return count;
}

// Returns the tests that a group makes.
std::uint64_t group_tests(const SearchStep& step, const Frontier& in, const SearchGroup& group,
                          std::uint32_t begin) {
  std::uint64_t lanes = 0;
  for (std::uint32_t i = begin; i < group.end; ++i) lanes += opened(step.moving, in.moving[i]);
  return opened(step.fixed, group.fixed) * lanes;
}

// The overlapping pairs are the next frontier.
struct PairRows {
  Frontier& out;
  std::size_t before = 0;

  [[nodiscard]] bool has_room(std::size_t nodes) const { return ist::has_room(out, 1, nodes); }
  void decoded(std::uint32_t, FixedGroup&) {}
  void begin(std::uint32_t fixed, bool continues) {
    before = continues ? begin_row(out, fixed) : out.moving_count;
  }
  void take(const PairTest&, std::size_t, const MovingLanes& lanes, std::size_t at) {
    out.moving[out.moving_count++] = lanes.id[at];
  }
  void end(std::uint32_t fixed) { end_row(out, fixed, before); }
};

// The overlapping pairs are added up.
struct ContactRows {
  const SearchStep& step;
  const SearchPose& pose;
  ContactAdder& out;
  const FixedGroup* group = nullptr;
  bool slabs = step.fixed.slabs != nullptr;

  static bool has_room(std::size_t) { return true; }
  void decoded(std::uint32_t node, FixedGroup& fixed) {
    name_surfaces(step, node, fixed.points);
    for (std::size_t row = 0; row < opened(step.fixed, node); ++row) {
      find_point(slabs, fixed.lanes, fixed.rows, row, fixed.points);
    }
    group = &fixed;
  }
  void begin(std::uint32_t, bool) {}
  void take(const PairTest& test, std::size_t row, const MovingLanes& lanes, std::size_t at) {
    append_pair(out.rule, test, group->points, row, lanes, at, slabs, out.lanes);
    if (out.lanes.count == kContactBatch) add_contacts_scalar(step, pose, out);
  }
  void end(std::uint32_t) {}
};

// The overlapping pairs are kept.
struct CacheRowsOut {
  const SearchStep& step;
  CacheLanes& out;
  bool slabs = step.fixed.slabs != nullptr;
  const FixedGroup* group = nullptr;

  [[nodiscard]] bool has_room(std::size_t pairs) const { return ist::has_room(out, 1, pairs); }
  void decoded(std::uint32_t node, FixedGroup& fixed) {
    name_surfaces(step, node, fixed.points);
    group = &fixed;
  }
  void begin(std::uint32_t, bool) {}
  void take(const PairTest&, std::size_t row, const MovingLanes& lanes, std::size_t at) {
    const std::size_t to = out.pair_count++;
    out.moving.row[to] = static_cast<std::uint32_t>(name_row(*group, row, slabs, out));
    for (std::size_t lane = 0; lane < lanes_of(slabs); ++lane) {
      out.moving.lane[lane][to] = lanes.lane[lane][at];
    }
    out.moving.id[to] = lanes.id[at];
    const FloatVector point = moving_point(slabs, lanes, at);
    out.moving.x[to] = point.x;
    out.moving.y[to] = point.y;
    out.moving.z[to] = point.z;
    const FloatVector normal =
        unpack_normal(step.moving_normals[leaf_of(step.moving, lanes.id[at])].word());
    out.moving.normal_x[to] = normal.x;
    out.moving.normal_y[to] = normal.y;
    out.moving.normal_z[to] = normal.z;
  }
  void end(std::uint32_t) {}
};

template <class Rows>
Advanced advance_rows(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                      SearchCursor& cursor, Rows out, SearchScratch& scratch, std::uint64_t most,
                      Measured measured, DistanceBounds& bounds) {
  const bool slabs = step.fixed.slabs != nullptr;
  const Pads& pads = pads_of(pose, step);
  FixedGroup& fixed_group = scratch.fixed[0];
  FixedRows& rows = fixed_group.rows;
  std::uint64_t tests = 0;
  for (; cursor.group < in.group_count; ++cursor.group, cursor.row = 0) {
    const SearchGroup& group = in.groups[cursor.group];
    const std::uint32_t begin = cursor.group == 0 ? 0 : in.groups[cursor.group - 1].end;
    if (tests > 0 && cursor.row == 0 && cursor.moving == 0 &&
        group_tests(step, in, group, begin) > most - tests) {
      break;
    }
    const std::uint32_t row_count = decode(step.fixed, group.fixed, fixed_group.lanes, 0);
    for (std::size_t row = 0; row < row_count; ++row) {
      turn(pose, pads, slabs, fixed_group.lanes, row, rows);
    }
    out.decoded(group.fixed, fixed_group);
    for (; cursor.row < row_count; ++cursor.row, cursor.moving = 0) {
      const std::uint32_t fixed = fixed_group.lanes.id[cursor.row];
      while (begin + cursor.moving < group.end) {
        const std::uint32_t first = begin + cursor.moving;
        if ((step.last || cursor.moving == 0) &&
            !out.has_room(room_of_row(step, group.end - first))) {
          return {tests, true};
        }
        const std::uint32_t end = std::min(first + kPieceNodes, group.end);
        const std::size_t lanes = decode_piece(step.moving, in, first, end, scratch.moving);
        if (lanes > most - tests) return {tests, false};
        out.begin(fixed, cursor.moving != 0);
        for (std::size_t at = 0; at < lanes; ++at) {
          const PairTest test(rows, cursor.row, scratch.moving, at, slabs);
          const bool overlapping = test.overlap();
          if (measured == Measured::kBoth || (measured == Measured::kUpper && overlapping)) {
            test.measure_upper(bounds);
          }
          if (measured == Measured::kBoth && (step.last || !overlapping)) {
            test.measure_lower(slabs, bounds);
          }
          if (overlapping) out.take(test, cursor.row, scratch.moving, at);
        }
        out.end(fixed);
        tests += lanes;
        cursor.moving = end - begin;
      }
    }
  }
  return {tests, false};
}

}  // namespace

Advanced advance_scalar(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                        SearchCursor& cursor, Frontier& out, SearchScratch& scratch,
                        std::uint64_t most, Measured measured, DistanceBounds& bounds) {
  return advance_rows(step, pose, in, cursor, PairRows{out}, scratch, most, measured, bounds);
}

Advanced advance_contacts_scalar(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                                 SearchCursor& cursor, ContactAdder& out, SearchScratch& scratch,
                                 std::uint64_t most, Measured measured, DistanceBounds& bounds) {
  if (measured == Measured::kBoth) measured = Measured::kUpper;
  return advance_rows(step, pose, in, cursor, ContactRows{step, pose, out}, scratch, most, measured,
                      bounds);
}

Advanced advance_cache_scalar(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                              SearchCursor& cursor, CacheLanes& out, SearchScratch& scratch,
                              std::uint64_t most) {
  DistanceBounds none;
  return advance_rows(step, pose, in, cursor, CacheRowsOut{step, out}, scratch, most,
                      Measured::kNothing, none);
}

void write_leaf_pairs_scalar(const Frontier& leaves, LeafPair* out) {
  std::uint32_t i = 0;
  for (std::size_t g = 0; g < leaves.group_count; ++g) {
    for (; i < leaves.groups[g].end; ++i) out[i] = {leaves.groups[g].fixed, leaves.moving[i]};
  }
}

constinit const Kernels kScalarKernels{"scalar",
                                       advance_scalar,
                                       write_leaf_pairs_scalar,
                                       advance_contacts_scalar,
                                       add_contacts_scalar,
                                       advance_cache_scalar,
                                       turn_cache_scalar,
                                       select_cache_scalar,
                                       add_cache_scalar,
                                       {}};

void add_contacts_scalar(const SearchStep& step, const SearchPose& pose, ContactAdder& out) {
  ContactLanes& lanes = out.lanes;
  ContactTerms& terms = out.terms;
  for (std::size_t first = 0; first < lanes.count; first += kContactBatch) {
    terms.count = std::min(kContactBatch, lanes.count - first);
    terms.fixed = lanes.fixed + first;
    for (std::size_t i = 0; i < terms.count; ++i) {
      const std::size_t at = first + i;
      const std::uint32_t leaf = leaf_of(step.moving, lanes.moving[at]);
      const PairTerms pair = pair_terms(
          out.rule, lanes.share[at], {lanes.fixed_x[at], lanes.fixed_y[at], lanes.fixed_z[at]},
          {lanes.moving_x[at], lanes.moving_y[at], lanes.moving_z[at]},
          turned(pose, unpack_normal(lanes.fixed_normal[at])),
          unpack_normal(step.moving_normals[leaf].word()));
      add_pair(out.rule, pair, out.totals);
      store_terms(pair, terms, i);
    }
    if (out.stream != nullptr) out.stream->take(terms);
  }
  out.totals.pairs += lanes.count;
  lanes.count = 0;
}

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
