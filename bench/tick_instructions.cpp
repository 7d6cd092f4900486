// Makes ticks for callgrind to count, and prints what they came to:
//
//   tick_instructions SCENE TICKS                of a scene file
//   tick_instructions --by-hand EFFECTS TICKS    of parts that a program puts together by itself,
//                                                with effects as springs,gravity, or none
//
// Nothing but a tick happens in count_tick(), where --toggle-collect begins and ends.
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "ist/base/float_environment.h"
#include "ist/haptics/recording.h"
#include "ist/haptics/simulation.h"
#include "ist/mesh/mesh.h"
#include "ist/models/models.h"
#include "ist/scene.h"
#include "ist/tree/proximity_body.h"
#include "ist/tree/sphere_tree.h"
#include "ist/voxel/voxelizer.h"
#include "loop/haptics/devices/hand_device.h"
#include "loop/haptics/effects/damping_effect.h"
#include "loop/haptics/effects/gravity_effect.h"
#include "loop/haptics/effects/proximity_effect.h"
#include "loop/haptics/effects/snap_effect.h"
#include "loop/haptics/effects/springs_effect.h"
#include "loop/haptics/simulation_parts.h"
#include "loop/haptics/tool.h"

namespace ist::bench {
namespace {

// The scene of scripts/tick_instructions.py without its scene file: a program that knows which
// effects it wants, and makes these and what they need out of the library's parts.
struct BallOnBox {
  std::unique_ptr<const SphereTree> box, ball, near_box, near_ball;
  std::unique_ptr<Simulation> simulation;  ///< refers to the trees
  std::unique_ptr<HandDevice> device;
};

constexpr double kUnit = 1e-3;
constexpr double kBallVoxel = 0.5, kBoxVoxel = 1;
constexpr double kFullArea = 0.01;  // of the springs, mesh units²
constexpr double kNear = 2;

TriangleMesh outward(TriangleMesh mesh) {
  static_cast<void>(orient_outward(mesh));
  return mesh;
}

std::unique_ptr<const SphereTree> tree_of(const TriangleMesh& mesh, const BuildOptions& options) {
  return std::make_unique<const SphereTree>(build_tree(mesh, options));
}

std::vector<Waypoint> plan_from(const Placement& start) {
  const auto waypoint = [&](double time, const Eigen::Vector3d& move) {
    return Waypoint{time, {start.rotation, start.translation + kUnit * move}};
  };
  return {waypoint(0, {0, 0, 0}), waypoint(0.1, {0, 0, -3}), waypoint(2, {6, 0, -3})};
}

std::vector<std::unique_ptr<Effect>> effects_of(const std::set<std::string>& names,
                                                const Placement& start) {
  std::vector<std::unique_ptr<Effect>> effects;
  if (names.contains("springs")) {
    effects.push_back(std::make_unique<SpringsEffect>(SpringsSettings{.stiffness = 20000}));
  }
  if (names.contains("damping")) {
    effects.push_back(std::make_unique<DampingEffect>(DampingSettings{10}));
  }
  if (names.contains("proximity")) {
    effects.push_back(std::make_unique<ProximityEffect>(ProximitySettings{kUnit * kNear, 2}));
  }
  if (names.contains("gravity")) {
    effects.push_back(std::make_unique<GravityEffect>(
        GravitySettings{0.05, Eigen::Vector3d::Zero(), {0, 0, -9.81}}));
  }
  if (names.contains("snap")) {
    const Placement pose{start.rotation, start.translation + kUnit * Eigen::Vector3d(2, 0, -2)};
    effects.push_back(std::make_unique<SnapEffect>(SnapSettings{pose, 200, 0.2, kUnit * 4, 0.2}));
  }
  return effects;
}

// @param effects their names in a scene
BallOnBox make_ball_on_box(const std::set<std::string>& effects) {
  const ScopedFloatEnvironment environment;
  const Eigen::Vector3d size(40, 40, 10), move(0, 0, 11);
  const TriangleMesh box = outward(make_box(-0.5 * size, 0.5 * size));
  const TriangleMesh ball = outward(make_icosphere(5, 5));
  const Eigen::Vector3d origin = lattice_of(ball, kBallVoxel).origin();
  const BodyFrames frames{kUnit, {}, origin};
  const Placement start{Eigen::Matrix3d::Identity(), kUnit * (origin + move)};

  BallOnBox made;
  detail::SimulationParts parts{.effects = effects_of(effects, start),
                                .max_step = Tool::kNoLimit,
                                .start = start,
                                .dt = 1e-3};
  std::unique_ptr<ToolContactQuery> contacts, proximity;
  double radius = 0;
  if (effects.contains("springs")) {
    made.box = tree_of(box, {.voxel_size = kBoxVoxel, .spheres = SpherePolicy::kSlab});
    made.ball = tree_of(ball, {.voxel_size = kBallVoxel, .spheres = SpherePolicy::kSlab});
    contacts = std::make_unique<ToolContactQuery>(
        *made.box, *made.ball, frames,
        ToolContactOptions{
            .policy = SpherePolicy::kSlab,
            .margin = 0,
            .full_area = kUnit * kUnit * kFullArea / (kUnit * kUnit) / (kBoxVoxel * kBallVoxel)});
    radius = kUnit * surface_radius(*made.ball);
    parts.max_step = kUnit * kBallVoxel;
  }
  if (effects.contains("proximity")) {
    const double voxel = 0.5 * kNear;
    const auto around =
        tree_of(box, {.voxel_size = voxel, .spheres = SpherePolicy::kTable, .proximity = true});
    made.near_box = std::make_unique<const SphereTree>(proximity_body(*around));
    made.near_ball = tree_of(ball, {.voxel_size = voxel, .spheres = SpherePolicy::kTight});
    proximity = std::make_unique<ToolContactQuery>(
        *made.near_box, *made.near_ball, frames,
        ToolContactOptions{.policy = SpherePolicy::kTight,
                           .margin = 2,
                           .full_area = ProximityEffect::kFullPairs,
                           .reach = 0});
  }
  detail::add_two_bodies(parts, frames, radius, std::move(contacts), std::move(proximity));
  made.device = std::make_unique<HandDevice>(HandSettings{.plan = plan_from(start)});
  made.simulation = std::make_unique<Simulation>(detail::simulation_from(std::move(parts)));
  return made;
}

}  // namespace
}  // namespace ist::bench

