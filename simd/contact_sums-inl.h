// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_CONTACT_SUMS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_CONTACT_SUMS_INL_H
#undef IST_SIMD_CONTACT_SUMS_INL_H
#else
#define IST_SIMD_CONTACT_SUMS_INL_H
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "ist/base/platform/bit_cast.h"
#include "simd/bounds-inl.h"
#include "simd/contact_lanes.h"

// Vector twins of the scalar forms in simd/contact_lanes.h.
HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct Vector {
  hn::Vec<Full> x, y, z;
};
HWY_INLINE hn::Vec<Full> Dot(const Vector& a, const Vector& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Vector Difference(const Vector& a, const Vector& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vector Scaled(const Vector& a, hn::Vec<Full> by) {
  return {hn::Mul(a.x, by), hn::Mul(a.y, by), hn::Mul(a.z, by)};
}

HWY_INLINE Vector Cross(const Vector& a, const Vector& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

// Vector twin of ist::unpack_normal.
HWY_INLINE Vector UnpackNormals(const std::uint32_t* HWY_RESTRICT words) {
  const Full d;
  const hn::RebindToSigned<Full> di;
  const hn::RebindToUnsigned<Full> du;
  const auto word = hn::Load(du, words);
  const auto half = hn::Set(d, 2047.0F);
  const auto to_float = [&](hn::Vec<decltype(du)> v) {
    return hn::ConvertTo(d, hn::BitCast(di, v));
  };
  const auto u = hn::Sub(to_float(hn::ShiftRight<20>(word)), half);
  const auto v = hn::Sub(to_float(hn::And(hn::ShiftRight<8>(word), hn::Set(du, 4095U))), half);
  const auto left_u = hn::Sub(half, hn::Abs(u)), left_v = hn::Sub(half, hn::Abs(v));
  const auto z = hn::Sub(left_u, hn::Abs(v));
  const auto folded = hn::Lt(z, hn::Zero(d));
  const Vector n{hn::IfThenElse(folded, hn::CopySign(left_v, u), u),
                 hn::IfThenElse(folded, hn::CopySign(left_u, v), v), z};
  const auto coherence =
      hn::Mul(to_float(hn::And(word, hn::Set(du, 255U))), hn::Set(d, 1.0F / 255));
  return Scaled(n, hn::Div(coherence, hn::Sqrt(Dot(n, n))));
}

// Vector twin of ist::turned.
HWY_INLINE Vector Turned(const SearchPose& pose, const Vector& v) {
  const auto row = [&](int i) {
    const Full d;
    const float* r = pose.rotation + 3 * i;
    return Dot({hn::Set(d, r[0]), hn::Set(d, r[1]), hn::Set(d, r[2])}, v);
  };
  return {row(0), row(1), row(2)};
}

// Adds up terms, a vector at a time: twin of ist::to_fixed_point. A term becomes a whole number in
// the last bits of a sum with kToWhole; what is added up with it is taken off at the start.
class FixedPointSums {
 public:
  // For the terms of so many vectors.
  HWY_INLINE explicit FixedPointSums(std::size_t vectors) {
    const auto added = bit_cast<std::uint32_t>(kToWhole) * static_cast<std::uint32_t>(vectors);
    for (auto& sum : sums_) sum = hn::Set(hn::RebindToUnsigned<Full>(), 0U - added);
  }
  HWY_INLINE void Add(std::size_t place, hn::Vec<Full> term) {
    const hn::RebindToUnsigned<Full> du;
    sums_[place] = hn::Add(sums_[place], hn::BitCast(du, hn::Add(term, hn::Set(Full(), kToWhole))));
  }
  HWY_INLINE void Add(std::size_t place, const Vector& terms) {
    Add(place, terms.x);
    Add(place + 1, terms.y);
    Add(place + 2, terms.z);
  }
  // Adds the sums to `totals`. No sum of some lanes exceeds what 32 bits hold, either.
  HWY_INLINE void AddTo(std::int64_t* totals) const {
    const hn::RebindToSigned<Full> di;
    for (std::size_t i = 0; i < kContactSums; ++i) {
      totals[i] += hn::GetLane(hn::SumOfLanes(di, hn::BitCast(di, sums_[i])));
    }
  }

 private:
  hn::Vec<hn::RebindToUnsigned<Full>> sums_[kContactSums];
};

// The unpacked normals of a batch, side by side.
struct NormalLanes {
  static constexpr std::size_t kSize = kContactBatch + 16;
  alignas(64) float x[kSize], y[kSize], z[kSize];

  HWY_INLINE void Store(std::size_t i, const Vector& v) {
    const Full d;
    hn::Store(v.x, d, x + i);
    hn::Store(v.y, d, y + i);
    hn::Store(v.z, d, z + i);
  }
  [[nodiscard]] HWY_INLINE Vector Load(std::size_t i) const {
    const Full d;
    return {hn::Load(d, x + i), hn::Load(d, y + i), hn::Load(d, z + i)};
  }
};

// Vector twin of ist::PairTerms; `counts` marks the pairs with a weight.
struct VectorTerms {
  hn::Vec<Full> weight, depth;
  Vector position, force;
  hn::Mask<Full> counts;
};

// Vector twin of ist::pair_terms, for the lanes `here`.
HWY_INLINE VectorTerms FindTerms(const ContactRule& rule, hn::Vec<Full> share, const Vector& f,
                                 const Vector& m, const Vector& a, const Vector& b,
                                 hn::Mask<Full> here) {
  const Full d;
  const auto set = [&](float x) { return hn::Set(d, x); };
  const auto zero = hn::Zero(d), one = set(1);
  const Vector e = Difference(a, b);
  const auto length = hn::Sqrt(Dot(e, e));
  const Vector n = Scaled(e, hn::Div(one, hn::Max(length, set(kShortestMean))));
  const auto along = Dot(n, Difference(f, m));
  VectorTerms terms;
  terms.depth = hn::Min(hn::Max(hn::Sub(along, set(rule.least)), zero), set(rule.range));
  const auto fade =
      hn::Min(hn::Add(set(rule.fade_from), hn::Mul(terms.depth, set(rule.per_fade))), one);
  const auto found = hn::Mul(hn::Mul(share, hn::Mul(length, set(0.5F * kContactUnit))), fade);
  terms.counts = hn::And(hn::Gt(found, zero), here);
  terms.weight = hn::IfThenElseZero(terms.counts, hn::Min(found, set(kContactUnit)));
  const auto part = [&](hn::Vec<Full> x, hn::Vec<Full> y) {
    return hn::Min(hn::Max(hn::Mul(hn::Add(x, y), set(rule.half_per_lever)), set(-1)), one);
  };
  const auto of_weight = [&](hn::Vec<Full> x) {
    return hn::IfThenElseZero(terms.counts, hn::Mul(terms.weight, x));
  };
  terms.position = {part(f.x, m.x), part(f.y, m.y), part(f.z, m.z)};
  terms.force = {of_weight(n.x), of_weight(n.y), of_weight(n.z)};
  return terms;
}

// Finds the terms of a batch of pairs from `first` on. Returns the number of those that have a
// weight.
HWY_INLINE std::size_t FindBatch(const ContactRule& rule, const ContactLanes& lanes,
                                 std::size_t first, const NormalLanes& fixed,
                                 const NormalLanes& moving, ContactTerms& terms) {
  const Full d;
  std::size_t counted = 0;
  for (std::size_t i = 0; i < terms.count; i += hn::Lanes(d)) {
    const auto load = [&](const float* from) { return hn::Load(d, from + first + i); };
    const VectorTerms found = FindTerms(
        rule, load(lanes.share), {load(lanes.fixed_x), load(lanes.fixed_y), load(lanes.fixed_z)},
        {load(lanes.moving_x), load(lanes.moving_y), load(lanes.moving_z)}, fixed.Load(i),
        moving.Load(i), hn::FirstN(d, terms.count - i));
    hn::Store(found.weight, d, terms.weight + i);
    hn::Store(found.depth, d, terms.depth + i);
    hn::Store(found.position.x, d, terms.x + i);
    hn::Store(found.position.y, d, terms.y + i);
    hn::Store(found.position.z, d, terms.z + i);
    hn::Store(found.force.x, d, terms.force_x + i);
    hn::Store(found.force.y, d, terms.force_y + i);
    hn::Store(found.force.z, d, terms.force_z + i);
    counted += hn::CountTrue(d, found.counts);
  }
  return counted;
}

// Vector twin of ist::add_pair, for a batch.
HWY_INLINE void AddTerms(const ContactRule& rule, const ContactTerms& terms,
                         std::int64_t* HWY_RESTRICT totals) {
  const Full d;
  FixedPointSums sums((terms.count + hn::Lanes(d) - 1) / hn::Lanes(d));
  for (std::size_t i = 0; i < terms.count; i += hn::Lanes(d)) {
    const auto load = [&](const float* from) { return hn::Load(d, from + i); };
    const Vector p{load(terms.x), load(terms.y), load(terms.z)};
    const Vector force{load(terms.force_x), load(terms.force_y), load(terms.force_z)};
    const Vector torque = Cross(p, force);
    const auto stretch = hn::Mul(load(terms.depth), hn::Set(d, rule.per_range));
    sums.Add(kWeightSum, load(terms.weight));
    sums.Add(kForceSum, force);
    sums.Add(kTorqueSum, torque);
    sums.Add(kSpringSum, Scaled(force, stretch));
    sums.Add(kSpringTorqueSum, Scaled(torque, stretch));
  }
  sums.AddTo(totals);
}

// Vector twin of ist::add_contacts_scalar. Each stage is a loop of its own, so that the long chains
// of operations of several vectors are under way at once.
inline void AddContacts(const SearchStep& step, const SearchPose& pose, ContactAdder& out) {
  const Full d;
  alignas(64) std::uint32_t words[NormalLanes::kSize];
  NormalLanes fixed, moving;
  ContactLanes& lanes = out.lanes;
  ContactTerms& terms = out.terms;
  for (std::size_t first = 0; first < lanes.count; first += kContactBatch) {
    const std::size_t count = HWY_MIN(kContactBatch, lanes.count - first);
    const std::uint32_t* const ids = lanes.moving + first;
    if (step.moving.descends) {
      for (std::size_t i = 0; i < count; ++i) words[i] = step.moving_normals[ids[i]].word();
    } else {
      for (std::size_t i = 0; i < count; ++i) {
        words[i] = step.moving_normals[leaf_of(step.moving, ids[i])].word();
      }
    }
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      fixed.Store(i, Turned(pose, UnpackNormals(lanes.fixed_normal + first + i)));
      moving.Store(i, UnpackNormals(words + i));
    }
    terms.count = count;
    terms.fixed = lanes.fixed + first;
    out.totals.counted += FindBatch(out.rule, lanes, first, fixed, moving, terms);
    AddTerms(out.rule, terms, out.totals.sum);
    if (out.stream != nullptr) out.stream->take(terms);
  }
  out.totals.pairs += lanes.count;
  lanes.count = 0;
}

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
