#include <algorithm>
#include <memory>
#include <variant>

#include "c/follower.h"
#include "c/objects.h"
#include "ist/base/float_environment.h"
#include "ist/capi/ist_servo.h"
#include "ist/haptics/servo_callback.h"
#include "ist/scene.h"

namespace ist::capi {
namespace {

struct Servo : OfHandle<ist_servo, HandleKind::kServo, HandleUse::kAlone> {
  Servo(BuiltScene built, const ServoCallbackOptions& options)
      : scene(std::move(built)), callback(*scene.simulation, options) {}

  BuiltScene scene;
  ServoCallback callback;  // refers to the scene's simulation
};

// The stages that the trees of a body begin at most.
constexpr std::size_t kMostStages = 6;

struct OpenOptions {
  ServoCallbackOptions callback;
  std::uint64_t max_memory = BuildOptions{}.max_memory;
  Follower follower;
};

OpenOptions read_servo_options(Call& call, const ist_servo_options* given) {
  const ist_servo_options known = read_sized(call, "options", given);
  if (known.unit != IST_UNIT_M && known.unit != IST_UNIT_MM) {
    call.fail(IST_ARGUMENT_INVALID,
              "options->unit is {}: pass IST_UNIT_M or IST_UNIT_MM, the unit of the poses",
              known.unit);
  }
  if (known.reserved != 0) {
    call.fail(IST_ARGUMENT_INVALID, "options->reserved is {}: set it to 0", known.reserved);
  }
  if (!(known.query_time_fraction >= 0 && known.query_time_fraction <= 1)) {
    call.fail(IST_ARGUMENT_INVALID,
              "options->query_time_fraction is {}: pass a fraction of a tick, from 0 to 1",
              known.query_time_fraction);
  }
  OpenOptions options;
  options.callback.unit = known.unit == IST_UNIT_MM ? 0.001 : 1;
  if (known.query_time_fraction > 0) {
    options.callback.query_time_fraction = known.query_time_fraction;
  }
  if (known.sphere_tests > 0) options.callback.sphere_tests = known.sphere_tests;
  if (known.max_memory > 0) options.max_memory = known.max_memory;
  options.follower = read_follower(call, known.progress);
  return options;
}

// Replaces the scene's device by the caller, and keeps only the mechanics of the scene's device.
void replace_device(Scene& scene) {
  const auto mechanics_of = [](const auto& settings) { return settings.mechanics; };
  scene.device = NullSettings{std::visit(mechanics_of, scene.device)};
}

ist_servo_info servo_info_of(const Servo& servo) {
  ist_servo_info info{};
  info.tick_seconds = servo.scene.simulation->dt();
  const ServoCallback::Pose tool = servo.callback.tool();
  std::copy(tool.begin(), tool.end(), info.tool);
  const ServoCallback::Counts& counts = servo.callback.counts();
  info.ticks = counts.ticks;
  info.held = counts.held;
  info.faults = counts.faults;
  info.late = counts.late;
  info.bodies = servo.scene.simulation->bodies();
  return info;
}

// Converts metres to the poses' unit.
void copy_point(const std::array<double, 3>& from, double unit, double (&to)[3]) {
  for (std::size_t i = 0; i < 3; ++i) to[i] = from[i] / unit;
}

void copy_pose(const ist::TickRecord::Pose& from, double unit, double (&to)[16]) {
  for (std::size_t i = 0; i < 3; ++i) {
    std::copy_n(from.data() + 3 + 3 * i, 3, to + 4 * i);
    to[12 + i] = from[i] / unit;
  }
  to[15] = 1;
}

ist_servo_contact servo_contact_of(const ist::ContactRecord& point, double unit) {
  ist_servo_contact contact{};
  copy_point(point.position, unit, contact.position);
  std::copy_n(point.normal.data(), 3, contact.normal);
  std::copy_n(point.force.data(), 3, contact.force);
  contact.gap = point.gap / unit;
  contact.fixed_triangle = point.fixed_triangle;
  contact.held_triangle = point.held_triangle;
  contact.fixed = point.fixed;
  contact.held = point.held;
  return contact;
}

ist_servo_state servo_state_of(const ist::TickRecord& tick, double unit) {
  ist_servo_state state{};
  state.known = 1;
  state.device_known = tick.device_known ? 1 : 0;
  state.tick = tick.tick;
  copy_pose(tick.device, unit, state.device);
  copy_pose(tick.tool, unit, state.tool);
  std::copy_n(tick.wrench.data(), 3, state.force);
  std::copy_n(tick.wrench.data() + 3, 3, state.torque);
  state.fault = tick.fault ? 1 : 0;
  state.held = tick.held ? 1 : 0;
  state.halved = tick.halved ? 1 : 0;
  state.steps = tick.steps;
  state.begin_ns = tick.begin_ns;
  state.execution_ns = tick.execution_ns;
  static_assert(ist::Tick::kMostPoints == IST_MOST_SERVO_CONTACTS);
  state.contact_count = tick.point_count;
  for (std::size_t i = 0; i < tick.point_count; ++i) {
    state.contacts[i] = servo_contact_of(tick.points[i], unit);
  }
  return state;
}

void refuse_change(Call& call, const char* body, ist::ChangeStatus status) {
  switch (status) {
    case ist::ChangeStatus::kDone:
      return;
    case ist::ChangeStatus::kUnknownBody:
      return call.fail(IST_ARGUMENT_INVALID, "there is no body called {}: pass a name of the scene",
                       body);
    case ist::ChangeStatus::kFixedForGood:
      return call.fail(IST_CHANGE_REFUSED,
                       "{} stays where it is: write attachable = true in its table of the scene, "
                       "which follows no script",
                       body);
    case ist::ChangeStatus::kAlreadyThere:
      return call.fail(IST_CHANGE_REFUSED,
                       "{} is there already: attach fixed bodies, release held ones", body);
    case ist::ChangeStatus::kTouching:
      return call.fail(IST_CHANGE_REFUSED,
                       "something touches {}, or a body in the hand: move them apart first", body);
    case ist::ChangeStatus::kUnfinished:
      return call.fail(IST_CHANGE_REFUSED,
                       "the time or the tests of a tick did not suffice for {}: try again, or give "
                       "the options of the servo more",
                       body);
  }
  call.fail(IST_INTERNAL_ERROR, "a status without a message");
}

using Change = ist::ChangeStatus (ServoCallback::*)(std::size_t) noexcept;

ist_status change_servo(const char* function, ist_servo* servo, const char* body, Change change) {
  return guarded(function, [&](Call& call) {
    const Held<Servo> held(call, "servo", servo);
    if (!held) return;
    if (!call.need("body", body)) return;
    const Simulation& simulation = *held->scene.simulation;
    std::size_t number = 0;
    while (number < simulation.bodies() && simulation.body_name(number) != body) ++number;
    refuse_change(call, body, (held->callback.*change)(number));
  });
}

}  // namespace
}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_servo_open_scene(const char* path, const ist_servo_options* options,
                                ist_servo** servo) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.clear("servo", servo);
    call.need("path", path);
    call.need("options", options);
    const OpenOptions asked = read_servo_options(call, options);
    if (call.status() != IST_OK) return;
    ist::Scene scene = ist::read_scene(path);
    replace_device(scene);
    ist::Progress progress;
    std::unique_ptr<Servo> made;
    const auto stages =
        static_cast<unsigned>(kMostStages * (scene.fixed.size() + scene.held.size()));
    const bool whole = followed(asked.follower, progress, stages, [&] {
      made = std::make_unique<Servo>(ist::build_scene(scene, {}, asked.max_memory, &progress),
                                     asked.callback);
    });
    whole ? give(call, std::move(made), servo) : cancelled(call);
  });
}

