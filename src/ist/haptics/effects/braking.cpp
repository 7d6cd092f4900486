#include "ist/haptics/effects/braking.h"

namespace ist {

void brake(const TouchSet& places, double damping, double dt, const Vector6& motion,
           Response& response) noexcept {
  for (const TouchPoint& place : places.points()) {
    const double approach = -place.normal.dot(place.moved(motion));
    if (!(approach > 0)) continue;
    const double slope = damping * place.share / dt;
    response.add(place.arm, slope * approach * place.normal,
                 slope * (place.normal * place.normal.transpose()));
  }
}

}  // namespace ist
