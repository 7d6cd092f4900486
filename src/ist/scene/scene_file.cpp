#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ist/base/float_environment.h"
#include "ist/scene/ranges.h"
#include "ist/scene/scene_lines.h"
#include "ist/scene/scene_parts.h"

namespace ist {
namespace {

// Adds a table that is always on, so that its defaults are read in one place.
void open_if_missing(TomlTable& document, std::string_view key) {
  const bool is_there = std::any_of(document.entries.begin(), document.entries.end(),
                                    [key](const TomlEntry& each) { return each.key == key; });
  if (!is_there) document.entries.push_back({std::string(key), {document.line, TomlTable{}}});
}

SafetySettings read_safety(TableReader& scene) {
  TableReader safety = scene.table("safety");
  const SafetySettings usual;
  return {.max_force = safety.number("max_force", kForce, usual.max_force),
          .max_torque = safety.number("max_torque", kTorque, usual.max_torque),
          .force_slew = safety.number("force_slew", kForceSlew, usual.force_slew),
          .torque_slew = safety.number("torque_slew", kTorqueSlew, usual.torque_slew),
          .soft_start = safety.number("soft_start", kSoftStart, usual.soft_start)};
}

// Reads a spring's limit, which must not exceed the safety limit: a spring beyond it would be cut
// off.
double read_limit(TableReader& coupling, std::string_view key, const NumberRange& range,
                  double otherwise, double safe) {
  const double limit = coupling.number(key, range, std::min(otherwise, safe));
  if (limit > safe) {
    coupling.fail(key,
                  fmt::format("'{}' in [coupling] is {} {}, more than the {} that [safety] lets "
                              "through",
                              key, limit, range.unit, safe),
                  fmt::format("lower it, or raise '{}' in [safety]", key));
  }
  return limit;
}

CouplingSettings read_coupling(TableReader& scene, const SafetySettings& safety) {
  TableReader coupling = scene.table("coupling");
  const CouplingSettings usual;
  return {
      .stiffness = coupling.number("stiffness", kStiffness, usual.stiffness),
      .damping = coupling.number("damping", kDamping, usual.damping),
      .angular_stiffness =
          coupling.number("angular_stiffness", kAngularStiffness, usual.angular_stiffness),
      .angular_damping = coupling.number("angular_damping", kAngularDamping, usual.angular_damping),
      .max_force = read_limit(coupling, "max_force", kForce, usual.max_force, safety.max_force),
      .max_torque =
          read_limit(coupling, "max_torque", kTorque, usual.max_torque, safety.max_torque)};
}

}  // namespace

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
  scene.safety = read_safety(reader);
  scene.coupling = read_coupling(reader, scene.safety);
  read_effects(reader, scene);
  reader.refuse_unknown();
  check_scene(scene);
  return scene;
}

}  // namespace ist
