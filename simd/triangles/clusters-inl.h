// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_EXACT_CLUSTERS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_EXACT_CLUSTERS_INL_H
#undef IST_SIMD_EXACT_CLUSTERS_INL_H
#else
#define IST_SIMD_EXACT_CLUSTERS_INL_H
#endif

#include <hwy/highway.h>

#include <bit>
#include <cmath>

#include "simd/select-inl.h"
#include "simd/triangles/cluster_step.h"
#include "simd/triangles/sixteen-inl.h"
#include "simd/triangles/triangle_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The corners of sixteen triangles.
struct SixteenTriangles {
  Sixteen corner[3][3];  // corner, coordinate

  HWY_INLINE void Load(const TriangleCluster& cluster) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) corner[k][i] = Load16(cluster.corner[k][i]);
    }
  }
};

// The least and the greatest coordinate of sixteen triangles along one axis.
struct Range16 {
  Sixteen low, high;

  HWY_INLINE void Set(const Sixteen& a, const Sixteen& b, const Sixteen& c) {
    low = Min(Min(a, b), c);
    high = Max(Max(a, b), c);
  }
  // The lanes that lie beside a range.
  HWY_INLINE Truth16 Beside(float from, float to, const Sixteen& slack) const {
    return (low > Set16(to) + slack) | (Set16(from) - slack > high);
  }
};

// Sixteen triangles along some axes, and how far from them others count as near.
template <std::size_t kAxes>
struct Ranges {
  Range16 axis[kAxes];
  Sixteen slack[kAxes];
};

// Finds, of a moving cluster and one fixed cluster after the other, the pairs of triangles whose
// boxes are within reach, in a frame of the fixed cluster: first the moving triangles in the fixed
// cluster's box, then the fixed triangles in the moving one's, then triangle by triangle.
class ClusterPair {
 public:
  HWY_INLINE ClusterPair(const ClusterStep& step, const TurnedBlock& lanes, std::uint32_t lane,
                         std::uint32_t moving, std::uint32_t* HWY_RESTRICT codes)
      : step_(step), moving_(step.moving[moving]), radius_(lanes.radius[lane]), codes_(codes) {
    moving_lanes_ = FirstLanes(HWY_MIN(step.moving_triangles - kClusterWidth * moving, 16U));
    own_.Load(moving_);
    for (std::size_t i = 0; i < 3; ++i) {
      centre_[i] = lanes.centre[i][lane];
      rest_[i] = lanes.rest[i][lane];
      const auto& r = step.pose.rotation[i];
      for (std::size_t k = 0; k < 3; ++k) {
        axis_[i][k] = static_cast<float>(r[0] * moving_.axis[0][k] + r[1] * moving_.axis[1][k] +
                                         r[2] * moving_.axis[2][k]);
      }
      axis_[i][3] = 0;
    }
  }

  // Returns the number of pairs; codes() then names them, a fixed lane and 16 times a moving one.
  // Where the reach is not next to nothing, a fourth axis tells more pairs apart: the direction of
  // the moving centre from the fixed box.
  template <bool kFourth>
  HWY_INLINE std::size_t Find(std::uint32_t fixed, const NodeBlock& block, std::size_t lane,
                              float reach) {
    const TriangleCluster& cluster = step_.fixed[fixed];
    SetPlace(cluster, block, lane);
    const Sixteen slack = Set16(reach + 2 * error_);
    Lanes16 moving = MoveInto(cluster, slack);
    if (moving == 0) return 0;
    still_.Load(cluster);
    Lanes16 still = FirstLanes(HWY_MIN(step_.fixed_triangles - kClusterWidth * fixed, 16U));
    constexpr std::size_t kAxes = kFourth ? 4 : 3;
    Ranges<kAxes> of_moving, of_still;
    if constexpr (kFourth) {
      const Sixteen more = Set16(reach * (1 + 0x1p-20F) + 4 * error_);
      SetFourth(cluster, of_moving.axis[3], of_still.axis[3]);
      of_moving.slack[3] = of_still.slack[3] = more;
      moving &= ~BitsOf(of_moving.axis[3].low > Greatest(of_still.axis[3].high) + more);
      still &= ~BitsOf(Least(of_moving.axis[3].low) - more > of_still.axis[3].high);
      if (moving == 0 || still == 0) return 0;
    }
    still &= StillIn(slack);
    if (still == 0) return 0;
    for (std::size_t i = 0; i < 3; ++i) {
      of_moving.axis[i] = moved_ranges_[i];
      of_still.axis[i].Set(still_.corner[0][i], still_.corner[1][i], still_.corner[2][i]);
      of_moving.slack[i] = of_still.slack[i] = slack;
    }
    fixed_ids_ = cluster.id;
    return std::popcount(moving) < std::popcount(still)
               ? List<true>(moving, still, of_moving, of_still)
               : List<false>(still, moving, of_still, of_moving);
  }

