#pragma once

#include <cstddef>
#include <cstdint>

#include "simd/step.h"

namespace ist {

/// The places of the sums over leaf pairs: Σ w, Σ w n, Σ p × w n, Σ w x n and Σ p × w x n, with
/// weight w, unit normal n, position p and depth x over the least one.
enum ContactSum : std::size_t {
  kWeightSum,
  kForceSum,
  kTorqueSum = 4,
  kSpringSum = 7,
  kSpringTorqueSum = 10,
};
inline constexpr std::size_t kContactSums = 13;

/// The numbers by which leaf pairs are weighed, the same for all poses of two trees. A weight is in
/// parts of the greatest, a depth in parts of its range, a position in parts of a lever that no
/// contact exceeds: so no term of a sum exceeds √2.
struct ContactRule {
  float per_ball;         ///< 1 / (sum of two leaves' circumradii)², 1 / mesh units²
  float per_slab;         ///< 1 / overlap with a slab over which a weight fades in
  float per_scaled_slab;  ///< per_slab / kSlabScale
  float least;            ///< least depth, mesh units: the negative margin
  float range;            ///< greatest depth over the least one, mesh units
  float per_range;        ///< 1 / range
  float fade_from;        ///< factor of the weight at the least depth: 0, or 1 where none fades
  float per_fade;         ///< slope of that factor up to 1, 1 / mesh units
  float half_per_lever;   ///< 1 / (2 · lever), 1 / mesh units
};

/// The units of a sum in its greatest term, in fixed point: a batch adds up in 32 bits, for
/// 512 · √2 · 2²¹ < 2³¹.
inline constexpr float kContactUnit = 0x1p21F;
inline constexpr std::size_t kContactBatch = 512;

/// Sums over leaf pairs in fixed point, the same in whatever order pairs are added. Room for 2⁴¹
/// pairs.
struct ContactTotals {
  std::int64_t sum[kContactSums] = {};  ///< in the moving tree's frame, kContactUnit to a unit
  std::uint64_t counted = 0;            ///< leaf pairs with a weight above 0
  std::uint64_t pairs = 0;              ///< all leaf pairs

  void add(const ContactTotals& other) noexcept {
    for (std::size_t i = 0; i < kContactSums; ++i) sum[i] += other.sum[i];
    counted += other.counted;
    pairs += other.pairs;
  }
};

/// Leaf pairs whose bounds overlap, side by side, that wait to be added up. Points of surfaces are
/// in the moving tree's frame, mesh units.
struct alignas(64) ContactLanes {
  /// Pairs may be appended until there are so many: then there is room for another row.
  static constexpr std::size_t kFull = kContactBatch;
  static constexpr std::size_t kSize = kFull + 1024 + 16;
  float share[kSize];  ///< factor of the weight that the bounds give
  float fixed_x[kSize], fixed_y[kSize], fixed_z[kSize];
  float moving_x[kSize], moving_y[kSize], moving_z[kSize];
  std::uint32_t fixed[kSize];         ///< leaves, by address: 8 · parent + slot
  std::uint32_t fixed_normal[kSize];  ///< PackedNormal
  std::uint32_t moving[kSize];        ///< leaves, as the step names them
  std::size_t count = 0;

  static_assert(kSize % 16 == 0);
};

/// The terms of a batch of leaf pairs, side by side: all 0 for a pair without weight.
struct alignas(64) ContactTerms {
  static constexpr std::size_t kSize = kContactBatch + 16;
  float weight[kSize];                                   ///< in kContactUnit
  float depth[kSize];                                    ///< over the least depth, mesh units
  float x[kSize], y[kSize], z[kSize];                    ///< positions, in parts of the lever
  float force_x[kSize], force_y[kSize], force_z[kSize];  ///< weight · normal
  const std::uint32_t* fixed = nullptr;                  ///< leaves, by address
  std::size_t count = 0;
};

/// Takes the terms of leaf pairs in the order of the search, a batch at a time.
class ContactTermsStream {
 public:
  virtual void take(const ContactTerms& terms) noexcept = 0;

 protected:
  ~ContactTermsStream() = default;
};

/// Adds up the leaf pairs that the last step of a search finds. One object belongs to one thread.
struct ContactAdder {
  ContactRule rule{};
  ContactTotals totals;
  ContactTermsStream* stream = nullptr;  ///< takes the terms, where that is wanted
  ContactLanes lanes;
  ContactTerms terms;

  void clear() noexcept {
    totals = {};
    lanes.count = 0;
  }
};

/// Advances like AdvanceFunction in a last step, but gives the overlapping pairs to `out`, which
/// may keep some in its lanes and is never full. Measures no lower end: kBoth is as kUpper.
using AdvanceContactsFunction = Advanced (*)(const SearchStep& step, const SearchPose& pose,
                                             const Frontier& in, SearchCursor& cursor,
                                             ContactAdder& out, SearchScratch& scratch,
                                             std::uint64_t most, Measured measured,
                                             DistanceBounds& bounds);

/// Adds up the pairs in the lanes of `out`, which are empty then.
using AddContactsFunction = void (*)(const SearchStep& step, const SearchPose& pose,
                                     ContactAdder& out);

/// The scalar forms specify the vector kernels, which give the same numbers, bit by bit. Cost: 10
/// to 20 ns a test, 40 ns a leaf pair.
Advanced advance_contacts_scalar(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                                 SearchCursor& cursor, ContactAdder& out, SearchScratch& scratch,
                                 std::uint64_t most, Measured measured, DistanceBounds& bounds);
void add_contacts_scalar(const SearchStep& step, const SearchPose& pose, ContactAdder& out);

}  // namespace ist
