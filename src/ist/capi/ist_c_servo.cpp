#include <algorithm>
#include <variant>

#include "ist/capi/ask.h"
#include "ist/capi/handle.h"
#include "ist/capi/ist_servo.h"
#include "ist/capi/objects.h"
#include "ist/capi/sized_struct.h"
#include "ist/haptics/servo_callback.h"
#include "ist/scene/scene_builder.h"
#include "ist/scene/scene_file.h"

namespace ist::capi {
namespace {

struct Servo {
  using Handle = ist_servo;
  static constexpr HandleKind kKind = HandleKind::kServo;
  static constexpr HandleUse kUse = HandleUse::kAlone;
  static constexpr const char* kName = "servo";

  Servo(BuiltScene built, const ServoCallbackOptions& options)
      : scene(std::move(built)), callback(*scene.simulation, options) {}

  BuiltScene scene;
  ServoCallback callback;  // turns the scene's simulation
};

struct OpenOptions {
  ServoCallbackOptions callback;
  std::uint64_t max_memory = BuildOptions{}.max_memory;
};

ist_status read_servo_options(const Call& call, const ist_servo_options& given,
                              OpenOptions& options) {
  ist_servo_options known;
  if (const ist_status wrong = read_sized(call, "options", given, known)) return wrong;
  if (known.unit != IST_UNIT_M && known.unit != IST_UNIT_MM) {
    return call.fail(IST_ARGUMENT_INVALID,
                     "options->unit is {}: say IST_UNIT_M or IST_UNIT_MM, as the poses are",
                     known.unit);
  }
  if (known.reserved != 0) {
    return call.fail(IST_ARGUMENT_INVALID, "options->reserved is {}: set it to 0", known.reserved);
  }
  if (!(known.query_share >= 0 && known.query_share <= 1)) {
    return call.fail(IST_ARGUMENT_INVALID,
                     "options->query_share is {}: take a part of a tick, up to 1",
                     known.query_share);
  }
  options.callback.unit = known.unit == IST_UNIT_MM ? 0.001 : 1;
  if (known.query_share > 0) options.callback.query_share = known.query_share;
  if (known.sphere_tests > 0) options.callback.sphere_tests = known.sphere_tests;
  if (known.max_memory > 0) options.max_memory = known.max_memory;
  return IST_OK;
}

// The caller is the device: the file's tells its mechanics alone.
void replace_device(Scene& scene) {
  struct Mechanics {
    DeviceMechanics operator()(const NullSettings& null) const { return null.mechanics; }
    DeviceMechanics operator()(const ScriptSettings& script) const { return script.mechanics; }
    DeviceMechanics operator()(const HandSettings& hand) const { return hand.mechanics; }
  };
  scene.device = NullSettings{std::visit(Mechanics(), scene.device)};
}

ist_servo_info info_of(const Servo& servo) {
  ist_servo_info info{};
  info.tick_seconds = servo.scene.simulation->dt();
  const ServoCallback::Pose tool = servo.callback.tool();
  std::copy(tool.begin(), tool.end(), info.tool);
  const ServoCallback::Counts& counts = servo.callback.counts();
  info.ticks = counts.ticks;
  info.held = counts.held;
  info.faults = counts.faults;
  info.late = counts.late;
  return info;
}

}  // namespace
}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_servo_open_scene(const char* path, const ist_servo_options* options,
                                ist_servo** servo) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status missing = call.need({{"servo", servo}})) return missing;
    *servo = nullptr;
    if (const ist_status missing = call.need({{"path", path}, {"options", options}})) {
      return missing;
    }
    OpenOptions asked;
    if (const ist_status wrong = read_servo_options(call, *options, asked)) return wrong;
    ist::Scene scene = ist::read_scene(path);
    replace_device(scene);
    return give(
        call,
        std::make_unique<Servo>(ist::build_scene(scene, nullptr, asked.max_memory), asked.callback),
        servo);
  });
}

const char* ist_servo_warning(ist_servo* servo, size_t index) IST_NOEXCEPT {
  const char* text = nullptr;
  static_cast<void>(guarded(__func__, [&](const Call& call) -> ist_status {
    const Held<Servo> held(call, "servo", servo);
    if (held.status() != IST_OK) return held.status();
    const std::vector<std::string>& warnings = held->scene.warnings;
    if (index < warnings.size()) text = warnings[index].c_str();
    return IST_OK;
  }));
  return text;
}

ist_status ist_servo_get_info(ist_servo* servo, ist_servo_info* info) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status wrong = clear_sized(call, "info", info)) return wrong;
    const Held<Servo> held(call, "servo", servo);
    if (held.status() != IST_OK) return held.status();
    write_sized(info_of(*held), *info);
    return IST_OK;
  });
}

ist_status ist_servo_on_tick(ist_servo* servo, const double pose[16], double force[3],
                             double torque[3]) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (force != nullptr) std::fill_n(force, 3, 0.0);
    if (torque != nullptr) std::fill_n(torque, 3, 0.0);
    const Held<Servo> held(call, "servo", servo);
    if (held.status() != IST_OK) return held.status();
    if (const auto missing = call.need({{"pose", pose}, {"force", force}, {"torque", torque}})) {
      held->callback.fault();
      return missing;
    }
    const ist::ServoTick tick =
        held->callback.on_tick(std::span<const double, 16>(pose, 16),
                               std::span<double, 3>(force, 3), std::span<double, 3>(torque, 3));
    if (tick != ist::ServoTick::kFault) return IST_OK;
    if (!ist::Placement::from(to_isometry(pose))) {
      return status_of(call, ist::QueryStatus::kInvalidPose);
    }
    return call.fail(IST_SERVO_FAULT,
                     "forces that are no numbers: nothing is felt, and they come back softly");
  });
}

ist_status ist_servo_free(ist_servo* servo) IST_NOEXCEPT {
  return give_back<Servo>(__func__, servo);
}
