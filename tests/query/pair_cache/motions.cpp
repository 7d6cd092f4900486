#include "query/pair_cache/motions.h"

#include <algorithm>
#include <cmath>

namespace ist::test {
namespace {

constexpr int kTouches = 4;
constexpr double kDeepest = 10, kFarthest = 6;  // voxels from where bodies touch

Eigen::Vector3d across(const Eigen::Vector3d& way, Random& random) {
  const Eigen::Vector3d any = way.cross(random.direction());
  return any.norm() < 0.1 ? Eigen::Vector3d(way.unitOrthogonal()) : any.normalized();
}

}  // namespace

Motion::Motion(const Scene& scene, std::uint64_t seed)
    : random_(seed),
      voxel_(std::min(scene.fixed.voxel_size(), scene.moving.voxel_size())),
      radius_(scene.moving.bounding_radius()),
      pose_(scene.pose),
      rest_(scene.pose),
      velocity_(0, 0, 0),
      axis_(0, 0, 1) {
  find_touches(scene);
  jump();
}

void Motion::find_touches(const Scene& scene) {
  Query query(scene.fixed, scene.moving, options_of(SpherePolicy::kTable));
  const double far = scene.fixed.bounding_radius() + radius_;
  for (int k = 0; k < kTouches; ++k) {
    const Eigen::Matrix3d rotation =
        k % 2 == 0 ? scene.pose.linear() : Eigen::Matrix3d(random_.rotation());
    const Eigen::Vector3d apart = random_.direction();
    double near = 0, away = far;
    for (int i = 0; i < 18; ++i) {
      const double middle = 0.5 * (near + away);
      const Eigen::Isometry3d at = pose_of(rotation, scene.pose.translation() + middle * apart);
      (query.intersects(at).answer != ist::Answer::kNo ? near : away) = middle;
    }
    touches_.push_back({rotation, scene.pose.translation() + near * apart, apart});
  }
  touches_.push_back({scene.pose.linear(), scene.pose.translation(), random_.direction()});
}

void Motion::jump() {
  touch_ = touches_[random_.below(touches_.size())];
  pose_ =
      pose_of(touch_.rotation, touch_.translation + voxel_ * random_.uniform(-2, 3) * touch_.apart);
}

// Turns so that the far end moves by about `length`, about a point of the body.
void Motion::turn(const Eigen::Vector3d& axis, double length) {
  const Eigen::Vector3d about = pose_.translation() + radius_ * random_.uniform(0, 0.2) * axis_;
  Eigen::Quaterniond turned(Eigen::AngleAxisd(length / radius_, axis) * pose_.linear());
  turned.normalize();
  const Eigen::Matrix3d rotation = turned.toRotationMatrix();
  pose_.translation() =
      about + rotation * (pose_.linear().transpose() * (pose_.translation() - about));
  pose_.linear() = rotation;
}

void Motion::begin(Move move, int ticks) {
  move_ = move;
  left_ = ticks;
  // Most steps are such as a hand makes, some are as large as can be.
  step_ = voxel_ * most_step_ * std::pow(10, -random_.uniform(0, random_.below(4) == 0 ? 1 : 4));
  rest_ = pose_;
  switch (move) {
    case Move::kClose: {
      const double out = (pose_.translation() - touch_.translation).dot(touch_.apart);
      velocity_ = (out > 0 ? -step_ : step_) * touch_.apart;
      break;
    }
    case Move::kSlide:
      velocity_ = step_ * across(touch_.apart, random_);
      break;
    case Move::kTurn:
      axis_ = random_.direction();
      break;
    case Move::kRound:
      velocity_ = -velocity_;
      break;
    case Move::kJump:
      jump();
      velocity_ = step_ * random_.direction();
      break;
    default:
      break;
  }
}

Eigen::Isometry3d Motion::next() {
  if (left_-- <= 0) {
    begin(kMoves[random_.below(kMoves.size())], 1 + static_cast<int>(random_.below(40)));
  }
  switch (move_) {
    case Move::kStill:
      break;
    case Move::kTremble:
      pose_ = rest_;
      pose_.translation() += 0.2 * step_ * random_.uniform(0, 1) * random_.direction();
      turn(random_.direction(), 0.2 * step_ * random_.uniform(0, 1));
      break;
    case Move::kClose: {
      pose_.translation() += velocity_;
      const double out = (pose_.translation() - touch_.translation).dot(touch_.apart);
      if (out < -kDeepest * voxel_ || out > kFarthest * voxel_) {
        velocity_ = (out > 0 ? -1 : 1) * velocity_.norm() * touch_.apart;
      }
      break;
    }
    case Move::kTurn:
      turn(axis_, step_);
      break;
    case Move::kWalk:
      pose_.translation() += step_ * random_.uniform(0, 1) * random_.direction();
      turn(random_.direction(), step_ * random_.uniform(0, 1));
      break;
    case Move::kAway: {
      if (left_ > 3) left_ = static_cast<int>(random_.below(4));
      Eigen::Isometry3d away = pose_;
      away.translation() += 10 * radius_ * touch_.apart;
      return away;
    }
    default:
      pose_.translation() += velocity_;
      break;
  }
  // What strayed is brought back.
  if ((pose_.translation() - touch_.translation).norm() > 0.3 * radius_ + 8 * voxel_) jump();
  return pose_;
}

}  // namespace ist::test
