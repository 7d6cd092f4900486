#include "loop/haptics/tool.h"

#include <Eigen/Cholesky>
#include <chrono>
#include <cmath>
#include <utility>

#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

TimedEffects::TimedEffects(std::vector<std::unique_ptr<Effect>> effects)
    : effects_(std::move(effects)) {
  for (const auto& effect : effects_) times_.push_back({effect->name(), {}});
}

void TimedEffects::respond(const EffectInput& input, const Vector6& motion, Response& response,
                           int calls) noexcept {
  Clock::time_point begin = Clock::now();
  for (std::size_t i = 0; i < effects_.size(); ++i) {
    effects_[i]->respond(input, motion, response);
    const Clock::time_point end = Clock::now();
    times_[i].time += calls * (end - begin);
    begin = end;
  }
}

void TimedEffects::respond(const EffectInput& input, const Vector6& motion,
                           Response& response) const noexcept {
  for (const auto& effect : effects_) effect->respond(input, motion, response);
}

void TimedEffects::advance(const EffectInput& input, const Vector6& motion) noexcept {
  for (std::size_t i = 0; i < effects_.size(); ++i) {
    const Clock::time_point begin = Clock::now();
    effects_[i]->advance(input, motion);
    times_[i].time += Clock::now() - begin;
  }
}

void TimedEffects::reset() noexcept {
  for (const auto& effect : effects_) effect->reset();
}

double Tool::way(const Vector6& motion) const noexcept {
  return std::sqrt(motion.head<3>().squaredNorm()) +
         radius_ * std::sqrt(motion.tail<3>().squaredNorm());
}

namespace {

// Makes the Newton steps of a motion. `next(stiffness, wanted)` returns the motion to take in place
// of the wanted one.
template <class Next>
std::optional<Vector6> balance(const EffectInput& input, TimedEffects& effects,
                               const VirtualCoupling& coupling,
                               const VirtualCoupling::Stretch& stretch, const Next& next) noexcept {
  Vector6 motion = Vector6::Zero();
  for (int step = 0; step < Tool::kNewtonSteps; ++step) {
    Response response;
    coupling.respond(stretch, motion, response);
    // Steps cost the same, so the first one is timed for all: reading the clock takes as long as
    // some effects do.
    if (step == 0) {
      effects.respond(input, motion, response, Tool::kNewtonSteps);
    } else {
      effects.respond(input, motion, response);
    }
    if (!response.wrench.allFinite()) return std::nullopt;
    motion += Eigen::LDLT<Matrix6>(response.stiffness).solve(response.wrench);
    if (!std::isfinite(motion.squaredNorm())) return std::nullopt;
    motion = next(response.stiffness, motion);
  }
  return motion;
}

}  // namespace

std::optional<Vector6> Tool::motion(const EffectInput& input, TimedEffects& effects,
                                    const VirtualCoupling& coupling,
                                    const VirtualCoupling::Stretch& stretch,
                                    double scale) const noexcept {
  const double most = scale * max_step_;
  return balance(input, effects, coupling, stretch, [&](const Matrix6&, const Vector6& wanted) {
    const double way = this->way(wanted);
    return way > most ? Vector6(wanted * (most / way)) : wanted;
  });
}

std::optional<Vector6> Tool::motion(const EffectInput& input, TimedEffects& effects,
                                    const VirtualCoupling& coupling,
                                    const VirtualCoupling::Stretch& stretch, NearestMotion* bounds,
                                    double tolerance) const noexcept {
  // Coupling and effects that are linear ask for the same motion in each step.
  constexpr double kSame = 1e-24;
  std::optional<Vector6> last;
  return balance(input, effects, coupling, stretch,
                 [&](const Matrix6& stiffness, const Vector6& wanted) -> Vector6 {
                   if (bounds == nullptr) return wanted;
                   const bool same =
                       last && (wanted - *last).squaredNorm() <= kSame * last->squaredNorm();
                   if (!same) bounds->solve(stiffness, wanted, tolerance);
                   last = wanted;
                   return bounds->motion();
                 });
}

double surface_radius(const SphereTree& tree) noexcept {
  // The cubes of the leaves' parents hold the surface. The last node of a level is a sentinel.
  double farthest2 = 0;
  const std::span<const OctreeNode> nodes = voxels_of(tree).octree.nodes(1);
  for (const OctreeNode& node : nodes.first(nodes.size() - 1)) {
    const double x = node.centre[0], y = node.centre[1], z = node.centre[2];
    farthest2 = std::max(farthest2, (x * x + y * y) + z * z);
  }
  // Half the diagonal of a parent's cube, and a margin for rounding.
  return tree.voxel_size() * (std::sqrt(farthest2) + std::sqrt(3.0)) * (1 + 1e-9);
}

}  // namespace ist
