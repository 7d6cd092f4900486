#include "instructions/counted_ticks.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "haptics/bodies/body_cases.h"
#include "instructions/counted.h"
#include "ist/scene.h"

namespace ist::test {
namespace {

Scene ball_on_box() {
  Scene scene{.unit = 1e-3};
  scene.fixed = {box_body("box", {-20, -20, -10}, {20, 20, 0})};
  scene.held = {ball_body("ball", {0, 0, 6}, 5)};
  scene.springs = SpringsSettings{};
  scene.device = NullSettings{kDeviceUnderTest};
  return scene;
}

Scene with_every_effect() {
  Scene scene = ball_on_box();
  scene.damping = DampingSettings{};
  scene.proximity = ProximitySettings{.distance = 2e-3};
  scene.gravity = SceneGravity{.mass = 0.05};
  scene.snap = SnapSettings{.pose = {.translation = {2e-3, 0, -2e-3}}, .radius = 4e-3};
  return scene;
}

// The ball sinks for half of the ticks, touches, and slides.
Answer run(Simulation& simulation) {
  const Placement start = simulation.tool_pose();
  double leaf_pairs = 0;
  Answer answer{};
  for (int i = 0; i < kTicks; ++i) {
    const Placement hand = moved_by(start, {0.02 * i, 0, -std::min(0.03 * i, 3.0)});
    const Tick tick = simulation.tick(hand);
    leaf_pairs += tick.leaf_pairs;
    answer.sphere_tests += tick.contacts->sphere_tests;
    if (tick.proximity) answer.sphere_tests += tick.proximity->sphere_tests;
  }
  answer.found = static_cast<std::uint64_t>(std::floor(leaf_pairs));
  return answer;
}

// Ticks leave a simulation other than it was, so the ones that are counted have one of their own.
void count_ticks_of(const std::string& name, const Scene& scene) {
  const std::vector<BuiltScene> twins = [&] {
    std::vector<BuiltScene> made;
    for (int i = 0; i < 2; ++i) made.push_back(build_scene(scene));
    return made;
  }();
  std::size_t next = 0;
  count(name, [&] { return run(*twins.at(next++).simulation); });
}

}  // namespace

void count_ticks() {
  count_ticks_of("ticks/springs", ball_on_box());
  count_ticks_of("ticks/every_effect", with_every_effect());
}

}  // namespace ist::test