namespace {

// Of everything that ticks come to, bit by bit: FNV-1a, G. Fowler, L. C. Noll and K.-P. Vo.
class Digest {
 public:
  void add(const ist::Tick& tick) noexcept {
    add(ist::to_numbers(tick.tool).data(), sizeof(ist::TickRecord::Pose));
    add(tick.wrench.data(), 6 * sizeof(double));
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return value_; }

 private:
  void add(const void* data, std::size_t bytes) noexcept {
    const auto* at = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < bytes; ++i) value_ = (value_ ^ at[i]) * 0x100000001b3U;
  }
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

}  // namespace

extern "C" [[gnu::noinline]] void count_tick(ist::Simulation& simulation,
                                             const std::optional<ist::Placement>& at,
                                             ist::Tick& tick) {
  tick = simulation.tick(at, {});
}

namespace {

void count(ist::Simulation& simulation, ist::Device& device, int ticks) {
  Digest digest;
  ist::Tick tick{};
  for (int i = 0; i < ticks; ++i) {
    count_tick(simulation, device.read(), tick);
    device.write(tick.wrench, simulation.dt());
    digest.add(tick);
  }
  fmt::print("{:016x} {}\n", digest.value(), simulation.effects().size());
}

std::set<std::string> names_in(const std::string& list) {
  std::set<std::string> names;
  std::istringstream stream(list);
  for (std::string name; std::getline(stream, name, ',');) names.insert(name);
  return names;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc == 4 && argv[1] == std::string("--by-hand")) {
    const ist::bench::BallOnBox made = ist::bench::make_ball_on_box(names_in(argv[2]));
    count(*made.simulation, *made.device, std::stoi(argv[3]));
  } else if (argc == 3) {
    const ist::BuiltScene scene = ist::build_scene(ist::read_scene(argv[1]));
    count(*scene.simulation, *scene.device, std::stoi(argv[2]));
  } else {
    fmt::print(stderr, "usage: tick_instructions SCENE TICKS, or --by-hand EFFECTS TICKS\n");
    return 2;
  }
} catch (const std::exception& error) {
  fmt::print(stderr, "tick_instructions: {}\n", error.what());
  return 1;
}
