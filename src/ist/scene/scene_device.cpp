#include <fmt/format.h>

#include "ist/haptics/devices/plan.h"
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

HandSettings read_hand(TableReader& device, const DeviceMechanics& mechanics, double unit) {
  HandSettings hand;
  hand.mechanics = mechanics;
  hand.mass = device.number("mass", kMass, hand.mass);
  hand.inertia = device.number("inertia", kInertia, hand.inertia);
  hand.arm_stiffness = device.number("arm_stiffness", kStiffness, hand.arm_stiffness);
  hand.arm_damping = device.number("arm_damping", kDamping, hand.arm_damping);
  hand.arm_angular_stiffness =
      device.number("arm_angular_stiffness", kAngularStiffness, hand.arm_angular_stiffness);
  hand.arm_angular_damping =
      device.number("arm_angular_damping", kAngularDamping, hand.arm_angular_damping);
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
  const DeviceMechanics mechanics = read_numbers(device, kMechanicsKeys, HandSettings().mechanics);
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
