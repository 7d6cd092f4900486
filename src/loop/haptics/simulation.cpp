#include "ist/haptics/simulation.h"

#include <algorithm>
#include <utility>

#include "ist/base/assert.h"
#include "ist/base/float_environment.h"
#include "loop/haptics/coupling.h"
#include "loop/haptics/simulation_parts.h"
#include "loop/haptics/wall/walk.h"
#include "loop/haptics/wrench_limiter.h"

namespace ist {
namespace {

constexpr double kLeastStepScale = 1.0 / 64;

bool is_complete(const std::optional<QueryResult>& result) noexcept {
  return !result || (result->status == QueryStatus::kDone && result->complete);
}

}  // namespace

const char* to_string(ChangeStatus status) noexcept {
  switch (status) {
    case ChangeStatus::kDone:
      return "done";
    case ChangeStatus::kUnknownBody:
      return "unknown-body";
    case ChangeStatus::kFixedForGood:
      return "fixed-for-good";
    case ChangeStatus::kAlreadyThere:
      return "already-there";
    case ChangeStatus::kTouching:
      return "touching";
    case ChangeStatus::kUnfinished:
      return "unfinished";
  }
  return "unknown";
}

void detail::add_two_bodies(SimulationParts& parts, const BodyFrames& frames, double radius,
                            std::unique_ptr<ToolContactQuery> contacts,
                            std::unique_ptr<ToolContactQuery> proximity) {
  const Placement home{Eigen::Matrix3d::Identity(), frames.unit * frames.tool_origin};
  parts.bodies = HandBodies(frames.unit, home,
                            {{"fixed", frames.fixed, Eigen::Vector3d::Zero(), 0},
                             {"held", Placement(), frames.tool_origin, radius, /*held=*/true}});
  if (contacts) parts.contacts.add({0, 1}, std::move(contacts));
  if (proximity) parts.proximity.add({0, 1}, std::move(proximity));
}

struct detail::SimulationState {
  // The contacts at a pose whose queries were complete.
  struct LastComplete {
    Placement tool;
    ToolContacts contacts, proximity;
    double time = 0;  // of bodies with a script, s
  };

  explicit SimulationState(SimulationParts parts);

  [[nodiscard]] bool query_contacts(const TickBudget& budget, Tick& tick) noexcept;
  [[nodiscard]] std::optional<HandChange> next_change(const Budget& budget) noexcept;
  [[nodiscard]] ChangeStatus allowed(std::size_t body, bool attach) const noexcept;
  [[nodiscard]] ChangeStatus change(std::size_t body, bool attach, const Budget& budget) noexcept;
  [[nodiscard]] ChangeStatus change_by_wall(std::size_t body, bool attach,
                                            const Budget& budget) noexcept;
  [[nodiscard]] ChangeStatus change_by_springs(std::size_t body, bool attach,
                                               const Budget& budget) noexcept;
  [[nodiscard]] ChangeStatus change_now(std::size_t body, bool attach,
                                        const TickBudget& budget) noexcept;
  [[nodiscard]] std::optional<Vector6> move(const VirtualCoupling::Stretch& stretch) noexcept;
  void go_back() noexcept;
  void set_time(double time) noexcept;
  void place() noexcept;
  void fault() noexcept;
  [[nodiscard]] EffectInput input() const noexcept {
    return {last_complete.tool, last_complete.contacts, last_complete.proximity, dt};
  }

  void walk(const std::optional<Placement>& to, const TickBudget& budget, Tick& tick) noexcept;
  void press(const std::optional<Placement>& to, const TickBudget& budget, Tick& tick) noexcept;