const char* ist_servo_warning(ist_servo* servo, size_t index) IST_NOEXCEPT {
  const char* text = nullptr;
  static_cast<void>(guarded(__func__, [&](Call& call) {
    const Held<Servo> held(call, "servo", servo);
    if (!held) return;
    const std::vector<std::string>& warnings = held->scene.warnings;
    if (index < warnings.size()) text = warnings[index].c_str();
  }));
  return text;
}

ist_status ist_servo_get_info(ist_servo* servo, ist_servo_info* info) IST_NOEXCEPT {
  return get_info<Servo>(__func__, servo, info, servo_info_of);
}

ist_status ist_servo_on_tick(ist_servo* servo, const double pose[16], double force[3],
                             double torque[3]) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    if (force != nullptr) std::fill_n(force, 3, 0.0);
    if (torque != nullptr) std::fill_n(torque, 3, 0.0);
    const Held<Servo> held(call, "servo", servo);
    if (!held) return;
    call.need("pose", pose);
    call.need("force", force);
    call.need("torque", torque);
    if (call.status() != IST_OK) return held->callback.fault();
    const ist::ServoTick tick =
        held->callback.on_tick(std::span<const double, 16>(pose, 16),
                               std::span<double, 3>(force, 3), std::span<double, 3>(torque, 3));
    if (tick != ist::ServoTick::kFault) return;
    if (!ist::Placement::from(to_isometry(pose))) {
      answered(call, ist::QueryStatus::kInvalidPose, pose);
    }
    call.fail(IST_SERVO_FAULT,
              "a force was not a number: the output is zero, and forces return gradually; "
              "report the scene if this repeats");
  });
}

ist_status ist_servo_get_state(ist_servo* servo, ist_servo_state* state) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "state", state);
    // Shared: the loop may be in a tick.
    const Held<const Servo, HandleUse::kShared> held(call, "servo", servo);
    if (!held) return;
    const ist::ScopedFloatEnvironment environment;
    const std::optional<ist::TickRecord> tick = held->callback.last();
    if (tick) write_sized(servo_state_of(*tick, held->callback.unit()), *state);
  });
}

ist_status ist_servo_get_body(ist_servo* servo, size_t index, ist_servo_body* body) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "body", body);
    const Held<Servo> held(call, "servo", servo);
    if (!held) return;
    const ist::Simulation& simulation = *held->scene.simulation;
    if (index >= simulation.bodies()) {
      return call.fail(IST_ARGUMENT_INVALID, "index is {}, and the scene has {} bodies", index,
                       simulation.bodies());
    }
    const ist::ScopedFloatEnvironment environment;
    ist_servo_body found{};
    found.name = simulation.body_name(index).data();
    found.held = simulation.is_held(index) ? 1 : 0;
    Eigen::Isometry3d pose = simulation.body_pose(index).isometry();
    pose.translation() /= held->callback.unit();
    std::copy_n(pose.data(), 16, found.pose);
    write_sized(found, *body);
  });
}

ist_status ist_servo_attach(ist_servo* servo, const char* body) IST_NOEXCEPT {
  return change_servo(__func__, servo, body, &ist::ServoCallback::attach);
}

ist_status ist_servo_release(ist_servo* servo, const char* body) IST_NOEXCEPT {
  return change_servo(__func__, servo, body, &ist::ServoCallback::release);
}

ist_status ist_servo_free(ist_servo* servo) IST_NOEXCEPT {
  return give_back<Servo>(__func__, servo);
}
