// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_FRONT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_FRONT_INL_H
#undef IST_SIMD_FRONT_INL_H
#else
#define IST_SIMD_FRONT_INL_H
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "simd/contact_rows-inl.h"
#include "simd/contact_sums-inl.h"
#include "simd/pair_cache_step.h"
#include "simd/select-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The overlapping pairs of a step are appended to a cache.
template <bool kSlabs>
class CachePairs {
 public:
  CachePairs(const SearchStep& step, CacheLanes& out) : step_(step), out_(out) {}

  [[nodiscard]] bool HasRoom(std::size_t rows, std::size_t pairs) const {
    return has_room(out_, rows, pairs);
  }
  void Decoded(std::uint32_t node, FixedGroup& fixed) { name_surfaces(step_, node, fixed.points); }
  [[nodiscard]] static std::size_t Begin() { return 0; }
  [[nodiscard]] static std::size_t Continue(std::uint32_t) { return 0; }
  HWY_INLINE void Test(const FixedGroup& fixed, std::size_t row, const MovingLanes& m,
                       std::size_t begin, std::size_t end, Measurer<kSlabs>&) {
    const Full d;
    const hn::RebindToUnsigned<Full> du;
    const RowVectors<kSlabs> numbers(fixed.rows, row);
    const CacheLanes::Moving& to = out_.moving;
    const std::size_t before = out_.pair_count;
    std::size_t count = before;
    for (std::size_t i = begin; i < end; i += hn::Lanes(d)) {
      const VectorTest<kSlabs> test(numbers, m, i);
      const auto overlapping = hn::AndNot(test.Separate(), hn::FirstN(d, end - i));
      if (hn::AllFalse(d, overlapping)) continue;
      const Selected<Full> selected(d, overlapping);
      for (std::size_t lane = 0; lane < lanes_of(kSlabs); ++lane) {
        selected.Store(d, hn::Load(d, m.lane[lane] + i), to.lane[lane] + count);
      }
      const Vector point = MovingPoints<kSlabs>(m, i);
      selected.Store(d, point.x, to.x + count);
      selected.Store(d, point.y, to.y + count);
      selected.Store(d, point.z, to.z + count);
      selected.Store(du, hn::Load(du, m.id + i), to.id + count);
      count += selected.count();
    }
    if (count == before) return;
    const auto name = static_cast<std::uint32_t>(name_row(fixed, row, kSlabs, out_));
    for (std::size_t i = before; i < count; i += hn::Lanes(d)) {
      hn::StoreU(hn::Set(du, name), du, to.row + i);
    }
    out_.pair_count = count;
  }
  static void End(std::uint32_t, std::size_t) {}

 private:
  const SearchStep& step_;
  CacheLanes& out_;
};

// Unpacks the moving normals of a cache's pairs from `first` on.
HWY_INLINE void UnpackMovingNormals(const SearchStep& step, std::size_t first, CacheLanes& cache) {
  const Full d;
  const CacheLanes::Moving& of = cache.moving;
  alignas(64) std::uint32_t words[16] = {};
  for (std::size_t i = first; i < cache.pair_count; i += hn::Lanes(d)) {
    const std::size_t count = HWY_MIN(hn::Lanes(d), cache.pair_count - i);
    for (std::size_t k = 0; k < count; ++k) {
      words[k] = step.moving_normals[leaf_of(step.moving, of.id[i + k])].word();
    }
    const Vector n = UnpackNormals(words);
    hn::StoreU(n.x, d, of.normal_x + i);
    hn::StoreU(n.y, d, of.normal_y + i);
    hn::StoreU(n.z, d, of.normal_z + i);
  }
}

// Vector twin of ist::turn_cache_scalar.
template <bool kSlabs>
HWY_INLINE void TurnRows(const CacheLanes& cache, const SearchStep& step, const SearchPose& pose,
                         bool surfaces, CacheRows& rows) {
  const Full d;
  CacheRows::Surface& on = rows.surface;
  for (std::size_t k = 0; k < cache.row_count; k += hn::Lanes(d)) {
    TurnAt<kSlabs>(d, pose, pads_of(pose, step), cache.fixed, k, rows);
    if (!surfaces) continue;
    FindPointsAt<kSlabs>(d, cache.fixed, rows, k, on);
    const auto load = [&](const float* of) { return hn::Load(d, of + k); };
    const Vector n = Turned(
        pose, {load(cache.fixed.normal_x), load(cache.fixed.normal_y), load(cache.fixed.normal_z)});
    hn::Store(n.x, d, on.normal_x + k);
    hn::Store(n.y, d, on.normal_y + k);
    hn::Store(n.z, d, on.normal_z + k);
  }
}

// Makes vectors of the rows of a vector of pairs: these are in order, and rows have no gaps, so
// that all lie in the vector that begins with the first one.
class SpreadRows {
 public:
  HWY_INLINE SpreadRows(const std::uint32_t* HWY_RESTRICT row, std::size_t at)
      : first_(row[at]), from_(hn::IndicesFromVec(Full(), Offsets(row + at))) {}

