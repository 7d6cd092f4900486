#include "ist/haptics/effects/friction_effect.h"

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
  [[nodiscard]] double sum(const ToolContacts& contacts, const Vector6& motion) const noexcept {
    double sum = 0;
    for (const ToolContact& point : contacts.points())
      sum += point.stiffness_fraction * at(point, motion).norm();
    return sum;
  }

 private:
  Eigen::Vector3d shift_;
  Eigen::Matrix3d turn_;
};

}  // namespace

double FrictionEffect::limit(double normal_force) const noexcept {
  return (sliding_ ? settings_.dynamic_coefficient : settings_.static_coefficient) * normal_force;
}

double FrictionEffect::normal_force(const ToolContacts& contacts,
                                    const Vector6& motion) const noexcept {
  double sum = 0;
  for (const ToolContact& point : contacts.points()) sum += contact_.force(point, motion);
  return sum;
}

void FrictionEffect::respond(const EffectInput& input, const Vector6& motion,
                             Response& response) const noexcept {
  const Stretch stretch(anchor_.value_or(input.tool), input.tool, input.tool);
  const double pull = settings_.stiffness * stretch.sum(input.contacts, motion);
  const double most = limit(normal_force(input.contacts, motion));
  const double part = pull > most ? most / pull : 1;
  for (const ToolContact& point : input.contacts.points()) {
    const double stiffness = part * settings_.stiffness * point.stiffness_fraction;
    const Eigen::Matrix3d across =
        Eigen::Matrix3d::Identity() - point.normal * point.normal.transpose();
    response.add(point.arm, -stiffness * stretch.at(point, motion), stiffness * across);
  }
}

void FrictionEffect::advance(const EffectInput& input, const Vector6& motion) noexcept {
  const double force = normal_force(input.contacts, motion);
  if (!(force > 0)) return reset();
  const Placement tool = input.tool.moved(motion);
  if (!anchor_) anchor_ = input.tool;
  const Stretch stretch(*anchor_, input.tool, tool);
  const double pull = settings_.stiffness * stretch.sum(input.contacts, Vector6::Zero());
  sliding_ = pull > (1 + kRest) * limit(force);
  if (sliding_) anchor_ = tool.moved(limit(force) / pull * motion_between(tool, *anchor_));
}

void FrictionEffect::reset() noexcept {
  anchor_.reset();
  sliding_ = false;
}

}  // namespace ist
