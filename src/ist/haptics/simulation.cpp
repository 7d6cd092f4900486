#include "ist/haptics/simulation.h"

#include <algorithm>
#include <utility>

#include "ist/base/assert.h"
#include "ist/base/float_environment.h"

namespace ist {
namespace {

constexpr double kLeastPart = 1.0 / 64;  // of the longest step

}  // namespace

Simulation::Simulation(Parts parts)
    : contacts_(std::move(parts.contacts)),
      proximity_(std::move(parts.proximity)),
      coupling_(parts.coupling),
      guard_(parts.safety),
      tool_(parts.tool),
      dt_(parts.dt),
      at_(parts.start) {
  IST_ASSERT(dt_ > 0);
  known_.tool = at_;
  for (auto& effect : parts.effects) effects_.push_back({std::move(effect), {}});
}

void Simulation::fault() noexcept {
  guard_.fault();
  device_.reset();
  motion_.reset();
  for (const auto& effect : effects_) effect.effect->reset();
}

// Whether it is known what bears a load, at the tool's pose. What only brakes may be what it was a
// tick ago: where there is no time to look for it, it must not hold the tool.
bool Simulation::ask(const TickBudget& budget, Tick& tick) noexcept {
  const auto complete = [](const std::optional<QueryResult>& result) {
    return !result || (result->status == QueryStatus::kDone && result->complete);
  };
  if (contacts_) tick.contacts = contacts_->ask(at_, budget.contacts, asked_.contacts);
  if (!complete(tick.contacts)) return false;
  if (proximity_) tick.proximity = proximity_->ask(at_, budget.proximity, asked_.proximity);
  if (!complete(tick.proximity)) asked_.proximity = known_.proximity;
  // Last, for nobody acts by it.
  if (contacts_) contacts_->measure_gap(at_, budget.contacts, *tick.contacts);
  if (motion_) {
    const EffectInput input{known_.tool, known_.contacts, known_.proximity, dt_};
    for (Tool::TimedEffect& effect : effects_) effect.advance(input, *motion_);
    dares_ = std::min(1.0, 2 * dares_);
    motion_.reset();
  }
  asked_.tool = at_;
  std::swap(known_, asked_);
  return true;
}

// From where all is known.
std::optional<Vector6> Simulation::move(const VirtualCoupling::Stretch& stretch) noexcept {
  const EffectInput input{known_.tool, known_.contacts, known_.proximity, dt_};
  const std::optional<Vector6> motion = tool_.motion(input, effects_, coupling_, stretch, dares_);
  if (!motion) return motion;
  at_ = at_.moved(*motion);
  motion_ = motion;
  return motion;
}

Tick Simulation::tick(const std::optional<Placement>& device, const TickBudget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  Tick tick{device.value_or(device_.value_or(at_)), at_, Vector6::Zero(), false, false, {}, {}, 0};
  const std::uint64_t faults = guard_.faults();
  tick.held = !ask(budget, tick);
  if (tick.held) {
    at_ = known_.tool;
    motion_.reset();
    dares_ = std::max(kLeastPart, 0.5 * dares_);
  }
  tick.leaf_pairs = known_.contacts.count;

  if (!device) {
    fault();
  } else {
    const VirtualCoupling::Stretch stretch{motion_between(at_, *device),
                                           motion_between(device_.value_or(*device), *device), dt_};
    const std::optional<Vector6> motion = tick.held ? Vector6(Vector6::Zero()) : move(stretch);
    device_ = device;
    if (motion) {
      tick.wrench = guard_.pass(-coupling_.wrench(stretch, *motion), dt_);
    } else {
      fault();
    }
  }
  tick.fault = guard_.faults() != faults;
  tick.tool = at_;
  return tick;
}

}  // namespace ist
