#include "loop/haptics/effects/snap_effect.h"

namespace ist {
namespace {

double cube(double x) noexcept { return x * x * x; }

// The secant stiffness of one kind of motion: `own` is its stiffness, `other` the stiffness of the
// other kind in the same unit; s and t are the squares of both distances over their windows.
double pull(double own, double other, double s, double t) noexcept {
  const double narrow = 1 - s, broad = 1 - s * s;
  return own * narrow * narrow * cube(1 - t * t) + 2 * other * s * broad * broad * cube(1 - t);
}

}  // namespace

void SnapEffect::respond(const EffectInput& input, const Vector6& motion,
                         Response& response) const noexcept {
  const auto& [pose, stiffness, angular_stiffness, radius, angle] = settings_;
  const Vector6 way = motion_between(input.tool.moved(motion), pose);
  const double turn = way.tail<3>().squaredNorm();
  const double s = way.head<3>().squaredNorm() / (radius * radius);
  const double t = turn / (angle * angle);
  if (!(s < 1 && t < 1)) return;
  const double ratio = (angle * angle) / (radius * radius);
  const double linear = pull(stiffness, angular_stiffness * ratio, s, t);
  const double angular = pull(angular_stiffness, stiffness / ratio, t, s) * (1 + 0.25 * turn);
  response.wrench.head<3>() += linear * way.head<3>();
  response.wrench.tail<3>() += angular * way.tail<3>();
  response.stiffness.diagonal().head<3>().array() += linear;
  response.stiffness.diagonal().tail<3>().array() += angular;
}

}  // namespace ist
