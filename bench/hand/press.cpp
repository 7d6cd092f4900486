#include "hand/press.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "ist/measure/penetration.h"
#include "support/bodies.h"
#include "support/stopwatch.h"

namespace ist::bench {
namespace {

constexpr double kMillimetre = 1e-3;                             // m
constexpr double kBefore = 1, kLight = 1, kDeep = 5, kSide = 3;  // mm, from the first contact
constexpr double kTilt = 0.05235987755982989;                    // rad
// The reference's skin is this part of the tool's size, a fifth of the default.
constexpr double kSkinParts = 5 * 32'000;
// A tool rests if it moves less in a tick, m and rad. A reference waits for so many ticks.
constexpr double kRest = 1e-9;
constexpr int kMostTicks = 400;

using Kind = BuiltInShape::Kind;

// The trees that judge a pose, of any voxel size.
const std::pair<SphereTree, SphereTree>& judges(const Jaws& jaws) {
  static std::map<std::string, std::pair<SphereTree, SphereTree>> made;
  const auto tree = [](const SceneBody& body) {
    const auto* file = std::get_if<std::filesystem::path>(&body.source);
    BuildOptions options;
    options.voxel_size = 0.8;
    options.keep_triangles = true;
    return build_tree(
        file != nullptr ? read_mesh(*file) : make_shape(std::get<BuiltInShape>(body.source)),
        options);
  };
  const auto found = made.find(jaws.name);
  if (found != made.end()) return found->second;
  return made.emplace(jaws.name, std::pair(tree(jaws.upper), tree(jaws.lower))).first->second;
}

Query judge(const Jaws& jaws) { return {judges(jaws).first, judges(jaws).second}; }

Jaws made_of(std::string name, SceneBody upper, SceneBody lower) {
  Jaws jaws{std::move(name), std::move(upper), std::move(lower), 0};
  Query query = judge(jaws);
  double apart = -12, meets = 0;
  for (int i = 0; i < 32; ++i) {
    const double middle = 0.5 * (apart + meets);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation().z() = middle;
    (query.intersects(pose).answer == Answer::kYes ? meets : apart) = middle;
  }
  jaws.first_contact = apart;
  return jaws;
}

struct Stop {
  double seconds;  // from the stop before
  double x, z;     // mm, from the first contact
  double tilt;     // rad
  Phase phase;     // of the way to this stop
};

// At 10 mm/s and 6 degrees a second.
constexpr Stop kStops[] = {
    {0, 0, -kBefore, 0, Phase::kComes},    {0.2, 0, kLight, 0, Phase::kComes},
    {0.8, 0, kLight, 0, Phase::kRests},    {0.4, 0, kDeep, 0, Phase::kPressed},
    {0.6, 0, kDeep, 0, Phase::kPressed},   {0.3, kSide, kDeep, 0, Phase::kAside},
    {0.1, kSide, kDeep, 0, Phase::kAside}, {0.3, 0, kDeep, 0, Phase::kAside},
    {0.5, 0, kDeep, kTilt, Phase::kTilts}, {0.1, 0, kDeep, kTilt, Phase::kTilts},
    {0.5, 0, kDeep, 0, Phase::kTilts},     {0.6, 0, -kBefore, 0, Phase::kLeaves},
};

Scene scene_of(const Jaws& jaws, const Keeper& keeper) {
  Scene scene{};
  scene.file = "bench";
  scene.unit = kMillimetre;
  scene.workers = keeper.workers;
  scene.fixed.front() = jaws.upper;
  scene.held.front() = jaws.lower;
  scene.held.front().translation = {0, 0, jaws.first_contact - kBefore};
  ScriptSettings script{{.damping = 4, .angular_damping = 4e-3, .delay = 0}, {}, {}};
  double time = 0;
  for (const Stop& stop : kStops) {
    time += stop.seconds;
    const Eigen::AngleAxisd turn(stop.tilt, Eigen::Vector3d::UnitY());
    script.plan.push_back(
        {time,
         {turn.toRotationMatrix(), kMillimetre * Eigen::Vector3d(stop.x, 0, stop.z + kBefore)}});
  }
  scene.device = script;
  scene.coupling.max_force = 5;
  // Nothing but the coupling shapes the wrench.
  scene.safety = {10, 0.4, 1e9, 1e9, 0};
  if (keeper.voxel_size) {
    scene.fixed.front().voxel_size = scene.held.front().voxel_size = keeper.voxel_size;
    scene.springs = SpringsSettings{.allow_breaking = true};
  } else {
    scene.contact = ContactSettings{};
    if (keeper.is_reference) {
      scene.contact->skin = judges(jaws).second.bounding_radius() * 2 / kSkinParts;
      scene.contact->steps = 10;
    }
  }
  return scene;
}

Phase phase_at(double time) noexcept {
  for (const Stop& stop : kStops) {
    time -= stop.seconds;
    if (time < 0) return stop.phase;
  }
  return Phase::kLeaves;
}

}  // namespace

const char* to_string(Phase phase) noexcept {
  constexpr const char* kNames[kPhases] = {"comes", "rests", "pressed", "aside", "tilts", "leaves"};
  return kNames[static_cast<std::size_t>(phase)];
}

const std::vector<Jaws>& pairs_of_jaws() {
  static const std::vector<Jaws> made = [] {
    std::vector<Jaws> pairs;
    pairs.push_back(made_of("built-in", {.source = BuiltInShape{.kind = Kind::kUpperJaw}},
                            {.source = BuiltInShape{.kind = Kind::kLowerJaw}}));
    const std::filesystem::path upper = data_file("human_maxilla.stl");
    const std::filesystem::path lower = data_file("human_mandible.stl");
    if (std::filesystem::exists(upper) && std::filesystem::exists(lower)) {
      pairs.push_back(made_of("human", {.source = upper}, {.source = lower}));
    }
    return pairs;
  }();
  return made;
}

Press::Press(const Jaws& jaws, const Keeper& keeper) : built_(build_scene(scene_of(jaws, keeper))) {
  const Eigen::Isometry3d tool = built_.simulation->tool_pose().isometry();
  from_tool_ = *Placement::from(tool.inverse() * built_.simulation->body_pose(1).isometry());
}

std::vector<PressTick> Press::run() {
  std::vector<PressTick> ticks;
  Simulation& simulation = *built_.simulation;
  while (!built_.device->done()) {
    const std::optional<Placement> device = built_.device->read();
    const Stopwatch watch;
    const Tick tick = simulation.tick(device);
    const double time = watch.microseconds();
    const double seconds = static_cast<double>(ticks.size()) * simulation.dt();
    ticks.push_back({phase_at(seconds), tick.device, tick.tool, tick.wrench.head<3>(), time,
                     tick.steps, tick.held, tick.halved,
                     tick.contacts && tick.contacts->found == Found::kFresh});
    built_.device->write(tick.wrench, simulation.dt());
  }
  return ticks;
}

Converged Press::converge(const std::vector<PressTick>& of) {
  Converged found{};
  Placement before = built_.simulation->tool_pose();
  for (const PressTick& at : of) {
    Tick tick{};
    double way = HUGE_VAL;
    for (int i = 0; i < kMostTicks && way >= kRest; ++i) {
      tick = built_.simulation->tick(at.device);
      way = motion_between(before, tick.tool).norm();
      before = tick.tool;
      if (i == 0) way = HUGE_VAL;  // the device has just moved, which its damper feels
    }
    found.restless += way < kRest ? 0 : 1;
    found.forces.push_back(tick.wrench.head<3>());
  }
  return found;
}

Eigen::Isometry3d Press::pose_of(const Placement& tool) const {
  Eigen::Isometry3d pose = built_.simulation->body_pose(0).isometry().inverse() *
                           (tool.isometry() * from_tool_.isometry());
  pose.translation() /= kMillimetre;
  return pose;
}

double gap_at(const Jaws& jaws, const Eigen::Isometry3d& pose) {
  constexpr double kTolerance = 1e-3;  // mm, of a depth
  Query query = judge(jaws);
  if (query.intersects(pose).answer == Answer::kNo) return query.distance(pose, 0).distance.lower;
  return -penetration(query, pose, kTolerance).lower;
}

}  // namespace ist::bench
