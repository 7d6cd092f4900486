#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "query/query_cases.h"
#include "query/scenes.h"

namespace ist::test {

/// The motion of a hand for some ticks.
enum class Move : std::uint8_t {
  kStill,
  kTremble,  ///< at rest, with noise
  kClose,    ///< along the way between the bodies, and back
  kSlide,    ///< across it
  kTurn,
  kWalk,   ///< a random step each tick
  kRound,  ///< the way it came
  kJump,   ///< to another place, and on from there
  kAway,   ///< so far that the roots are apart, and back
};
inline constexpr std::array kMoves = {Move::kStill, Move::kTremble, Move::kClose,
                                      Move::kSlide, Move::kTurn,    Move::kWalk,
                                      Move::kRound, Move::kJump,    Move::kAway};

/// Poses of a scene's moving body, one a tick, near contact for the most part: each move lasts for
/// some ticks and begins where the last one ended.
class Motion {
 public:
  Motion(const Scene& scene, std::uint64_t seed);

  [[nodiscard]] Eigen::Isometry3d next();
  /// The move that the last pose was part of.
  [[nodiscard]] Move move() const { return move_; }
  /// Goes on with another move, of `ticks` ticks.
  void begin(Move move, int ticks);
  /// From now on such moves do not exceed `voxels` a tick.
  void limit_step(double voxels) { most_step_ = voxels; }

 private:
  // A pose at which the bodies are about to touch, and the way apart.
  struct Touch {
    Eigen::Matrix3d rotation;
    Eigen::Vector3d translation, apart;
  };
  void find_touches(const Scene& scene);
  void jump();
  void turn(const Eigen::Vector3d& axis, double length);

  Random random_;
  double voxel_, radius_;
  std::vector<Touch> touches_;
  Touch touch_;
  Eigen::Isometry3d pose_, rest_;
  Move move_ = Move::kStill;
  int left_ = 0;
  double most_step_ = 1, step_ = 0;
  Eigen::Vector3d velocity_, axis_;
};

}  // namespace ist::test
