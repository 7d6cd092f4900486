#include "loop/haptics/effects/springs_effect.h"

#include <algorithm>

namespace ist {

double SpringsEffect::force(const ToolContact& point, const Vector6& motion) const noexcept {
  const double depth = point.depth - point.normal.dot(point.moved(motion));
  return settings_.stiffness * point.stiffness_fraction * std::max(0.0, depth);
}

void SpringsEffect::respond(const EffectInput& input, const Vector6& motion,
                            Response& response) const noexcept {
  response.wrench += settings_.stiffness * input.contacts.spring;
  for (const ContactPair& pair : input.contacts.pairs()) {
    const Vector6 relative = motion - pair.drift;
    for (const ToolContact& point : input.contacts.points(pair)) {
      const double before = settings_.stiffness * point.stiffness_fraction * point.depth;
      const double after = force(point, kLead * relative);
      const double slope = after > 0 ? kLead * settings_.stiffness * point.stiffness_fraction : 0;
      response.add(point.arm, (after - before) * point.normal,
                   slope * (point.normal * point.normal.transpose()));
    }
  }
}

}  // namespace ist
