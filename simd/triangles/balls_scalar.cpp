#include <cmath>
#include <limits>

#include "simd/triangles/ball_step.h"

namespace ist {
namespace {

using Point = std::array<float, 3>;

float dot(const Point& a, const Point& b) noexcept {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}
float row(const float (&r)[3], const Point& p) noexcept {
  return (r[0] * p[0] + r[1] * p[1]) + r[2] * p[2];
}
template <class Motion>
Point moved(const Motion& motion, const Point& p) noexcept {
  Point at;
  for (std::size_t i = 0; i < 3; ++i) at[i] = row(motion.rotation[i], p) + motion.translation[i];
  return at;
}

struct FloatBall {
  Point centre;
  float radius;

  explicit FloatBall(const OuterBall& ball) noexcept
      : centre{static_cast<float>(ball.x()), static_cast<float>(ball.y()),
               static_cast<float>(ball.z())},
        radius(static_cast<float>(ball.radius())) {}
  [[nodiscard]] Point from(const Point& p) const noexcept {
    return {p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]};
  }
};

FloatBall ball_of(const BallGrid& grid, const Point& p) noexcept {
  return FloatBall(grid.balls[ball_at(grid, cell_of(grid, p[0], 0), cell_of(grid, p[1], 1),
                                      cell_of(grid, p[2], 2))]);
}

class OverLimit {
 public:
  OverLimit(float limit, std::uint32_t lanes) noexcept : limit_(limit), lanes_(lanes) {}
  void take(float bound, std::size_t lane) noexcept {
    if ((lanes_ >> lane & 1U) == 0) return;
    if (!(bound <= limit_)) {
      found_.over |= std::uint32_t{1} << lane;
    } else if (bound > found_.most) {
      found_.most = bound;
    }
  }
  [[nodiscard]] BallLanes found() const noexcept { return found_; }

 private:
  const float limit_;
  const std::uint32_t lanes_;
  BallLanes found_{0, -std::numeric_limits<float>::infinity()};
};

float farthest_square(const std::array<Point, 3>& corner, const FloatBall& ball) noexcept {
  float far = 0;
  for (const Point& p : corner) {
    const Point way = ball.from(p);
    const float square = dot(way, way);
    if (!(square <= far)) far = square;
  }
  return far;
}

}  // namespace

// What is in a node lies in its ball and in its disc. A point of the disc is no higher over the
// outer ball's centre, along the disc's normal, than the disc's middle and half its thickness, and
// no farther beside it than the node's centre and the rim. It is no deeper in the body than in the
// body's box.
BallLanes bound_nodes_scalar(const NodeBlock& nodes, const BallGrid& grid, const BallPose& pose,
                             float limit, std::uint32_t lanes, float* bounds) {
  OverLimit found(limit, lanes);
  for (std::size_t lane = 0; lane < kClusterWidth; ++lane) {
    const auto length = [&](const float(&from)[kClusterWidth]) { return from[lane] * pose.scale; };
    const Point p =
        moved(pose, {length(nodes.centre[0]), length(nodes.centre[1]), length(nodes.centre[2])});
    const FloatBall ball = ball_of(grid, p);
    const Point way = ball.from(p);
    const float square = dot(way, way), distance = std::sqrt(square);
    const Point own = {nodes.normal[0][lane], nodes.normal[1][lane], nodes.normal[2][lane]};
    const auto& r = pose.rotation;
    const float along = dot(way, {row(r[0], own), row(r[1], own), row(r[2], own)});
    const float radius = length(nodes.radius);
    const float high = std::abs(along + length(nodes.offset)) + length(nodes.thickness);
    const float across = (square - along * along) + kBallRounding * square;
    const float wide = std::sqrt(greater_of(across, 0)) + length(nodes.rim);
    const float disc = std::sqrt(high * high + wide * wide), reach = distance + radius;
    const float out =
        greater_of(greater_of(std::abs(p[0]) - grid.half[0], std::abs(p[1]) - grid.half[1]),
                   std::abs(p[2]) - grid.half[2]);
    const float by_ball = lesser_of(disc, reach) - ball.radius;
    bounds[lane] = lesser_of(by_ball, radius - out) + (kBallRounding * reach + pose.pad);
    found.take(bounds[lane], lane);
  }
  return found.found();
}

BallLanes bound_corners_scalar(const TriangleCluster& cluster, const NodeBlock& nodes,
                               std::size_t lane, const BallGrid& grid, const BallPose& pose,
                               float limit, std::uint32_t lanes, float* bounds) {
  const BallTurn turn(cluster, nodes, lane, pose);
  OverLimit found(limit, lanes);
  for (std::size_t k = 0; k < kClusterWidth; ++k) {
    std::array<Point, 3> corner;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& from = cluster.corner[i];
      corner[i] = moved(turn, {from[0][k], from[1][k], from[2][k]});
    }
    Point middle;
    for (std::size_t i = 0; i < 3; ++i) {
      middle[i] = middle_of(corner[0][i], corner[1][i], corner[2][i]);
    }
    const FloatBall ball = ball_of(grid, middle);
    const float distance = std::sqrt(farthest_square(corner, ball));
    bounds[k] = (distance - ball.radius) + (kBallRounding * distance + pose.pad);
    found.take(bounds[k], k);
  }
  return found.found();
}

float bound_around_scalar(const BallTriangle& triangle, const BallGrid& grid, float pad) {
  float middle[3];
  for (std::size_t i = 0; i < 3; ++i) {
    middle[i] = middle_of(triangle[0][i], triangle[1][i], triangle[2][i]);
  }
  float least = std::numeric_limits<float>::infinity();
  for (const std::int32_t place : balls_around(grid, middle)) {
    const FloatBall ball(grid.balls[place]);
    const float distance = std::sqrt(farthest_square(triangle, ball));
    const float bound = (distance - ball.radius) + kBallRounding * distance;
    if (bound < least) least = bound;
  }
  return least + pad;
}

}  // namespace ist
