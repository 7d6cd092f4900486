// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_TRIANGLES_BALLS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_TRIANGLES_BALLS_INL_H
#undef IST_SIMD_TRIANGLES_BALLS_INL_H
#else
#define IST_SIMD_TRIANGLES_BALLS_INL_H
#endif

#include <hwy/highway.h>

#include <limits>

#include "simd/triangles/ball_step.h"
#include "simd/triangles/sixteen-inl.h"

// Vector twins of the scalar forms in simd/triangles/balls_scalar.cpp. No product is fused to a
// sum. Of two numbers the same one is taken where one of them is no number.
HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using WholeTag = hn::RebindToSigned<FloatTag>;
using WholeVec = hn::Vec<WholeTag>;

HWY_INLINE FloatVec GreaterOf(FloatVec a, FloatVec b) { return hn::IfThenElse(hn::Gt(a, b), a, b); }
HWY_INLINE FloatVec LesserOf(FloatVec a, FloatVec b) { return hn::IfThenElse(hn::Lt(a, b), a, b); }

struct BallPoints {
  FloatVec x, y, z;
};
HWY_INLINE FloatVec BallDot(const BallPoints& a, const BallPoints& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

struct BallVectors {
  BallPoints centre;
  FloatVec radius;

  [[nodiscard]] HWY_INLINE BallPoints From(const BallPoints& p) const {
    return {hn::Sub(p.x, centre.x), hn::Sub(p.y, centre.y), hn::Sub(p.z, centre.z)};
  }
};

HWY_INLINE BallVectors LoadBalls(const BallGrid& grid, WholeVec at) {
  const WholeTag d;
  const FloatTag df;
  const auto* words = reinterpret_cast<const std::int32_t*>(grid.balls);
  const WholeVec low = hn::ShiftLeft<1>(at);
  const WholeVec xy = hn::GatherIndex(d, words, low), zr = hn::GatherIndex(d, words + 1, low);
  const hn::RebindToUnsigned<FloatTag> du;
  const WholeVec radius = hn::BitCast(d, hn::ShiftRight<16>(hn::BitCast(du, zr)));
  return {{hn::ConvertTo(df, hn::ShiftRight<16>(hn::ShiftLeft<16>(xy))),
           hn::ConvertTo(df, hn::ShiftRight<16>(xy)),
           hn::ConvertTo(df, hn::ShiftRight<16>(hn::ShiftLeft<16>(zr)))},
          hn::ConvertTo(df, radius)};
}

HWY_INLINE WholeVec CellsOf(const BallGrid& grid, FloatVec coordinate, std::size_t axis) {
  const FloatTag d;
  const FloatVec at =
      hn::Mul(hn::Sub(coordinate, hn::Set(d, grid.low[axis])), hn::Set(d, grid.cell_back));
  const FloatVec above = GreaterOf(at, hn::Zero(d));
  return hn::ConvertTo(WholeTag(), LesserOf(above, hn::Set(d, grid.last[axis])));
}

// The balls of the cells that hold some points.
HWY_INLINE BallVectors BallsAt(const BallGrid& grid, const BallPoints& p) {
  const WholeTag d;
  const WholeVec x = CellsOf(grid, p.x, 0), y = CellsOf(grid, p.y, 1), z = CellsOf(grid, p.z, 2);
  const WholeVec rows =
      hn::Add(hn::Mul(hn::ShiftRight<2>(z), hn::Set(d, grid.groups[1])), hn::ShiftRight<2>(y));
  const WholeVec group = hn::Add(hn::Mul(rows, hn::Set(d, grid.groups[0])), hn::ShiftRight<2>(x));
  const WholeVec entry = hn::GatherIndex(d, grid.first, group);
  const WholeVec three = hn::Set(d, 3);
  const WholeVec within =
      hn::Or(hn::Or(hn::ShiftLeft<4>(hn::And(z, three)), hn::ShiftLeft<2>(hn::And(y, three))),
             hn::And(x, three));
  const WholeVec split = hn::Neg(hn::And(entry, hn::Set(d, 1)));
  return LoadBalls(grid, hn::Add(hn::ShiftRight<1>(entry), hn::And(within, split)));
}

template <class Rotation>
HWY_INLINE FloatVec BallRow(const Rotation& r, const BallPoints& p) {
  const FloatTag d;
  return BallDot({hn::Set(d, r[0]), hn::Set(d, r[1]), hn::Set(d, r[2])}, p);
}

// Tells which bounds exceed the limit, and takes the largest of the others.
class OverLimit {
 public:
  HWY_INLINE OverLimit(float limit, std::uint32_t lanes)
      : limit_(limit),
        lanes_(lanes),
        most_(hn::Set(FloatTag(), -std::numeric_limits<float>::infinity())) {}

  HWY_INLINE void Take(FloatVec bound, std::size_t part) {
    const FloatTag d;
    const std::uint32_t here = lanes_ >> (part * kLanes) & FirstLanes(kLanes);
    const auto below = hn::Le(bound, hn::Set(d, limit_));
    over_ |= (here & ~BitsOf(below)) << (part * kLanes);
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(here),
                                   static_cast<std::uint8_t>(here >> 8)};
    const auto counts = hn::And(below, hn::LoadMaskBits(d, bytes));
    most_ = hn::IfThenElse(hn::And(counts, hn::Gt(bound, most_)), bound, most_);
  }
  [[nodiscard]] HWY_INLINE BallLanes Found() const {
    return {over_, hn::GetLane(hn::MaxOfLanes(FloatTag(), most_))};
  }

 private:
  const float limit_;
  const std::uint32_t lanes_;
  std::uint32_t over_ = 0;
  FloatVec most_;
};

