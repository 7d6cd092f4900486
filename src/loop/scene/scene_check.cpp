#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "ist/base/pose.h"
#include "loop/scene/ranges.h"
#include "loop/scene/scene_lines.h"
#include "loop/scene/scene_parts.h"

namespace ist {
namespace {

class Check {
 public:
  explicit Check(const Scene& scene) : scene_(scene) {}

  void number(std::string_view key, double value, const NumberRange& range) const {
    if (!range.holds(value)) {
      fail_at(scene_, key, fmt::format("it is {}: give a number {}", value, range.text()));
    }
  }
  template <typename Settings, std::size_t kCount>
  void numbers(const char* table, const Settings& settings,
               const NumberKey<Settings> (&keys)[kCount]) const {
    for (const auto& [name, member, range] : keys) {
      number(fmt::format("{}.{}", table, name), settings.*member, range);
    }
  }
  // A length in metres, which was one in the scene's unit.
  void length(const char* key, double value) const {
    if (!(value > 0 && std::isfinite(value))) {
      fail_at(scene_, key, fmt::format("it is {} m: give a positive length", value));
    }
  }
  // A length or an area in SI, which was one in the scene's unit, or 0.
  void amount(const char* key, double value) const {
    if (!(value >= 0 && std::isfinite(value))) {
      fail_at(scene_, key, fmt::format("it is {}: give 0 or more", value));
    }
  }
  void body(const std::string& table, const SceneBody& body) const {
    if (!body.script.empty() && body.attachable) {
      fail_at(
          scene_, table + ".attachable",
          fmt::format("{} follows a script, so the hand cannot take it: take out one of the two",
                      body.name));
    }
    if (!Placement::from(Placement{body.rotation}.isometry()) || !body.translation.allFinite()) {
      fail_at(scene_, table + ".quaternion",
              fmt::format("the pose of the body is no rigid motion: {}",
                          why_not_rigid(Placement{body.rotation, body.translation}.isometry())));
    }
  }

 private:
  const Scene& scene_;
};

std::vector<std::string> names_of(const std::map<std::string, bool>& held) {
  std::vector<std::string> names;
  names.reserve(held.size());
  for (const auto& [name, is_held] : held) names.push_back(name);
  return names;
}

void check_bodies(const Check& check, const Scene& scene) {
  std::set<std::string> names;
  const auto check_all = [&](const char* key, const std::vector<SceneBody>& bodies) {
    if (bodies.empty()) {
      fail_at(scene, key, fmt::format("there is no {} body: give one at least", key));
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const std::string table = path_of_body(key, i, bodies.size());
      check.body(table, bodies[i]);
      if (names.insert(bodies[i].name).second) continue;
      fail_at(scene, table + ".name",
              fmt::format("two bodies are called {}: give each a name of its own", bodies[i].name));
    }
  };
  check_all("fixed", scene.fixed);
  check_all("held", scene.held);
  for (const SceneBody& body : scene.held) {
    if (body.script.empty()) continue;
    fail_at(
        scene, "held.script",
        fmt::format("{} is held, and cannot follow a script: move it by the device", body.name));
  }
}

// Follows who holds what from change to change.
void check_changes(const Scene& scene) {
  std::map<std::string, bool> held;
  std::set<std::string> attachable, scripted;
  for (const SceneBody& body : scene.fixed) held[body.name] = false;
  for (const SceneBody& body : scene.held) held[body.name] = true;
  for (const auto* bodies : {&scene.fixed, &scene.held}) {
    for (const SceneBody& body : *bodies) {
      if (body.attachable) attachable.insert(body.name);
      if (!body.script.empty()) scripted.insert(body.name);
    }
  }
  double before = 0;
  for (std::size_t i = 0; i < scene.changes.size(); ++i) {
    const SceneChange& change = scene.changes[i];
    const std::string table = path_of_body("changes", i, scene.changes.size());
    const std::string key = table + (change.attach ? ".attach" : ".release");
    const auto body = held.find(change.body);
    if (body == held.end()) {
      fail_at(scene, key,
              fmt::format("there is no body called {}: the bodies are {}", change.body,
                          fmt::join(names_of(held), ", ")));
    }
    if (scripted.contains(change.body)) {
      fail_at(
          scene, key,
          fmt::format("{} follows a script, so the hand cannot take it: take out one of the two",
                      change.body));
    }
    if (!attachable.contains(change.body)) {
      fail_at(
          scene, key,
          fmt::format("{} stays where it is: write attachable = true in its table", change.body));
    }
    if (body->second == change.attach) {
      fail_at(scene, key,
              fmt::format("{} is {} at that time: take the change out, or another one before it",
                          change.body, change.attach ? "in the hand already" : "not in the hand"));
    }
    body->second = change.attach;
    if (!(change.time >= before) || !std::isfinite(change.time)) {
      fail_at(scene, table + ".time",
              fmt::format("the time {} s does not come after {} s: let times ascend from 0",
                          change.time, before));
    }
    before = change.time;
  }
}

// Springs act between voxels. Only a tree file brings its own.
void check_voxels(const Scene& scene) {
  const auto check_all = [&](const char* key, const std::vector<SceneBody>& bodies) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const auto* file = std::get_if<std::filesystem::path>(&bodies[i].source);
      if (bodies[i].voxel_size || (file != nullptr && is_tree_file(*file))) continue;
      fail_at(scene, path_of_body(key, i, bodies.size()) + ".voxel_size",
              "springs act between voxels: give the edge of a voxel, or write [effects.contact] in "
              "place of [effects.springs]");
    }
  };
  check_all("fixed", scene.fixed);
  check_all("held", scene.held);
}

