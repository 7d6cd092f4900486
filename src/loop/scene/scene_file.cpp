#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ist/base/float_environment.h"
#include "loop/haptics/devices/plan.h"
#include "loop/scene/ranges.h"
#include "loop/scene/scene_lines.h"
#include "loop/scene/scene_parts.h"

namespace ist {
namespace {

ContactSettings read_contact(TableReader contact) {
  for (const char* key : {"stiffness", "margin"}) {
    contact.refuse_old(key, "belongs to [effects.springs]",
                       "write that table in place of this one, or take the key out: contact bears "
                       "any force");
  }
  ContactSettings settings = read_numbers(contact, kContactKeys);
  settings.steps = static_cast<int>(
      contact.whole_number("steps", kSteps, static_cast<std::uint64_t>(settings.steps)));
  return settings;
}

SpringsSettings read_springs(TableReader springs, double unit) {
  SpringsSettings settings;
  settings.stiffness = springs.number("stiffness", kStiffness, settings.stiffness);
  settings.margin = unit * springs.number("margin", kLengthOrNone, 0);
  settings.full_area = unit * unit * springs.number("full_area", kArea, 0);
  settings.allow_breaking = springs.flag("allow_breaking", settings.allow_breaking);
  return settings;
}

FrictionSettings read_friction(TableReader friction) {
  for (const char* key : {"static", "dynamic", "stiffness"}) {
    friction.refuse_old(key, "is no key any more",
                        "give 'coefficient', the one ratio at which a contact slides");
  }
  return read_numbers(friction, kFrictionKeys);
}

SceneGravity read_gravity(TableReader gravity) {
  SceneGravity settings;
  settings.mass = gravity.number("mass", kMass);
  if (gravity.has("centre")) settings.centre = gravity.vector("centre", kPlace);
  settings.acceleration = gravity.vector("acceleration", kAcceleration, settings.acceleration);
  return settings;
}

SnapSettings read_snap(TableReader snap, double unit) {
  SnapSettings settings = read_numbers(snap, kSnapKeys);
  settings.pose.rotation = snap.rotation("turn");
  settings.pose.translation = unit * snap.vector("move", kPlace, Eigen::Vector3d::Zero());
  settings.radius = unit * snap.number("radius", kLength);
  return settings;
}

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
  hand.resolution = unit * device.number("resolution", kLengthOrNone, 0);
  hand.angular_resolution = device.number("angular_resolution", kAngularResolution, 0);
  hand.plan = read_plan(device, unit);
  return hand;
}

ScriptSettings read_plan_file(TableReader& device, const DeviceMechanics& mechanics, double unit) {
  const std::filesystem::path file = read_path(device, "path");
  return {mechanics, file, read_script(file, unit)};
}

// Adds a table that is always on, so that its defaults are read in one place.
void open_if_missing(TomlTable& document, std::string_view key) {
  const bool is_there = std::any_of(document.entries.begin(), document.entries.end(),
                                    [key](const TomlEntry& each) { return each.key == key; });
  if (!is_there) document.entries.push_back({std::string(key), {document.line, TomlTable{}}});
}

// A spring beyond the safety limit would be cut off.
void refuse_beyond(const TableReader& coupling, std::string_view key, double limit, double safe,
                   const NumberRange& range) {
  if (limit <= safe) return;
  coupling.fail(key,
                fmt::format("'{}' in [coupling] is {} {}, more than the {} that [safety] lets "
                            "through",
                            key, limit, range.unit, safe),
                fmt::format("lower it, or raise '{}' in [safety]", key));
}

CouplingSettings read_coupling(const TableReader& coupling, const SafetySettings& safety) {
  CouplingSettings usual;
  usual.max_force = std::min(usual.max_force, safety.max_force);
  usual.max_torque = std::min(usual.max_torque, safety.max_torque);
  const CouplingSettings read = read_numbers(coupling, kCouplingKeys, usual);
  refuse_beyond(coupling, "max_force", read.max_force, safety.max_force, kForce);
  refuse_beyond(coupling, "max_torque", read.max_torque, safety.max_torque, kTorque);
  return read;
}

}  // namespace

void read_effects(TableReader& scene, Scene& result) {
  if (!scene.has("effects")) return;
  TableReader effects = scene.table("effects");
  if (effects.has("contact")) {
    result.contact = read_contact(effects.table("contact"));
  }
  if (effects.has("springs")) {
    result.springs = read_springs(effects.table("springs"), result.unit);
  }
  if (effects.has("friction")) result.friction = read_friction(effects.table("friction"));
  if (effects.has("damping")) {
    result.damping = DampingSettings{
        .damping = effects.table("damping").number("damping", kDamping, DampingSettings().damping)};
  }
  if (effects.has("proximity")) {
    TableReader proximity = effects.table("proximity");
    result.proximity = {
        .distance = result.unit * proximity.number("distance", kLength),
        .damping = proximity.number("damping", kDamping, ProximitySettings().damping)};
  }
  if (effects.has("gravity")) result.gravity = read_gravity(effects.table("gravity"));
  if (effects.has("snap")) result.snap = read_snap(effects.table("snap"), result.unit);
}

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

Scene read_scene(const std::filesystem::path& file) {
  const ScopedFloatEnvironment environment;  // of the parser too
  std::string text = read_toml_text(file);
  TomlTable document = parse_toml(file, text);
  Scene scene = read_scene(file, document);
  scene.text = std::move(text);
  return scene;
}

Scene read_scene(const std::filesystem::path& file, TomlTable& document) {
  const ScopedFloatEnvironment environment;
  Scene scene{};
  scene.file = file;
  scene.lines = std::make_shared<const detail::SceneLines>(document);
  open_if_missing(document, "safety");
  open_if_missing(document, "coupling");
  TableReader reader(file, document);
  scene.unit = reader.choice("unit", metres_in, R"("m", "cm", "mm", "um" or "inch")");
  scene.rate = reader.number("rate", kRate, scene.rate);
  scene.seconds = reader.number("seconds", kDuration, scene.seconds);
  scene.workers = static_cast<int>(
      reader.whole_number("workers", kWorkers, static_cast<std::uint64_t>(scene.workers)));
  read_bodies(reader, scene);
  read_device(reader, scene);
  scene.safety = read_numbers(reader.table("safety"), kSafetyKeys);
  scene.coupling = read_coupling(reader.table("coupling"), scene.safety);
  read_effects(reader, scene);
  reader.refuse_unknown();
  check_scene(scene);
  return scene;
}

}  // namespace ist
