#include <fmt/format.h>

#include "ist/haptics/devices/script_device.h"
#include "ist/scene/ranges.h"
#include "ist/scene/scene_parts.h"

namespace ist {
namespace {

enum class DeviceKind { kHand, kScript, kNull };

std::optional<DeviceKind> device_kind(std::string_view name) {
  if (name == "hand") return DeviceKind::kHand;
  if (name == "script") return DeviceKind::kScript;
  if (name == "null") return DeviceKind::kNull;
  return std::nullopt;
}

std::vector<Waypoint> read_plan(TableReader& device, double unit) {
  std::vector<Waypoint> plan;
  for (TableReader& item : device.tables("plan")) {
    const Waypoint waypoint{item.number("time", kInstant),
                            {item.rotation("turn"), unit * item.vector("move", kPlace)}};
    const std::string flaw = waypoint_flaw(plan.empty() ? nullptr : &plan.back(), waypoint);
    if (!flaw.empty()) item.fail("time", item.name(), flaw);
    plan.push_back(waypoint);
  }
  return plan;
}

// Where nothing is said: an arm that holds a stylus lightly. With the device's own damping it
// swings at 8 Hz, damped to 0.6 of what is critical; its turn at 11 Hz, to 0.8.
HandSettings read_hand(TableReader& device, const DeviceMechanics& mechanics, double unit) {
  HandSettings hand{};
  hand.mechanics = mechanics;
  hand.mass = device.number("mass", kMass, 0.2);
  hand.inertia = device.number("inertia", kInertia, 2e-4);
  hand.arm_stiffness = device.number("arm_stiffness", kStiffness, 500);
  hand.arm_damping = device.number("arm_damping", kDamping, 10);
  hand.arm_angular_stiffness = device.number("arm_angular_stiffness", kAngularStiffness, 1);
  hand.arm_angular_damping = device.number("arm_angular_damping", kAngularDamping, 0.02);
  hand.resolution = unit * device.number("resolution", kResolution, 0);
  hand.angular_resolution = device.number("angular_resolution", kAngularResolution, 0);
  hand.plan = read_plan(device, unit);
  return hand;
}

ScriptSettings read_plan_file(TableReader& device, const DeviceMechanics& mechanics, double unit) {
  const std::filesystem::path file = read_path(device, "path");
  return {mechanics, file, read_script(file, unit)};
}

}  // namespace

void read_device(TableReader& scene, Scene& result) {
  TableReader device = scene.table("device");
  const DeviceKind kind = device.choice("kind", device_kind, R"("hand", "script" or "null")");
  const DeviceMechanics mechanics{
      .damping = device.number("damping", kDamping, 2),
      .angular_damping = device.number("angular_damping", kAngularDamping, 2e-3),
      .delay = device.number("delay", kDelay, 0)};
  switch (kind) {
    case DeviceKind::kHand:
      result.device = read_hand(device, mechanics, result.unit);
      break;
    case DeviceKind::kScript:
      result.device = read_plan_file(device, mechanics, result.unit);
      break;
    case DeviceKind::kNull:
      result.device = NullSettings{mechanics};
      break;
  }
}

}  // namespace ist
