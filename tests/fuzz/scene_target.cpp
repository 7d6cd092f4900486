// A scene file, as `ist run` takes it.

#include <cctype>
#include <cmath>

#include "fuzz/fuzz_target.h"
#include "ist/base/error.h"
#include "ist/scene.h"
#include "loop/haptics/devices/plan.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

bool is_rotation(const Eigen::Matrix3d& matrix) {
  return (matrix * matrix.transpose()).isIdentity(1e-12) && matrix.determinant() > 0;
}

void check_body(const SceneBody& body) {
  require(!body.voxel_size || *body.voxel_size > 0, "a voxel size is not positive");
  require(body.translation.allFinite() && is_rotation(body.rotation), "a body's pose is none");
}

void check_plan(const std::vector<Waypoint>& plan) {
  require(!plan.empty(), "a plan is empty");
  const Waypoint* before = nullptr;
  for (const Waypoint& waypoint : plan) {
    require(waypoint_flaw(before, waypoint).empty(), "a waypoint has a flaw");
    before = &waypoint;
  }
}

void check(const Scene& scene) {
  require(scene.unit > 0 && scene.unit <= 1, "the unit is none");
  require(scene.rate >= 1 && scene.rate <= 1e4, "the rate is out of range");
  require(scene.seconds > 0 && std::isfinite(scene.seconds), "the time is none");
  for (const ist::SceneBody& body : scene.fixed) check_body(body);
  for (const ist::SceneBody& body : scene.held) check_body(body);
  require(!scene.open || scene.open->norm() == 1, "the axis is not of unit length");
  if (const auto* hand = std::get_if<HandSettings>(&scene.device)) {
    require(hand->mass > 0 && hand->inertia > 0, "a hand has no mass");
    check_plan(hand->plan);
  } else if (const auto* script = std::get_if<ScriptSettings>(&scene.device)) {
    check_plan(script->plan);
  }
  require(scene.coupling.stiffness >= 0 && scene.coupling.damping >= 0, "the coupling is active");
  require(scene.coupling.max_force > 0 && scene.coupling.max_force <= scene.safety.max_force &&
              scene.coupling.max_torque > 0 && scene.coupling.max_torque <= scene.safety.max_torque,
          "the coupling's limits are none");
  require(!scene.contact || !scene.springs, "contact and springs stand beside each other");
  require(scene.contact || !scene.friction, "friction has no contact");
  require(scene.contact || scene.springs || !scene.damping, "damping has no contacts");
  require(!scene.gravity || (scene.gravity->mass > 0 && scene.gravity->acceleration.allFinite()),
          "gravity is none");
  require(!scene.snap || is_rotation(scene.snap->pose.rotation), "a snap pose is none");
}

}  // namespace

std::string fuzz_scene(std::string_view bytes) {
  static const MemoryFile file;
  file.write(bytes);
  try {
    check(read_scene(file.path()));
  } catch (const Error& error) {
    const std::string_view what = error.what();
    const std::string place = file.path().string() + ":";
    const bool has_line = what.starts_with(place) &&
                          std::isdigit(static_cast<unsigned char>(what[place.size()])) != 0;
    // A script that a scene names is blamed by its own name.
    require(has_line || bytes.find("script") != std::string_view::npos,
            "an error does not name the file and the line");
    return to_string(error.code());
  }
  return "fine";
}

}  // namespace ist::test
