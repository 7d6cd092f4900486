#include "ist/haptics/simulation.h"

#include <algorithm>
#include <utility>

#include "ist/base/assert.h"
#include "ist/base/float_environment.h"
#include "ist/haptics/coupling.h"
#include "ist/haptics/simulation_parts.h"
#include "ist/haptics/wrench_limiter.h"

namespace ist {
namespace {

constexpr double kLeastStepScale = 1.0 / 64;

bool is_complete(const std::optional<QueryResult>& result) noexcept {
  return !result || (result->status == QueryStatus::kDone && result->complete);
}

}  // namespace

struct detail::SimulationState {
  // The contacts at a pose whose queries were complete.
  struct LastComplete {
    Placement tool;
    ToolContacts contacts, proximity;
  };

  explicit SimulationState(SimulationParts parts);

  [[nodiscard]] bool query_contacts(const TickBudget& budget, Tick& tick) noexcept;
  [[nodiscard]] std::optional<Vector6> move(const VirtualCoupling::Stretch& stretch) noexcept;
  void fault() noexcept;
  [[nodiscard]] EffectInput input() const noexcept {
    return {last_complete.tool, last_complete.contacts, last_complete.proximity, dt};
  }

  std::unique_ptr<ToolContactQuery> contacts, proximity;
  TimedEffects effects;
  VirtualCoupling coupling;
  WrenchLimiter limiter;
  Tool tool;
  double dt;
  Placement tool_pose;
  std::optional<Placement> device;  // at the tick before
  LastComplete last_complete, candidate;
  // The tool's motion since last_complete. Effects advance only after the contacts at the new pose
  // are complete; if the tool is moved back they must not have advanced.
  std::optional<Vector6> motion;
  double step_scale = 1;  // fraction of the tool's longest step
};

detail::SimulationState::SimulationState(SimulationParts parts)
    : contacts(std::move(parts.contacts)),
      proximity(std::move(parts.proximity)),
      effects(std::move(parts.effects)),
      coupling(parts.coupling),
      limiter(parts.safety),
      tool(parts.tool),
      dt(parts.dt),
      tool_pose(parts.start) {
  IST_ASSERT(dt > 0);
  last_complete.tool = tool_pose;
}

void detail::SimulationState::fault() noexcept {
  limiter.fault();
  device.reset();
  motion.reset();
  effects.reset();
}

// Finds the contacts at the tool's pose. Returns whether the load-bearing ones are complete;
// proximity, which only brakes, may be a tick old and must not hold the tool.
bool detail::SimulationState::query_contacts(const TickBudget& budget, Tick& tick) noexcept {
  if (contacts) tick.contacts = contacts->find(tool_pose, budget.contacts, candidate.contacts);
  if (!is_complete(tick.contacts)) return false;
  if (proximity) tick.proximity = proximity->find(tool_pose, budget.proximity, candidate.proximity);
  if (!is_complete(tick.proximity)) candidate.proximity = last_complete.proximity;
  if (motion) {
    effects.advance(input(), *motion);
    step_scale = std::min(1.0, 2 * step_scale);
    motion.reset();
  }
  candidate.tool = tool_pose;
  std::swap(last_complete, candidate);
  return true;
}

// Moves the tool from its last complete pose. Empty if there is no finite motion.
std::optional<Vector6> detail::SimulationState::move(
    const VirtualCoupling::Stretch& stretch) noexcept {
  const std::optional<Vector6> found = tool.motion(input(), effects, coupling, stretch, step_scale);
  if (!found) return found;
  tool_pose = tool_pose.moved(*found);
  motion = found;
  return found;
}

Simulation::Simulation(detail::SimulationParts parts)
    : state_(std::make_unique<detail::SimulationState>(std::move(parts))) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

void Simulation::fault() noexcept { state_->fault(); }

Tick Simulation::tick(const std::optional<Placement>& device, const TickBudget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  detail::SimulationState& state = *state_;
  Tick tick;
  tick.device = device.value_or(state.device.value_or(state.tool_pose));
  const std::uint64_t faults = state.limiter.faults();
  tick.held = !state.query_contacts(budget, tick);
  if (tick.held) {
    state.tool_pose = state.last_complete.tool;
    state.motion.reset();
    state.step_scale = std::max(kLeastStepScale, 0.5 * state.step_scale);
  }
  tick.leaf_pairs = state.last_complete.contacts.count;

  if (!device) {
    state.fault();
  } else {
    const VirtualCoupling::Stretch stretch{motion_between(state.tool_pose, *device),
                                           motion_between(state.device.value_or(*device), *device),
                                           state.dt};
    const std::optional<Vector6> motion =
        tick.held ? Vector6(Vector6::Zero()) : state.move(stretch);
    state.device = device;
    if (motion) {
      tick.wrench = state.limiter.limit(-state.coupling.wrench(stretch, *motion), state.dt);
    } else {
      state.fault();
    }
  }
  tick.fault = state.limiter.faults() != faults;
  tick.tool = state.tool_pose;
  return tick;
}

double Simulation::dt() const noexcept { return state_->dt; }
const Placement& Simulation::tool_pose() const noexcept { return state_->tool_pose; }
std::span<const EffectTime> Simulation::effects() const noexcept { return state_->effects.times(); }
std::size_t Simulation::bytes() const noexcept {
  return (state_->contacts ? state_->contacts->bytes() : 0) +
         (state_->proximity ? state_->proximity->bytes() : 0);
}

}  // namespace ist
