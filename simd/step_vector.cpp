#include "simd/dispatch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/step_vector.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/advance-inl.h"
#include "simd/contact_rows-inl.h"
#include "simd/contact_sums-inl.h"
#include "simd/pair_cache-inl.h"

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

// Calls a function object with whether a step's bounds have slabs.
template <class Run>
auto WithSlabs(const SearchStep& step, const Run& run) {
  return step.fixed.slabs != nullptr ? run.template operator()<true>()
                                     : run.template operator()<false>();
}

// Calls a function object with the template arguments of a step; kLower: both ends may be measured.
template <bool kLower, class Run>
Advanced Specialised(const SearchStep& step, Measured measured, const Run& run) {
  const auto measure = [&]<bool kSlabs>() {
    switch (measured) {
      case Measured::kBoth:
        if constexpr (kLower) return run.template operator()<kSlabs, Measured::kBoth>();
        [[fallthrough]];
      case Measured::kUpper:
        return run.template operator()<kSlabs, Measured::kUpper>();
      default:
        return run.template operator()<kSlabs, Measured::kNothing>();
    }
  };
  return WithSlabs(step, measure);
}

Advanced Advance(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                 SearchCursor& cursor, Frontier& out, SearchScratch& scratch, std::uint64_t most,
                 Measured measured, DistanceBounds& bounds) {
  Frontier next = out;  // copies, so that the compiler may keep them in registers
  DistanceBounds known = bounds;
  const Advanced advanced =
      Specialised<true>(step, measured, [&]<bool kSlabs, Measured kMeasured>() {
        using Rows = PairRows<kSlabs, kMeasured>;
        return Advancer<kSlabs, Rows>(step, pose, in, Rows(step, next), scratch, most, known)
            .Run(cursor);
      });
  out = next;
  bounds = known;
  return advanced;
}

// Vector twin of ist::advance_contacts_scalar.
Advanced AdvanceContacts(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                         SearchCursor& cursor, ContactAdder& out, SearchScratch& scratch,
                         std::uint64_t most, Measured measured, DistanceBounds& bounds) {
  DistanceBounds known = bounds;
  const Advanced advanced =
      Specialised<false>(step, measured, [&]<bool kSlabs, Measured kMeasured>() {
        using Rows = ContactRows<kSlabs, kMeasured>;
        return Advancer<kSlabs, Rows>(step, pose, in, Rows(step, pose, out), scratch, most, known)
            .Run(cursor);
      });
  bounds = known;
  return advanced;
}

// Vector twins of the scalar forms in simd/pair_cache_step.h.
Advanced AdvanceCache(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                      SearchCursor& cursor, CacheLanes& out, SearchScratch& scratch,
                      std::uint64_t most) {
  DistanceBounds none;
  const std::size_t before = out.pair_count;
  const Advanced advanced = WithSlabs(step, [&]<bool kSlabs>() {
    using Rows = CachePairs<kSlabs>;
    return Advancer<kSlabs, Rows>(step, pose, in, Rows(step, out), scratch, most, none).Run(cursor);
  });
  UnpackMovingNormals(step, before, out);
  return advanced;
}

void TurnCache(const CacheLanes& cache, const SearchStep& step, const SearchPose& pose,
               bool surfaces, CacheRows& rows) {
  WithSlabs(step, [&]<bool kSlabs>() { TurnRows<kSlabs>(cache, step, pose, surfaces, rows); });
}

std::size_t SelectCache(const CacheLanes& cache, const SearchStep& step, const CacheRows& rows,
                        std::size_t begin, std::size_t end, std::uint32_t* out) {
  return WithSlabs(
      step, [&]<bool kSlabs>() { return SelectPairs<kSlabs>(cache, rows, begin, end, out); });
}

void AddCache(const CacheLanes& cache, const SearchStep& step, const CacheRows& rows,
              std::size_t begin, std::size_t end, ContactAdder& out) {
  WithSlabs(step, [&]<bool kSlabs>() { AddPairs<kSlabs>(cache, rows, begin, end, out); });
}

// Vector twin of ist::write_leaf_pairs_scalar.
void WriteLeafPairs(const Frontier& leaves, LeafPair* HWY_RESTRICT out) {
  const hn::CappedTag<std::uint64_t, 8> d;
  const hn::Rebind<std::uint32_t, decltype(d)> half;
  std::uint32_t begin = 0;
  for (std::size_t g = 0; g < leaves.group_count; ++g) {
    const SearchGroup group = leaves.groups[g];
    const auto fixed = hn::Set(d, std::uint64_t{group.fixed});
    for (std::uint32_t i = begin; i < group.end; i += static_cast<std::uint32_t>(hn::Lanes(d))) {
      const auto moving = hn::PromoteTo(d, hn::LoadU(half, leaves.moving + i));
      hn::StoreU(hn::Or(fixed, hn::ShiftLeft<32>(moving)), d,
                 reinterpret_cast<std::uint64_t*>(out + i));
    }
    begin = group.end;
  }
}

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <array>
#include <cstdint>

#include "ist/base/platform/instruction_sets.h"
#include "simd/lanes.h"
#include "simd/measure-inl.h"
#include "simd/select-inl.h"

namespace ist::simd {
namespace {

// The targets that this processor has. Highway's own answer would need its library.
std::int64_t supported_targets() {
#if HWY_ARCH_X86
  const InstructionSets has = instruction_sets();
  return (has.ssse3 ? HWY_SSSE3 : 0) | (has.sse4 ? HWY_SSE4 : 0) | (has.avx2 ? HWY_AVX2 : 0) |
         (has.avx3 ? HWY_AVX3 : 0);
#else
  return HWY_TARGETS;
#endif
}

struct Compiled {
  std::int64_t bit;
  Kernels kernels;
};

// One target's kernels, or null where this compiler does not make them.
#define IST_KERNELS(NAME, TARGET)                                                 \
  Compiled {                                                                      \
    HWY_##TARGET, {                                                               \
      NAME, HWY_CHOOSE_##TARGET(Advance), HWY_CHOOSE_##TARGET(WriteLeafPairs),    \
          HWY_CHOOSE_##TARGET(AdvanceContacts), HWY_CHOOSE_##TARGET(AddContacts), \
          HWY_CHOOSE_##TARGET(AdvanceCache), HWY_CHOOSE_##TARGET(TurnCache),      \
          HWY_CHOOSE_##TARGET(SelectCache), HWY_CHOOSE_##TARGET(AddCache), {}     \
    }                                                                             \
  }

constexpr std::array kCompiled = {IST_KERNELS("avx3", AVX3), IST_KERNELS("avx2", AVX2),
                                  IST_KERNELS("sse4", SSE4), IST_KERNELS("ssse3", SSSE3),
                                  IST_KERNELS("neon", NEON), IST_KERNELS("simd128", WASM)};

#undef IST_KERNELS

}  // namespace

std::vector<Kernels> supported_kernels() {
  std::vector<Kernels> kernels;
  const std::int64_t supported = supported_targets();
  for (const Compiled& compiled : kCompiled) {
    if (compiled.kernels.advance != nullptr && (supported & compiled.bit) != 0) {
      kernels.push_back(compiled.kernels);
      kernels.back().clusters = cluster_kernels(compiled.bit);
    }
  }
  return kernels;
}

}  // namespace ist::simd
#endif
