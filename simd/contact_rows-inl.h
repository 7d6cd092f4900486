// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_CONTACT_ROWS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_CONTACT_ROWS_INL_H
#undef IST_SIMD_CONTACT_ROWS_INL_H
#else
#define IST_SIMD_CONTACT_ROWS_INL_H
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "simd/contact_lanes.h"
#include "simd/contact_sums-inl.h"
#include "simd/measure-inl.h"
#include "simd/select-inl.h"

// Vector twins of the scalar forms in simd/contact_lanes.h.
HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Vector twin of ist::middle_of.
template <class D>
HWY_INLINE hn::Vec<D> MiddleOf(D d, hn::Vec<D> nx, hn::Vec<D> ny, hn::Vec<D> nz,
                               hn::Vec<D> offset) {
  const auto squared = hn::Add(hn::Add(hn::Mul(nx, nx), hn::Mul(ny, ny)), hn::Mul(nz, nz));
  return hn::Div(offset, hn::Max(squared, hn::Set(d, 1.0F)));
}

// Vector twin of ist::find_point, for a vector of rows from `k` on.
template <bool kSlabs, class D, class Lanes, class Rows, class Points>
HWY_INLINE void FindPointsAt(D d, const Lanes& fixed, const Rows& rows, std::size_t k,
                             Points& points) {
  auto x = hn::Load(d, rows.x + k), y = hn::Load(d, rows.y + k), z = hn::Load(d, rows.z + k);
  if constexpr (kSlabs) {
    const auto load = [&](Lane lane) { return hn::LoadU(d, fixed.lane[lane] + k); };
    const auto nx = load(kNormalX), ny = load(kNormalY), nz = load(kNormalZ);
    const auto along = hn::Mul(MiddleOf(d, nx, ny, nz, load(kOffset)), hn::Set(d, kSlabScale));
    x = hn::Add(x, hn::Mul(along, hn::Load(d, rows.normal_x + k)));
    y = hn::Add(y, hn::Mul(along, hn::Load(d, rows.normal_y + k)));
    z = hn::Add(z, hn::Mul(along, hn::Load(d, rows.normal_z + k)));
  }
  hn::Store(x, d, points.x + k);
  hn::Store(y, d, points.y + k);
  hn::Store(z, d, points.z + k);
}

// The same for all eight rows of a fixed node.
template <bool kSlabs>
HWY_INLINE void FindPoints(const FixedLanes& fixed, const FixedRows& rows, FixedPoints& points) {
  const Eight d;
  for (std::size_t k = 0; k < 8; k += hn::Lanes(d)) FindPointsAt<kSlabs>(d, fixed, rows, k, points);
}

// Vector twin of ist::moving_point, for a vector of moving lanes.
template <bool kSlabs, class Lanes>
HWY_INLINE Vector MovingPoints(const Lanes& m, std::size_t at) {
  const Full d;
  const auto load = [&](Lane lane) { return hn::Load(d, m.lane[lane] + at); };
  Vector point{load(kX), load(kY), load(kZ)};
  if constexpr (kSlabs) {
    const auto nx = load(kNormalX), ny = load(kNormalY), nz = load(kNormalZ);
    const auto along = MiddleOf(d, nx, ny, nz, load(kOffset));
    point.x = hn::Add(point.x, hn::Mul(along, nx));
    point.y = hn::Add(point.y, hn::Mul(along, ny));
    point.z = hn::Add(point.z, hn::Mul(along, nz));
  }
  return point;
}

// Vector twin of ist::bound_share.
template <bool kSlabs>
HWY_INLINE hn::Vec<Full> BoundShare(const ContactRule& rule, const VectorTest<kSlabs>& t) {
  const Full d;
  const auto one = hn::Set(d, 1.0F);
  const auto left = hn::Sub(hn::Mul(t.radius_sum, t.radius_sum), t.squared);
  const auto balls = hn::Min(hn::Mul(left, hn::Set(d, rule.per_ball)), one);
  if constexpr (!kSlabs) {
    return balls;
  } else {
    const auto fixed = hn::Mul(hn::Sub(t.fixed_sum, t.over_fixed), hn::Set(d, rule.per_slab));
    const auto moving =
        hn::Mul(hn::Sub(t.moving_sum, t.over_moving), hn::Set(d, rule.per_scaled_slab));
    return hn::Mul(balls, hn::Min(hn::Min(fixed, moving), one));
  }
}

