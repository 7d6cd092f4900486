// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_PAIR_ROWS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_PAIR_ROWS_INL_H
#undef IST_SIMD_PAIR_ROWS_INL_H
#else
#define IST_SIMD_PAIR_ROWS_INL_H
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "simd/lanes.h"
#include "simd/measure-inl.h"
#include "simd/select-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Tests one row against the moving lanes [begin, end), begin at a multiple of the vector. Writes
// the ids of the overlapping lanes to `out` and returns their number; needs a vector's worth of
// room behind them. `last` says that no overlapping pair is descended.
template <bool kSlabs, Measured kMeasured>
HWY_INLINE std::size_t TestRow(const FixedRows& f, std::size_t row, const MovingLanes& m,
                               std::size_t begin, std::size_t end, bool last,
                               std::uint32_t* HWY_RESTRICT out, Measurer<kSlabs>& measurer) {
  const Full d;
  const hn::RebindToUnsigned<Full> du;
  const RowVectors<kSlabs> fixed(f, row);
  std::size_t count = 0;
  for (std::size_t i = begin; i < end; i += hn::Lanes(d)) {
    const VectorTest<kSlabs> test(fixed, m, i);
    const auto here = hn::FirstN(d, end - i);
    const auto overlapping = hn::AndNot(test.Separate(), here);
    if constexpr (kMeasured == Measured::kUpper) measurer.Upper(test, overlapping);
    if constexpr (kMeasured == Measured::kBoth) {
      measurer.Both(test, here, last ? here : hn::AndNot(overlapping, here));
    }
    count += StoreSelected(d, overlapping, hn::Load(du, m.id + i), out + count);
  }
  return count;
}

// The overlapping pairs are the next frontier.
template <bool kSlabs, Measured kMeasured>
class PairRows {
 public:
  PairRows(const SearchStep& step, Frontier& out) : out_(out), last_(step.last) {}

  [[nodiscard]] bool HasRoom(std::size_t rows, std::size_t nodes) const {
    return has_room(out_, rows, nodes);
  }
  void Decoded(std::uint32_t, FixedGroup&) {}
  // Begins a row, or goes on with one that a limit cut. Returns the number of pairs before it.
  [[nodiscard]] HWY_INLINE std::size_t Begin() const { return out_.moving_count; }
  [[nodiscard]] HWY_INLINE std::size_t Continue(std::uint32_t fixed) {
    return begin_row(out_, fixed);
  }
  HWY_INLINE void Test(const FixedGroup& fixed, std::size_t row, const MovingLanes& moving,
                       std::size_t begin, std::size_t end, Measurer<kSlabs>& measurer) {
    out_.moving_count += TestRow<kSlabs, kMeasured>(fixed.rows, row, moving, begin, end, last_,
                                                    out_.moving + out_.moving_count, measurer);
  }
  HWY_INLINE void End(std::uint32_t fixed, std::size_t before) { end_row(out_, fixed, before); }

 private:
  Frontier& out_;
  const bool last_;
};

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