  [[nodiscard]] HWY_INLINE const std::uint32_t* codes() const { return codes_; }
  [[nodiscard]] HWY_INLINE float error() const { return error_; }
  [[nodiscard]] HWY_INLINE const SixteenTriangles& still() const { return still_; }
  [[nodiscard]] HWY_INLINE const SixteenTriangles& moved() const { return moved_; }
  [[nodiscard]] HWY_INLINE const std::uint32_t* fixed_ids() const { return fixed_ids_; }
  [[nodiscard]] HWY_INLINE const std::uint32_t* moving_ids() const { return moving_.id; }

 private:
  // Sets the moving cluster's axes and centre along the fixed one's axes, and the centre along its
  // own.
  HWY_INLINE void SetPlace(const TriangleCluster& cluster, const NodeBlock& block,
                           std::size_t lane) {
    const hn::CappedTag<float, 4> d;
    using V = hn::Vec<decltype(d)>;
    V column[3], own[3], apart[3];
    float size = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const float from = (centre_[i] - block.centre[i][lane]) + rest_[i];
      size += std::abs(from);
      apart[i] = hn::Set(d, from);
      column[i] = hn::LoadU(d, cluster.axis[i]);
      own[i] = hn::Load(d, axis_[i]);
    }
    const auto dot = [](const V(&a)[3], V x, V y, V z) {
      return hn::MulAdd(a[2], z, hn::MulAdd(a[1], y, hn::Mul(a[0], x)));
    };
    error_ = difference_error(block.radius[lane], radius_, size, step_.pose.error);
    hn::Store(dot(column, apart[0], apart[1], apart[2]), d, place_);
    hn::Store(dot(own, apart[0], apart[1], apart[2]), d, back_);
    for (std::size_t k = 0; k < 3; ++k) {
      hn::Store(
          dot(column, hn::Set(d, axis_[0][k]), hn::Set(d, axis_[1][k]), hn::Set(d, axis_[2][k])), d,
          turn_[k]);
    }
  }

  // Moves the triangles into the fixed cluster's frame. Returns those that may be near its box.
  HWY_INLINE Lanes16 MoveInto(const TriangleCluster& cluster, const Sixteen& slack) {
    Truth16 beside = None16();
    for (std::size_t i = 0; i < 3; ++i) {
      const Sixteen x = Set16(turn_[0][i]), y = Set16(turn_[1][i]), z = Set16(turn_[2][i]);
      const Sixteen place = Set16(place_[i]);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& p = own_.corner[k];
        moved_.corner[k][i] = MulAdd(z, p[2], MulAdd(y, p[1], MulAdd(x, p[0], place)));
      }
      moved_ranges_[i].Set(moved_.corner[0][i], moved_.corner[1][i], moved_.corner[2][i]);
      beside = beside | moved_ranges_[i].Beside(cluster.low[i], cluster.high[i], slack);
    }
    return moving_lanes_ & ~BitsOf(beside);
  }

  // Returns the fixed triangles that may be near the moving cluster's box.
  HWY_INLINE Lanes16 StillIn(const Sixteen& slack) const {
    Truth16 beside = None16();
    for (std::size_t j = 0; j < 3; ++j) {
      const Sixteen x = Set16(turn_[j][0]), y = Set16(turn_[j][1]), z = Set16(turn_[j][2]);
      const Sixteen back = Set16(-back_[j]);
      Sixteen along[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& p = still_.corner[k];
        along[k] = MulAdd(z, p[2], MulAdd(y, p[1], MulAdd(x, p[0], back)));
      }
      Range16 range;
      range.Set(along[0], along[1], along[2]);
      beside = beside | range.Beside(moving_.low[j], moving_.high[j], slack);
    }
    return ~BitsOf(beside) & kAllLanes;
  }

  // The triangles along a unit vector, or along nothing.
  HWY_INLINE void SetFourth(const TriangleCluster& cluster, Range16& of_moving,
                            Range16& of_still) const {
    float v[3], squared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      v[i] = place_[i] - HWY_MIN(HWY_MAX(place_[i], cluster.low[i]), cluster.high[i]);
      squared += v[i] * v[i];
    }
    const float scale = squared > kLeastSquare ? 1 / std::sqrt(squared) : 0;
    const Sixteen x = Set16(v[0] * scale), y = Set16(v[1] * scale), z = Set16(v[2] * scale);
    const auto set = [&](const SixteenTriangles& t, Range16& range) HWY_ATTR {
      Sixteen along[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& p = t.corner[k];
        along[k] = MulAdd(z, p[2], MulAdd(y, p[1], x * p[0]));
      }
      range.Set(along[0], along[1], along[2]);
    };
    set(moved_, of_moving);
    set(still_, of_still);
  }

  // Lists the pairs of a triangle of `rows` and one of `lanes` whose ranges are near.
  template <bool kRowsMove, std::size_t kAxes>
  HWY_INLINE std::size_t List(Lanes16 rows, Lanes16 lanes, const Ranges<kAxes>& of_rows,
                              const Ranges<kAxes>& of_lanes) {
    const FloatTag d;
    const IndexTag du;
    alignas(64) float low[kAxes][16], high[kAxes][16];
    for (std::size_t i = 0; i < kAxes; ++i) {
      Store16(of_rows.axis[i].low - of_rows.slack[i], low[i]);
      Store16(of_rows.axis[i].high + of_rows.slack[i], high[i]);
    }
    std::size_t count = 0;
    for (; rows != 0; rows &= rows - 1) {
      const auto row = static_cast<std::uint32_t>(std::countr_zero(rows));
      for (std::size_t part = 0; part < kParts; ++part) {
        auto beside = hn::FirstN(d, 0);
        for (std::size_t i = 0; i < kAxes; ++i) {
          const Range16& range = of_lanes.axis[i];
          beside = hn::Or(beside, hn::Gt(range.low.part[part], hn::Set(d, high[i][row])));
          beside = hn::Or(beside, hn::Gt(hn::Set(d, low[i][row]), range.high.part[part]));
        }
        const Lanes16 near = ~BitsOf(beside) & lanes >> (part * kLanes) & FirstLanes(kLanes);
        const IndexVec lane = hn::Iota(du, static_cast<std::uint32_t>(part * kLanes));
        const IndexVec codes = kRowsMove ? hn::Or(lane, hn::Set(du, 16 * row))
                                         : hn::Or(hn::ShiftLeft<4>(lane), hn::Set(du, row));
        const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(near),
                                       static_cast<std::uint8_t>(near >> 8)};
        count += StoreSelected(d, hn::LoadMaskBits(d, bytes), codes, codes_ + count);
      }
    }
    return count;
  }

  const ClusterStep& step_;
  const TriangleCluster& moving_;
  const float radius_;
  Lanes16 moving_lanes_;
  float centre_[3], rest_[3];
  alignas(16) float axis_[3][4];             // of the moving cluster: coordinate, axis
  alignas(16) float turn_[3][4], place_[4];  // moving axis, fixed axis
  alignas(16) float back_[4];
  float error_ = 0;
  SixteenTriangles own_, moved_, still_;
  Range16 moved_ranges_[3];
  const std::uint32_t* fixed_ids_ = nullptr;
  std::uint32_t* const codes_;
};

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