// Tests one row like TestRow, and appends the overlapping pairs to `out`; twin of
// ist::append_pair.
template <bool kSlabs, Measured kMeasured>
HWY_INLINE void ContactRow(const ContactRule& rule, const FixedRows& f, const FixedPoints& points,
                           std::size_t row, const MovingLanes& m, std::size_t begin,
                           std::size_t end, ContactLanes& out, Measurer<kSlabs>& measurer) {
  const Full d;
  const hn::RebindToUnsigned<Full> du;
  const RowVectors<kSlabs> fixed(f, row);
  const std::size_t before = out.count;
  std::size_t count = before;
  for (std::size_t i = begin; i < end; i += hn::Lanes(d)) {
    const VectorTest<kSlabs> test(fixed, m, i);
    const auto here = hn::FirstN(d, end - i);
    const auto overlapping = hn::AndNot(test.Separate(), here);
    static_assert(kMeasured != Measured::kBoth);
    if (hn::AllFalse(d, overlapping)) continue;
    if constexpr (kMeasured == Measured::kUpper) measurer.Upper(test, overlapping);
    const Vector point = MovingPoints<kSlabs>(m, i);
    const Selected<Full> selected(d, overlapping);
    selected.Store(d, BoundShare<kSlabs>(rule, test), out.share + count);
    selected.Store(d, point.x, out.moving_x + count);
    selected.Store(d, point.y, out.moving_y + count);
    selected.Store(d, point.z, out.moving_z + count);
    selected.Store(du, hn::Load(du, m.id + i), out.moving + count);
    count += selected.count();
  }
  for (std::size_t i = before; i < count; i += hn::Lanes(d)) {
    hn::StoreU(hn::Set(d, points.x[row]), d, out.fixed_x + i);
    hn::StoreU(hn::Set(d, points.y[row]), d, out.fixed_y + i);
    hn::StoreU(hn::Set(d, points.z[row]), d, out.fixed_z + i);
    hn::StoreU(hn::Set(du, points.first + static_cast<std::uint32_t>(row)), du, out.fixed + i);
    hn::StoreU(hn::Set(du, points.normals[row].word()), du, out.fixed_normal + i);
  }
  out.count = count;
}

// The overlapping pairs are added up.
template <bool kSlabs, Measured kMeasured>
class ContactRows {
 public:
  ContactRows(const SearchStep& step, const SearchPose& pose, ContactAdder& out)
      : step_(step), pose_(pose), out_(out) {}

  [[nodiscard]] static bool HasRoom(std::size_t, std::size_t) { return true; }
  void Decoded(std::uint32_t node, FixedGroup& fixed) {
    FindPoints<kSlabs>(fixed.lanes, fixed.rows, fixed.points);
    name_surfaces(step_, node, fixed.points);
  }
  [[nodiscard]] static std::size_t Begin() { return 0; }
  [[nodiscard]] static std::size_t Continue(std::uint32_t) { return 0; }
  HWY_INLINE void Test(const FixedGroup& fixed, std::size_t row, const MovingLanes& moving,
                       std::size_t begin, std::size_t end, Measurer<kSlabs>& measurer) {
    ContactRow<kSlabs, kMeasured>(out_.rule, fixed.rows, fixed.points, row, moving, begin, end,
                                  out_.lanes, measurer);
    if (out_.lanes.count >= kContactBatch) AddContacts(step_, pose_, out_);
  }
  static void End(std::uint32_t, std::size_t) {}

 private:
  const SearchStep& step_;
  const SearchPose& pose_;
  ContactAdder& out_;
};

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
