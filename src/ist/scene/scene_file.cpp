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
