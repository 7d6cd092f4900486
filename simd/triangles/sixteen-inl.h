// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_EXACT_SIXTEEN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_EXACT_SIXTEEN_INL_H
#undef IST_SIMD_EXACT_SIXTEEN_INL_H
#else
#define IST_SIMD_EXACT_SIXTEEN_INL_H
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, 16>;
using IndexTag = hn::RebindToUnsigned<FloatTag>;
using FloatVec = hn::Vec<FloatTag>;
using IndexVec = hn::Vec<IndexTag>;
inline constexpr std::size_t kLanes = hn::MaxLanes(FloatTag());
inline constexpr std::size_t kParts = 16 / kLanes;
// Items in a list between the one that is read and the one that begins to be loaded.
inline constexpr std::size_t kItemsAhead = 4;

// Sixteen floats, in as many vectors as they take.
struct Sixteen {
  FloatVec part[kParts];
};

template <class F>
HWY_INLINE Sixteen Each(F f) {
  Sixteen result;
  for (std::size_t k = 0; k < kParts; ++k) result.part[k] = f(k);
  return result;
}
HWY_INLINE Sixteen Load16(const float* HWY_RESTRICT from) {
  return Each([&](std::size_t k) { return hn::Load(FloatTag(), from + k * kLanes); });
}
HWY_INLINE void Store16(const Sixteen& v, float* HWY_RESTRICT to) {
  for (std::size_t k = 0; k < kParts; ++k) hn::Store(v.part[k], FloatTag(), to + k * kLanes);
}
HWY_INLINE Sixteen Set16(float value) {
  return Each([&](std::size_t) { return hn::Set(FloatTag(), value); });
}
HWY_INLINE Sixteen operator+(const Sixteen& a, const Sixteen& b) {
  return Each([&](std::size_t k) { return hn::Add(a.part[k], b.part[k]); });
}
HWY_INLINE Sixteen operator-(const Sixteen& a, const Sixteen& b) {
  return Each([&](std::size_t k) { return hn::Sub(a.part[k], b.part[k]); });
}
HWY_INLINE Sixteen operator*(const Sixteen& a, const Sixteen& b) {
  return Each([&](std::size_t k) { return hn::Mul(a.part[k], b.part[k]); });
}
// a · b + c, rounded once where the processor can.
HWY_INLINE Sixteen MulAdd(const Sixteen& a, const Sixteen& b, const Sixteen& c) {
  return Each([&](std::size_t k) { return hn::MulAdd(a.part[k], b.part[k], c.part[k]); });
}
HWY_INLINE Sixteen Abs(const Sixteen& a) {
  return Each([&](std::size_t k) { return hn::Abs(a.part[k]); });
}
HWY_INLINE Sixteen Min(const Sixteen& a, const Sixteen& b) {
  return Each([&](std::size_t k) { return hn::Min(a.part[k], b.part[k]); });
}
HWY_INLINE Sixteen Max(const Sixteen& a, const Sixteen& b) {
  return Each([&](std::size_t k) { return hn::Max(a.part[k], b.part[k]); });
}

HWY_INLINE Sixteen Sqrt(const Sixteen& a) {
  return Each([&](std::size_t k) { return hn::Sqrt(a.part[k]); });
}

// The least and the greatest of the lanes, in all lanes.
HWY_INLINE Sixteen Least(const Sixteen& a) {
  FloatVec least = a.part[0];
  for (std::size_t k = 1; k < kParts; ++k) least = hn::Min(least, a.part[k]);
  least = hn::MinOfLanes(FloatTag(), least);
  return Each([&](std::size_t) { return least; });
}
HWY_INLINE Sixteen Greatest(const Sixteen& a) {
  FloatVec greatest = a.part[0];
  for (std::size_t k = 1; k < kParts; ++k) greatest = hn::Max(greatest, a.part[k]);
  greatest = hn::MaxOfLanes(FloatTag(), greatest);
  return Each([&](std::size_t) { return greatest; });
}

// Which of sixteen lanes are meant, lane 0 in the lowest bit.
using Lanes16 = std::uint32_t;
inline constexpr Lanes16 kAllLanes = 0xFFFF;

HWY_INLINE Lanes16 FirstLanes(std::uint32_t count) { return (Lanes16{1} << count) - 1; }

HWY_INLINE Lanes16 BitsOf(hn::Mask<FloatTag> mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(FloatTag(), mask, bits);
  if constexpr (kLanes == 16) return bits[0] | Lanes16{bits[1]} << 8;
  return bits[0];
}
// A truth for each of sixteen lanes.
struct Truth16 {
  hn::Mask<FloatTag> part[kParts];
};
HWY_INLINE Truth16 None16() {
  Truth16 none;
  for (auto& part : none.part) part = hn::FirstN(FloatTag(), 0);
  return none;
}
HWY_INLINE Truth16 operator>(const Sixteen& a, const Sixteen& b) {
  Truth16 greater;
  for (std::size_t k = 0; k < kParts; ++k) greater.part[k] = hn::Gt(a.part[k], b.part[k]);
  return greater;
}
HWY_INLINE Truth16 operator|(const Truth16& a, const Truth16& b) {
  Truth16 either;
  for (std::size_t k = 0; k < kParts; ++k) either.part[k] = hn::Or(a.part[k], b.part[k]);
  return either;
}
HWY_INLINE Lanes16 BitsOf(const Truth16& truth) {
  Lanes16 bits = 0;
  for (std::size_t k = 0; k < kParts; ++k) bits |= BitsOf(truth.part[k]) << (k * kLanes);
  return bits;
}

// Makes one vector of any lanes of sixteen floats: a vector of sixteen is permuted; of two vectors
// of eight, or four of four, each is permuted by the lane's low bits, and the high bits choose.
class Pick {
 public:
  // `lanes` holds numbers below 16.
  explicit HWY_INLINE Pick(IndexVec lanes) : lanes_(lanes) {}

  HWY_INLINE FloatVec operator()(const Sixteen& from) const {
    const IndexTag du;
    const auto low = hn::IndicesFromVec(
        FloatTag(), hn::And(lanes_, hn::Set(du, static_cast<std::uint32_t>(kLanes - 1))));
    FloatVec picked = hn::TableLookupLanes(from.part[0], low);
    for (std::size_t k = 1; k < kParts; ++k) {
      const auto here = hn::Gt(lanes_, hn::Set(du, static_cast<std::uint32_t>(k * kLanes - 1)));
      picked = hn::IfThenElse(hn::RebindMask(FloatTag(), here),
                              hn::TableLookupLanes(from.part[k], low), picked);
    }
    return picked;
  }

  // The same of sixteen whole numbers.
  HWY_INLINE IndexVec operator()(const std::uint32_t* HWY_RESTRICT from) const {
    const IndexTag du;
    return hn::BitCast(du, (*this)(Each([&](std::size_t k) {
                         return hn::BitCast(FloatTag(), hn::Load(du, from + k * kLanes));
                       })));
  }

 private:
  IndexVec lanes_;
};

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