inline BallLanes BoundNodes(const NodeBlock& nodes, const BallGrid& grid, const BallPose& pose,
                            float limit, std::uint32_t lanes, float* bounds) {
  const FloatTag d;
  const FloatVec scale = hn::Set(d, pose.scale), rounding = hn::Set(d, kBallRounding);
  OverLimit found(limit, lanes);
  for (std::size_t part = 0; part < kParts; ++part) {
    const std::size_t at = part * kLanes;
    const auto length = [&](const float* from)
                            HWY_ATTR { return hn::Mul(hn::Load(d, from + at), scale); };
    const BallPoints centre = {length(nodes.centre[0]), length(nodes.centre[1]),
                               length(nodes.centre[2])};
    const auto& r = pose.rotation;
    const auto& t = pose.translation;
    const BallPoints p = {hn::Add(BallRow(r[0], centre), hn::Set(d, t[0])),
                          hn::Add(BallRow(r[1], centre), hn::Set(d, t[1])),
                          hn::Add(BallRow(r[2], centre), hn::Set(d, t[2]))};
    const BallVectors ball = BallsAt(grid, p);
    const BallPoints way = ball.From(p);
    const FloatVec square = BallDot(way, way), distance = hn::Sqrt(square);
    const BallPoints own = {hn::Load(d, nodes.normal[0] + at), hn::Load(d, nodes.normal[1] + at),
                            hn::Load(d, nodes.normal[2] + at)};
    const BallPoints normal = {BallRow(r[0], own), BallRow(r[1], own), BallRow(r[2], own)};
    const FloatVec along = BallDot(way, normal), radius = length(nodes.radius);
    const FloatVec high =
        hn::Add(hn::Abs(hn::Add(along, length(nodes.offset))), length(nodes.thickness));
    const FloatVec across =
        hn::Add(hn::Sub(square, hn::Mul(along, along)), hn::Mul(rounding, square));
    const FloatVec wide = hn::Add(hn::Sqrt(GreaterOf(across, hn::Zero(d))), length(nodes.rim));
    const FloatVec disc = hn::Sqrt(hn::Add(hn::Mul(high, high), hn::Mul(wide, wide)));
    const FloatVec reach = hn::Add(distance, radius);
    const auto out_along = [&](FloatVec v, std::size_t i)
                               HWY_ATTR { return hn::Sub(hn::Abs(v), hn::Set(d, grid.half[i])); };
    const FloatVec out =
        GreaterOf(GreaterOf(out_along(p.x, 0), out_along(p.y, 1)), out_along(p.z, 2));
    const FloatVec by_ball = hn::Sub(LesserOf(disc, reach), ball.radius);
    const FloatVec bound = hn::Add(LesserOf(by_ball, hn::Sub(radius, out)),
                                   hn::Add(hn::Mul(rounding, reach), hn::Set(d, pose.pad)));
    hn::StoreU(bound, d, bounds + at);
    found.Take(bound, part);
  }
  return found.Found();
}

