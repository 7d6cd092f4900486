#include "loop/haptics/effects/friction_effect.h"

namespace ist {
namespace {

// The relative band about the limit that counts as the limit. Sliding ends with a pull equal to the
// limit, and rounding must not keep a resting tool from sticking. At a stretch of 10 µm and 1 kHz
// the band is 1e-11 m/s wide.
constexpr double kRest = 1e-9;

// The displacements of contact points since the anchor.
class Stretch {
 public:
  // Arms belong to the pose `found`; `now` is the tool's pose.
  Stretch(const Placement& anchor, const Placement& found, const Placement& now) noexcept
      : shift_(now.translation - anchor.translation),
        turn_((now.rotation - anchor.rotation) * found.rotation.transpose()) {}

  // The displacement across the normal, after one more motion.
  [[nodiscard]] Eigen::Vector3d at(const ToolContact& point, const Vector6& motion) const noexcept {
    const Eigen::Vector3d way = shift_ + turn_ * point.arm + point.moved(motion);
    return way - point.normal.dot(way) * point.normal;
  }
  // The sum over all points, by stiffness fraction.
  [[nodiscard]] double sum(std::span<const ToolContact> points,
                           const Vector6& motion) const noexcept {
    double sum = 0;
    for (const ToolContact& point : points)
      sum += point.stiffness_fraction * at(point, motion).norm();
    return sum;
  }

 private:
  Eigen::Vector3d shift_;
  Eigen::Matrix3d turn_;
};

// The anchor after a motion of the fixed body about the tool's origin at `tool`.
Placement carried(const Placement& anchor, const Placement& tool, const Vector6& drift) noexcept {
  if (drift.isZero(0)) return anchor;  // bit by bit, so that it cannot creep
  const Eigen::Matrix3d turn =
      Placement()
          .moved((Vector6() << Eigen::Vector3d::Zero(), drift.tail<3>()).finished())
          .rotation;
  return {turn * anchor.rotation,
          tool.translation + drift.head<3>() + turn * (anchor.translation - tool.translation)};
}

}  // namespace

double FrictionEffect::limit(const Grip& grip, double normal_force) const noexcept {
  return (grip.sliding ? settings_.dynamic_coefficient : settings_.static_coefficient) *
         normal_force;
}

double FrictionEffect::normal_force(std::span<const ToolContact> points,
                                    const Vector6& relative) const noexcept {
  double sum = 0;
  for (const ToolContact& point : points) sum += contact_.force(point, relative);
  return sum;
}

void FrictionEffect::respond(const EffectInput& input, const Vector6& motion,
                             Response& response) const noexcept {
  for (const ContactPair& pair : input.contacts.pairs()) {
    const Grip& grip = grips_[pair.number];
    const std::span<const ToolContact> points = input.contacts.points(pair);
    const Vector6 relative = motion - pair.drift;
    const Stretch stretch(grip.anchor.value_or(input.tool), input.tool, input.tool);
    const double pull = settings_.stiffness * stretch.sum(points, relative);
    const double most = limit(grip, normal_force(points, relative));
    const double part = pull > most ? most / pull : 1;
    for (const ToolContact& point : points) {
      const double stiffness = part * settings_.stiffness * point.stiffness_fraction;
      const Eigen::Matrix3d across =
          Eigen::Matrix3d::Identity() - point.normal * point.normal.transpose();
      response.add(point.arm, -stiffness * stretch.at(point, relative), stiffness * across);
    }
  }
}

void FrictionEffect::advance(const EffectInput& input, const Vector6& motion) noexcept {
  // A pair that was not asked, as its bodies are held both, has lost its grip.
  std::size_t next = 0;
  for (const ContactPair& pair : input.contacts.pairs()) {
    for (; next < pair.number; ++next) grips_[next].lose();
    advance(grips_[next++], input, pair, motion);
  }
  for (; next < grips_.size(); ++next) grips_[next].lose();
}

void FrictionEffect::advance(Grip& grip, const EffectInput& input, const ContactPair& pair,
                             const Vector6& motion) const noexcept {
  const std::span<const ToolContact> points = input.contacts.points(pair);
  const double force = normal_force(points, motion - pair.drift);
  if (!(force > 0)) {
    grip.lose();
    return;
  }
  const Placement tool = input.tool.moved(motion);
  grip.anchor = carried(grip.anchor.value_or(input.tool), input.tool, pair.drift);
  const Stretch stretch(*grip.anchor, input.tool, tool);
  const double pull = settings_.stiffness * stretch.sum(points, Vector6::Zero());
  grip.sliding = pull > (1 + kRest) * limit(grip, force);
  if (grip.sliding) {
    grip.anchor = tool.moved(limit(grip, force) / pull * motion_between(tool, *grip.anchor));
  }
}

void FrictionEffect::reset() noexcept {
  for (Grip& grip : grips_) grip.lose();
}

}  // namespace ist