  HandBodies bodies;
  std::optional<Wall> wall;
  PairQueries contacts, proximity;
  std::vector<PlannedChange> changes;
  std::vector<HandChange> tried;  // those of `changes`; its memory is reserved
  TimedEffects effects;
  VirtualCoupling coupling;
  WrenchLimiter limiter;
  Tool tool;
  double dt;
  std::optional<Walk> walker;  // of the wall
  Placement tool_pose;
  std::optional<Placement> device;  // at the tick before
  LastComplete last_complete, candidate;
  // The tool's motion since last_complete. Effects advance only after the contacts at the new pose
  // are complete; if the tool is moved back they must not have advanced.
  std::optional<Vector6> motion;
  double step_scale = 1;  // fraction of the tool's longest step
  double time = 0;        // of bodies with a script, s
  std::uint64_t ticks = 0;
};

detail::SimulationState::SimulationState(SimulationParts parts)
    : bodies(std::move(parts.bodies)),
      wall(std::move(parts.wall)),
      contacts(std::move(parts.contacts)),
      proximity(std::move(parts.proximity)),
      changes(std::move(parts.changes)),
      effects(std::move(parts.effects)),
      coupling(parts.coupling),
      limiter(parts.safety),
      tool(bodies.held_radius(), parts.max_step),
      dt(parts.dt),
      tool_pose(parts.start),
      last_complete{parts.start, ToolContacts(wall ? wall->pairs() : contacts.size()),
                    ToolContacts(proximity.size())},
      candidate{parts.start, ToolContacts(contacts.size()), ToolContacts(proximity.size())} {
  IST_ASSERT(dt > 0);
  if (wall) walker.emplace(Walk::Parts{bodies, *wall, tool, effects, coupling, dt});
  tried.reserve(changes.size());
  bodies.set_time(0, dt);
  place();
}

void detail::SimulationState::fault() noexcept {
  limiter.fault();
  device.reset();
  motion.reset();
  effects.reset();
}

void detail::SimulationState::place() noexcept {
  contacts.place(bodies);
  proximity.place(bodies);
}

void detail::SimulationState::set_time(double to) noexcept {
  if (!bodies.has_scripts()) return;
  time = to;
  bodies.set_time(time, step_scale * dt);
  place();
}

// Finds the contacts at the tool's pose. Returns whether the load-bearing ones are complete;
// proximity, which only brakes, may be a tick old and must not hold the tool.
bool detail::SimulationState::query_contacts(const TickBudget& budget, Tick& tick) noexcept {
  tick.contacts = contacts.find(bodies, tool_pose, budget.contacts, candidate.contacts);
  if (!is_complete(tick.contacts)) return false;
  tick.proximity = proximity.find(bodies, tool_pose, budget.proximity, candidate.proximity);
  if (!is_complete(tick.proximity)) candidate.proximity = last_complete.proximity;
  if (motion) {
    effects.advance(input(), *motion);
    step_scale = std::min(1.0, 2 * step_scale);
    motion.reset();
  }
  candidate.tool = tool_pose;
  candidate.time = time;
  if (bodies.has_scripts()) {
    set_time(time);  // the step may be longer now
    contacts.note_drift(bodies, tool_pose, candidate.contacts);
    proximity.note_drift(bodies, tool_pose, candidate.proximity);
  }
  std::swap(last_complete, candidate);
  return true;
}

void detail::SimulationState::go_back() noexcept {
  tool_pose = last_complete.tool;
  motion.reset();
  step_scale = std::max(kLeastStepScale, 0.5 * step_scale);
  set_time(last_complete.time);
}

// Whether a body may be attached or released, as to the bodies alone.
ChangeStatus detail::SimulationState::allowed(std::size_t body, bool attach) const noexcept {
  if (body >= bodies.size()) return ChangeStatus::kUnknownBody;
  if (!bodies.is_attachable(body)) return ChangeStatus::kFixedForGood;
  if (bodies.is_held(body) == attach) return ChangeStatus::kAlreadyThere;
  return ChangeStatus::kDone;
}

// Attaches or releases a body where the contacts at the tool's pose are known, and finds those of
// the bodies' new pairs. Where that does not come to an end, or an attached body would touch, all
// is as it was.
ChangeStatus detail::SimulationState::change(std::size_t body, bool attach,
                                             const Budget& budget) noexcept {
  if (const ChangeStatus status = allowed(body, attach); status != ChangeStatus::kDone) {
    return status;
  }
  return wall ? change_by_wall(body, attach, budget) : change_by_springs(body, attach, budget);
}

ChangeStatus detail::SimulationState::change_by_springs(std::size_t body, bool attach,
                                                        const Budget& budget) noexcept {
  if (attach && last_complete.contacts.count > 0) return ChangeStatus::kTouching;
  attach ? bodies.attach(body, tool_pose) : bodies.release(body, tool_pose);
  place();
  const bool known = is_complete(contacts.find(bodies, tool_pose, budget, candidate.contacts));
  const bool touches = attach && candidate.contacts.count > 0;
  if (known && !touches) {
    if (bodies.has_scripts()) contacts.note_drift(bodies, tool_pose, candidate.contacts);
    std::swap(last_complete.contacts, candidate.contacts);
    last_complete.proximity.clear();  // its points are of other pairs; the next tick has new ones
    tool.set_radius(bodies.held_radius());
    return ChangeStatus::kDone;
  }
  bodies.undo(body);
  place();
  return known ? ChangeStatus::kTouching : ChangeStatus::kUnfinished;
}

// An attached body must be out of contact before and after. A released one must not meet a body
// that stays in the hand.
ChangeStatus detail::SimulationState::change_by_wall(std::size_t body, bool attach,
                                                     const Budget& budget) noexcept {
  using Touch = Wall::Touch;
  const auto refused = [](Touch touch) {
    return touch == Touch::kUnknown ? ChangeStatus::kUnfinished : ChangeStatus::kTouching;
  };
  if (attach) {
    for (std::size_t other = 0; other < bodies.size(); ++other) {
      if (other != body && !bodies.is_held(other)) continue;
      const Touch touch = wall->touch(bodies, tool_pose, other, budget);
      if (touch != Touch::kApart) return refused(touch);
    }
  }
  attach ? bodies.attach(body, tool_pose) : bodies.release(body, tool_pose);
  const Touch touch = wall->touch(bodies, tool_pose, body, budget);
  if (touch == Touch::kApart || (touch == Touch::kTouching && !attach)) {
    place();
    last_complete.proximity.clear();
    tool.set_radius(bodies.held_radius());
    return ChangeStatus::kDone;
  }
  bodies.undo(body);
  return refused(touch);
}

// The same between ticks: the tool has moved since its last contacts.
ChangeStatus detail::SimulationState::change_now(std::size_t body, bool attach,
                                                 const TickBudget& budget) noexcept {
  if (const ChangeStatus status = allowed(body, attach); status != ChangeStatus::kDone) {
    return status;
  }
  Tick now;
  if (!wall && !query_contacts(budget, now)) return ChangeStatus::kUnfinished;
  return change(body, attach, budget.change);
}

// Makes the change that is due, one a tick, in a tick whose contacts are known.
std::optional<HandChange> detail::SimulationState::next_change(const Budget& budget) noexcept {
  if (tried.size() == changes.size()) return std::nullopt;
  const PlannedChange& next = changes[tried.size()];
  if (!(static_cast<double>(ticks) * dt >= next.time)) return std::nullopt;
  tried.push_back({next.time, next.body, next.attach, change(next.body, next.attach, budget)});
  return tried.back();
}

// Moves the tool from its last complete pose. Empty if there is no finite motion.
std::optional<Vector6> detail::SimulationState::move(
    const VirtualCoupling::Stretch& stretch) noexcept {
  std::optional<Vector6> found = tool.motion(input(), effects, coupling, stretch, step_scale);
  if (!found) return found;
  tool_pose = tool_pose.moved(*found);
  motion = found;
  set_time(time + step_scale * dt);
  return found;
}

Simulation::Simulation(detail::SimulationParts parts)
    : state_(std::make_unique<detail::SimulationState>(std::move(parts))) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

void Simulation::fault() noexcept { state_->fault(); }

// A tick with a wall: the tool walks to the device.
void detail::SimulationState::walk(const std::optional<Placement>& to, const TickBudget& budget,
                                   Tick& tick) noexcept {
  tick.proximity = proximity.find(bodies, tool_pose, budget.proximity, candidate.proximity);
  if (is_complete(tick.proximity)) std::swap(last_complete.proximity, candidate.proximity);
  tick.change = next_change(budget.change);
  ++ticks;
  if (!to) {
    wall->drop_contacts();
    fault();
    return;
  }
  const VirtualCoupling::Stretch stretch{motion_between(tool_pose, *to),
                                         motion_between(device.value_or(*to), *to), dt};
  const Placement before = tool_pose;
  const Walk::End end =
      walker->run(tool_pose, time,
                  {*to, stretch.device, budget.contacts, budget.steps, last_complete.proximity},
                  last_complete.contacts);
  device = to;
  last_complete.tool = tool_pose;
  if (bodies.has_scripts()) {
    bodies.set_time(time, dt);
    place();
  }
  tick.contacts = end.search;
  tick.contacts->complete = !end.held;
  tick.held = end.held;
  tick.halved = end.halved;
  tick.steps = end.steps;
  if (end.finite) {
    const Vector6 gone = motion_between(before, tool_pose);
    tick.wrench = limiter.limit(-coupling.wrench(stretch, gone), dt);
  } else {
    fault();
  }
  tick.points = wall->contacts();
}

// A tick with springs, or without contacts.
void detail::SimulationState::press(const std::optional<Placement>& to, const TickBudget& budget,
                                    Tick& tick) noexcept {
  tick.held = !query_contacts(budget, tick);
  if (tick.held) {
    go_back();
  } else {
    tick.change = next_change(budget.change);
  }
  ++ticks;
  tick.leaf_pairs = last_complete.contacts.count;
  if (!to) {
    fault();
    return;
  }
  const VirtualCoupling::Stretch stretch{motion_between(tool_pose, *to),
                                         motion_between(device.value_or(*to), *to), dt};
  const std::optional<Vector6> moved = tick.held ? Vector6(Vector6::Zero()) : move(stretch);
  device = to;
  if (moved) {
    tick.wrench = limiter.limit(-coupling.wrench(stretch, *moved), dt);
  } else {
    fault();
  }
}

Tick Simulation::tick(const std::optional<Placement>& device, const TickBudget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  detail::SimulationState& state = *state_;
  Tick tick;
  tick.device = device.value_or(state.device.value_or(state.tool_pose));
  const std::uint64_t faults = state.limiter.faults();
  state.wall ? state.walk(device, budget, tick) : state.press(device, budget, tick);
  tick.fault = state.limiter.faults() != faults;
  tick.tool = state.tool_pose;
  return tick;
}

double Simulation::dt() const noexcept { return state_->dt; }
const Placement& Simulation::tool_pose() const noexcept { return state_->tool_pose; }
std::span<const EffectTime> Simulation::effects() const noexcept { return state_->effects.times(); }
std::size_t Simulation::bytes() const noexcept {
  return state_->contacts.bytes() + state_->proximity.bytes() +
         (state_->wall ? state_->wall->bytes() : 0);
}

ChangeStatus Simulation::attach(std::size_t body, const TickBudget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  return state_->change_now(body, /*attach=*/true, budget);
}
ChangeStatus Simulation::release(std::size_t body, const TickBudget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  return state_->change_now(body, /*attach=*/false, budget);
}

std::span<const HandChange> Simulation::changes() const noexcept { return state_->tried; }
std::size_t Simulation::bodies() const noexcept { return state_->bodies.size(); }
std::string_view Simulation::body_name(std::size_t body) const noexcept {
  return body < bodies() ? std::string_view(state_->bodies.name(body)) : std::string_view();
}
bool Simulation::is_held(std::size_t body) const noexcept {
  return body < bodies() && state_->bodies.is_held(body);
}
Placement Simulation::body_pose(std::size_t body) const noexcept {
  const ScopedFloatEnvironment environment;
  return body < bodies() ? state_->bodies.place(body, state_->tool_pose) : Placement();
}

}  // namespace ist