// Which effects may stand beside each other.
void check_contact_effects(const Scene& scene) {
  if (scene.contact && scene.springs) {
    fail_at(scene, "effects.springs",
            "a scene has [effects.contact] or [effects.springs]: take one of the two out");
  }
  if (scene.friction && !scene.contact) {
    fail_at(scene, "effects.friction",
            scene.springs
                ? "[effects.friction] is a part of contact, and springs have none: write "
                  "[effects.contact] in place of [effects.springs], or take this table out"
                : "[effects.friction] is a part of contact: add the table "
                  "[effects.contact], or take this one out");
  }
  if (scene.damping && !scene.contact && !scene.springs) {
    fail_at(scene, "effects.damping",
            "[effects.damping] acts at contacts: add the table [effects.contact] or "
            "[effects.springs], or take this one out");
  }
}

void check_effects(const Check& check, const Scene& scene) {
  check_contact_effects(scene);
  if (scene.contact) {
    check.numbers("effects.contact", *scene.contact, kContactKeys);
    check.number("effects.contact.steps", scene.contact->steps, kSteps);
  }
  if (scene.springs) {
    check_voxels(scene);
    check.number("effects.springs.stiffness", scene.springs->stiffness, kStiffness);
    check.amount("effects.springs.margin", scene.springs->margin);
    check.amount("effects.springs.full_area", scene.springs->full_area);
  }
  if (scene.friction) check.numbers("effects.friction", *scene.friction, kFrictionKeys);
  if (scene.damping) check.number("effects.damping.damping", scene.damping->damping, kDamping);
  if (scene.proximity) {
    check.length("effects.proximity.distance", scene.proximity->distance);
    check.number("effects.proximity.damping", scene.proximity->damping, kDamping);
  }
  if (scene.gravity) {
    check.number("effects.gravity.mass", scene.gravity->mass, kMass);
    if (!scene.gravity->acceleration.allFinite() ||
        !scene.gravity->centre.value_or(Eigen::Vector3d::Zero()).allFinite()) {
      fail_at(scene, "effects.gravity", "a number is not finite: give finite ones");
    }
  }
  if (scene.snap) {
    if (!Placement::from(scene.snap->pose.isometry())) {
      fail_at(scene, "effects.snap",
              fmt::format("its pose is no rigid motion: {}",
                          why_not_rigid(scene.snap->pose.isometry())));
    }
    check.length("effects.snap.radius", scene.snap->radius);
    check.numbers("effects.snap", *scene.snap, kSnapKeys);
  }
}

const DeviceMechanics& mechanics_of(const Scene& scene) {
  return std::visit(
      [](const auto& device) -> const auto& { return device.mechanics; }, scene.device);
}

void check_plan(const Scene& scene) {
  const auto* script = std::get_if<ScriptSettings>(&scene.device);
  const auto* hand = std::get_if<HandSettings>(&scene.device);
  if ((script != nullptr && script->plan.empty()) || (hand != nullptr && hand->plan.empty())) {
    fail_at(scene, "device.plan", "the plan has no waypoint: give at least one, at time 0");
  }
}

}  // namespace

void check_scene(const Scene& scene) {
  const Check check(scene);
  check.length("unit", scene.unit);
  check.number("rate", scene.rate, kRate);
  if (scene.workers != 1 && scene.workers != 2) {
    fail_at(scene, "workers", fmt::format("it is {}: give 1 or 2", scene.workers));
  }
  check_bodies(check, scene);
  check_changes(scene);
  check.numbers("device", mechanics_of(scene), kMechanicsKeys);
  check_plan(scene);
  if (scene.open && !(std::abs(scene.open->norm() - 1) < 1e-6)) {
    fail_at(scene, "held.open", "it is no direction: give an axis of unit length");
  }
  check.numbers("coupling", scene.coupling, kCouplingKeys);
  check.numbers("safety", scene.safety, kSafetyKeys);
  check_effects(check, scene);
}

}  // namespace ist
