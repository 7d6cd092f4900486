#include "ist/haptics/tool.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace ist {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

void Tool::TimedEffect::advance(const EffectInput& input, const Vector6& motion) noexcept {
  const Clock::time_point begin = Clock::now();
  effect->advance(input, motion);
  time += Clock::now() - begin;
}

double Tool::way(const Vector6& motion) const noexcept {
  return std::sqrt(motion.head<3>().squaredNorm()) +
         radius_ * std::sqrt(motion.tail<3>().squaredNorm());
}

std::optional<Vector6> Tool::motion(const EffectInput& input, std::span<TimedEffect> effects,
                                    const VirtualCoupling& coupling,
                                    const VirtualCoupling::Stretch& stretch,
                                    double part) const noexcept {
  const double most = part * max_step_;
  Vector6 motion = Vector6::Zero();
  for (int step = 0; step < kNewtonSteps; ++step) {
    Response response;
    coupling.respond(stretch, motion, response);
    // Steps cost the same, so the first is timed for all: a look at the clock is no less than some
    // effects take.
    Clock::time_point begin = step == 0 ? Clock::now() : Clock::time_point();
    for (TimedEffect& effect : effects) {
      effect.effect->respond(input, motion, response);
      if (step > 0) continue;
      const Clock::time_point end = Clock::now();
      effect.time += kNewtonSteps * (end - begin);
      begin = end;
    }
    if (!response.wrench.allFinite()) return std::nullopt;
    motion += Eigen::LDLT<Matrix6>(response.stiffness).solve(response.wrench);
    const double way = this->way(motion);
    if (!std::isfinite(way)) return std::nullopt;
    if (way > most) motion *= most / way;
  }
  return motion;
}

}  // namespace ist