// Returns the square of the distance of the farthest corner from a ball's centre.
HWY_INLINE FloatVec FarthestSquare(const BallPoints (&corner)[3], const BallVectors& ball) {
  FloatVec far = hn::Zero(FloatTag());
  for (const BallPoints& p : corner) {
    const BallPoints way = ball.From(p);
    const FloatVec square = BallDot(way, way);
    far = hn::IfThenElse(hn::Le(square, far), far, square);
  }
  return far;
}

inline BallLanes BoundCorners(const TriangleCluster& cluster, const NodeBlock& nodes,
                              std::size_t lane, const BallGrid& grid, const BallPose& pose,
                              float limit, std::uint32_t lanes, float* bounds) {
  const FloatTag d;
  const BallTurn turn(cluster, nodes, lane, pose);
  const auto& r = turn.rotation;
  const auto& t = turn.translation;
  const FloatVec third = hn::Set(d, 1.0F / 3), rounding = hn::Set(d, kBallRounding);
  OverLimit found(limit, lanes);
  for (std::size_t part = 0; part < kParts; ++part) {
    const std::size_t at = part * kLanes;
    BallPoints corner[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& from = cluster.corner[k];
      const BallPoints own = {hn::Load(d, from[0] + at), hn::Load(d, from[1] + at),
                              hn::Load(d, from[2] + at)};
      corner[k] = {hn::Add(BallRow(r[0], own), hn::Set(d, t[0])),
                   hn::Add(BallRow(r[1], own), hn::Set(d, t[1])),
                   hn::Add(BallRow(r[2], own), hn::Set(d, t[2]))};
    }
    const auto mean = [&](FloatVec a, FloatVec b, FloatVec c)
                          HWY_ATTR { return hn::Mul(hn::Add(hn::Add(a, b), c), third); };
    const BallPoints middle = {mean(corner[0].x, corner[1].x, corner[2].x),
                               mean(corner[0].y, corner[1].y, corner[2].y),
                               mean(corner[0].z, corner[1].z, corner[2].z)};
    const BallVectors ball = BallsAt(grid, middle);
    const FloatVec distance = hn::Sqrt(FarthestSquare(corner, ball));
    const FloatVec bound = hn::Add(hn::Sub(distance, ball.radius),
                                   hn::Add(hn::Mul(rounding, distance), hn::Set(d, pose.pad)));
    hn::StoreU(bound, d, bounds + at);
    found.Take(bound, part);
  }
  return found.Found();
}

inline float BoundAround(const BallTriangle& triangle, const BallGrid& grid, float pad) {
  const FloatTag d;
  float middle[3];
  for (std::size_t i = 0; i < 3; ++i) {
    middle[i] = middle_of(triangle[0][i], triangle[1][i], triangle[2][i]);
  }
  const std::array<std::int32_t, 32> places = balls_around(grid, middle);
  BallPoints corner[3];
  for (std::size_t k = 0; k < 3; ++k) {
    corner[k] = {hn::Set(d, triangle[k][0]), hn::Set(d, triangle[k][1]),
                 hn::Set(d, triangle[k][2])};
  }
  FloatVec least = hn::Set(d, std::numeric_limits<float>::infinity());
  const FloatVec rounding = hn::Set(d, kBallRounding);
  for (std::size_t at = 0; at < places.size(); at += kLanes) {
    const BallVectors ball = LoadBalls(grid, hn::LoadU(WholeTag(), places.data() + at));
    const FloatVec distance = hn::Sqrt(FarthestSquare(corner, ball));
    const FloatVec bound = hn::Add(hn::Sub(distance, ball.radius), hn::Mul(rounding, distance));
    least = hn::IfThenElse(hn::Lt(bound, least), bound, least);
  }
  return hn::GetLane(hn::MinOfLanes(d, least)) + pad;
}

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
