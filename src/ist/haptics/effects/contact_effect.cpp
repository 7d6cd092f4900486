#include "ist/haptics/effects/contact_effect.h"

#include <algorithm>

namespace ist {

double ContactEffect::force(const TouchPoint& point, const Vector6& motion) const noexcept {
  const double overlap = point.overlap - point.normal.dot(point.moved(motion));
  return settings_.stiffness * point.share * std::max(0.0, overlap);
}

void ContactEffect::respond(const EffectInput& input, const Vector6& motion,
                            Response& response) const noexcept {
  response.wrench += settings_.stiffness * input.contacts.spring;
  for (const TouchPoint& point : input.contacts.points()) {
    const double before = settings_.stiffness * point.share * point.overlap;
    const double after = force(point, kLead * motion);
    const double slope = after > 0 ? kLead * settings_.stiffness * point.share : 0;
    response.add(point.arm, (after - before) * point.normal,
                 slope * (point.normal * point.normal.transpose()));
  }
}

}  // namespace ist