  HWY_INLINE hn::Vec<Full> operator()(const float* HWY_RESTRICT of) const {
    return hn::TableLookupLanes(hn::LoadU(Full(), of + first_), from_);
  }
  HWY_INLINE hn::Vec<hn::RebindToUnsigned<Full>> operator()(
      const std::uint32_t* HWY_RESTRICT of) const {
    const hn::RebindToUnsigned<Full> du;
    return hn::BitCast(
        du, hn::TableLookupLanes(hn::BitCast(Full(), hn::LoadU(du, of + first_)), from_));
  }

 private:
  // Behind the last pair lies any number.
  HWY_INLINE static hn::Vec<hn::RebindToSigned<Full>> Offsets(
      const std::uint32_t* HWY_RESTRICT row) {
    const hn::RebindToUnsigned<Full> du;
    const hn::RebindToSigned<Full> di;
    const auto last = hn::Set(du, static_cast<std::uint32_t>(hn::Lanes(du)) - 1);
    return hn::BitCast(di, hn::And(hn::Sub(hn::Load(du, row), hn::Set(du, row[0])), last));
  }

  std::uint32_t first_;
  decltype(hn::IndicesFromVec(Full(), hn::Zero(hn::RebindToSigned<Full>()))) from_;
};

// Vector twin of ist::select_cache_scalar.
template <bool kSlabs>
HWY_INLINE std::size_t SelectPairs(const CacheLanes& cache, const CacheRows& rows,
                                   std::size_t begin, std::size_t end,
                                   std::uint32_t* HWY_RESTRICT out) {
  const Full d;
  const hn::RebindToUnsigned<Full> du;
  std::size_t count = 0;
  for (std::size_t i = begin; i < end; i += hn::Lanes(d)) {
    const SpreadRows spread(cache.moving.row, i);
    const VectorTest<kSlabs> test(RowVectors<kSlabs>(rows, spread), cache.moving, i);
    const auto overlapping = hn::AndNot(test.Separate(), hn::FirstN(d, end - i));
    const auto places =
        hn::Add(hn::Set(du, static_cast<std::uint32_t>(i)), hn::Load(du, kLaneNumbers));
    count += StoreSelected(d, overlapping, places, out + count);
  }
  return count;
}

// Vector twin of ist::add_cache_scalar.
template <bool kSlabs>
HWY_INLINE void AddPairs(const CacheLanes& cache, const CacheRows& rows, std::size_t begin,
                         std::size_t end, ContactAdder& out) {
  const Full d;
  const hn::RebindToUnsigned<Full> du;
  const ContactRule& rule = out.rule;
  ContactTerms& terms = out.terms;
  const CacheRows::Surface& on = rows.surface;
  const auto finish = [&] {
    // The sums are made of whole vectors.
    for (float* of : {terms.weight, terms.depth, terms.x, terms.y, terms.z, terms.force_x,
                      terms.force_y, terms.force_z}) {
      hn::StoreU(hn::Zero(d), d, of + terms.count);
    }
    if (terms.count > 0) AddTerms(rule, terms, out.totals.sum);
    out.totals.counted += terms.count;
    hand_over_terms(out);
  };
  begin_terms(out);
  for (std::size_t i = begin; i < end; i += hn::Lanes(d)) {
    const SpreadRows spread(cache.moving.row, i);
    const VectorTest<kSlabs> test(RowVectors<kSlabs>(rows, spread), cache.moving, i);
    const auto overlapping = hn::AndNot(test.Separate(), hn::FirstN(d, end - i));
    if (hn::AllFalse(d, overlapping)) continue;
    out.totals.pairs += hn::CountTrue(d, overlapping);
    const CacheLanes::Moving& m = cache.moving;
    const auto load = [&](const float* of) { return hn::Load(d, of + i); };
    const VectorTerms found =
        FindTerms(rule, BoundShare<kSlabs>(rule, test), {spread(on.x), spread(on.y), spread(on.z)},
                  {load(m.x), load(m.y), load(m.z)},
                  {spread(on.normal_x), spread(on.normal_y), spread(on.normal_z)},
                  {load(m.normal_x), load(m.normal_y), load(m.normal_z)}, overlapping);
    if (hn::AllFalse(d, found.counts)) continue;
    const Selected<Full> selected(d, found.counts);
    const std::size_t to = terms.count;
    selected.Store(d, found.weight, terms.weight + to);
    selected.Store(d, found.depth, terms.depth + to);
    selected.Store(d, found.position.x, terms.x + to);
    selected.Store(d, found.position.y, terms.y + to);
    selected.Store(d, found.position.z, terms.z + to);
    selected.Store(d, found.force.x, terms.force_x + to);
    selected.Store(d, found.force.y, terms.force_y + to);
    selected.Store(d, found.force.z, terms.force_z + to);
    selected.Store(du, spread(cache.fixed.address), out.lanes.fixed + to);
    terms.count += selected.count();
    if (terms.count + hn::Lanes(d) > kContactBatch) finish();
  }
  finish();
}

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
