#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ist/base/error.h"
#include "ist/base/float_environment.h"
#include "ist/haptics/simulation_parts.h"
#include "ist/haptics/stability_border.h"
#include "ist/haptics/tool.h"
#include "ist/scene/free_start.h"
#include "ist/scene/load_body.h"
#include "ist/scene/make_effects.h"
#include "ist/scene/scene_lines.h"
#include "ist/scene/scene_parts.h"

namespace ist {
namespace {

class Builder {
 public:
  Builder(const Scene& scene, std::vector<std::unique_ptr<Effect>> own, std::uint64_t max_memory,
          Progress* progress)
      : scene_(scene), own_(std::move(own)), max_memory_(max_memory), progress_(progress) {}

  BuiltScene build() {
    load();
    choose_effects();
    built_.trees = build_scene_trees(scene_, fixed_, held_, needs_, max_memory_, notes_, progress_);
    place();
    build_simulation();
    built_.notes = notes_.take();
    return std::move(built_);
  }

 private:
  void load();
  void choose_effects();
  void warn_of_unknown_outside(const LoadedBody& body);
  void place();
  void build_simulation();
  void warn_of(const BorderLimit& limit, const char* key, const char* unit);
  [[nodiscard]] Placement plan_start() const;
  [[nodiscard]] std::unique_ptr<Device> make_device() const;

  const Scene& scene_;
  std::vector<std::unique_ptr<Effect>> own_;
  std::uint64_t max_memory_;
  Progress* progress_;
  BuiltScene built_;
  BuildNotes notes_;
  LoadedBody fixed_{}, held_{};
  BodyFrames frames_;
  ToolHome home_;
  Placement start_;
  std::vector<std::unique_ptr<Effect>> effects_;
  EffectNeeds needs_;
};

void Builder::load() {
  fixed_ = load_body(scene_, scene_.fixed, "fixed", built_.warnings);
  held_ = load_body(scene_, scene_.held, "held", built_.warnings);
  frames_ = {
      scene_.unit, {scene_.fixed.rotation, scene_.unit * scene_.fixed.translation}, held_.origin};
  home_ = {{scene_.held.rotation,
            scene_.unit * (scene_.held.rotation * held_.origin + scene_.held.translation)},
           held_.origin};
}

bool needs_outside(const EffectNeeds& needs) {
  return needs.normals || needs.depth || needs.proximity;
}

void Builder::warn_of_unknown_outside(const LoadedBody& body) {
  if (body.outside_is_known) return;
  const bool own = std::any_of(own_.begin(), own_.end(),
                               [](const auto& effect) { return needs_outside(effect->needs()); });
  if (!scene_.contact && !scene_.proximity && !own) return;
  built_.warnings.push_back(
      fmt::format("{}: the mesh is not closed and consistent, so its outside is not known and no "
                  "contact is felt: repair it, or say trust_normals = true in [{}]",
                  body.name, body.table));
}

void Builder::choose_effects() {
  warn_of_unknown_outside(fixed_);
  warn_of_unknown_outside(held_);
  const bool outside_is_known = fixed_.outside_is_known && held_.outside_is_known;
  effects_ = make_effects(scene_, home_, outside_is_known);
  for (auto& effect : own_) {
    if (outside_is_known || !needs_outside(effect->needs())) effects_.push_back(std::move(effect));
  }
  needs_ = needs_of(effects_);
}

// The device's pose at the beginning of its plan.
Placement Builder::plan_start() const {
  if (const auto* script = std::get_if<ScriptSettings>(&scene_.device)) {
    return home_.moved(script->plan.front().pose);
  }
  if (const auto* hand = std::get_if<HandSettings>(&scene_.device)) {
    return home_.moved(hand->plan.front().pose);
  }
  return home_.pose;
}

void Builder::place() {
  start_ = plan_start();
  if (!needs_.contacts()) {
    notes_.skip("free start", "no effect needs contacts");
    return;
  }
  FreeStart start(*built_.trees.fixed, *built_.trees.held, fixed_.mesh.get(), held_.mesh.get());
  const Eigen::Isometry3d pose = frames_.query_pose(start_);
  const FreeStart::State state = start.at(pose);
  if (!fixed_.mesh || !held_.mesh) {
    built_.warnings.push_back(
        fmt::format("{}: the tree has no triangles, so a start inside the other body cannot be "
                    "detected: build it without --no-triangles",
                    (fixed_.mesh ? held_ : fixed_).name));
  }
  if (state == FreeStart::State::kFree) return;
  const char* how = state == FreeStart::State::kIntersecting
                        ? "the bodies intersect, or may intersect,"
                        : "one body is inside the other";
  if (!scene_.open) {
    fail_at(
        scene_, "held.open",
        fmt::format("{} where the device starts: name the axis along which they open in [held], "
                    "as open = \"-z\", or start elsewhere",
                    how));
  }
  const std::optional<double> way =
      start.open_distance(pose, scene_.fixed.rotation.transpose() * *scene_.open);
  if (!way) {
    fail_at(scene_, "held.open",
            fmt::format("{} where the device starts, and all along the axis of held.open: name "
                        "another axis, or start elsewhere",
                        how));
  }
  start_.translation += (*way * scene_.unit) * *scene_.open;
  built_.warnings.push_back(
      fmt::format("{} where the device starts: the tool starts {:.4g} m away, along held.open", how,
                  *way * scene_.unit));
}

std::unique_ptr<Device> Builder::make_device() const {
  const auto at_home = [&](std::vector<Waypoint> plan) {
    for (Waypoint& waypoint : plan) waypoint.pose = home_.moved(waypoint.pose);
    return plan;
  };
  if (const auto* script = std::get_if<ScriptSettings>(&scene_.device)) {
    return make_script_device(at_home(script->plan), script->mechanics);
  }
  if (const auto* hand = std::get_if<HandSettings>(&scene_.device)) {
    HandSettings settings = *hand;
    settings.plan = at_home(settings.plan);
    return make_hand_device(std::move(settings));
  }
  return make_null_device(start_, std::get<NullSettings>(scene_.device).mechanics);
}

void Builder::warn_of(const BorderLimit& limit, const char* key, const char* unit) {
  if (!limit.clamped()) return;
  built_.warnings.push_back(
      fmt::format("{} of {:.4g} {} is too near to the stability border of this device, rate and "
                  "delay, {:.4g}, or beyond it: {:.4g} is used",
                  key, limit.asked, unit, limit.largest, limit.used));
}

void Builder::build_simulation() {
  built_.device = make_device();
  // In whole nanoseconds, as the loop's clock counts.
  const double period = 1e-9 * std::floor(1e9 / scene_.rate);
  const ClampedCoupling coupling =
      clamp_coupling(scene_.coupling, built_.device->mechanics(), period);
  warn_of(coupling.damping, "coupling.damping", "N s/m");
  warn_of(coupling.stiffness, "coupling.stiffness", "N/m");
  warn_of(coupling.angular_damping, "coupling.angular_damping", "N m s/rad");
  warn_of(coupling.angular_stiffness, "coupling.angular_stiffness", "N m/rad");

  detail::SimulationParts parts{.coupling = coupling.settings,
                                .safety = scene_.safety,
                                .tool = Tool(0, 0),
                                .start = start_,
                                .dt = period};
  built_.step_limit = Tool::kNoLimit;
  double radius = 0;
  const SceneTrees& trees = built_.trees;
  if (trees.fixed) {
    const std::string why = fmt::format("for effects at contacts; up to {} leaf pairs are kept",
                                        ToolContactOptions().front_pairs);
    parts.contacts = notes_.make("contact points", why, [&] {
      const SpherePolicy policy = std::min(scene_.fixed.spheres.value_or(trees.fixed->tightest()),
                                           scene_.held.spheres.value_or(trees.held->tightest()));
      return std::make_unique<ToolContactQuery>(
          *trees.fixed, *trees.held, frames_,
          ToolContactOptions{
              .policy = policy,
              .least_depth = -scene_.contact.value_or(ContactSettings()).margin,
              .workers = scene_.workers,
              .period = std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * period))});
    });
    built_.step_limit = scene_.unit * std::min(trees.fixed->voxel_size(), trees.held->voxel_size());
    radius = scene_.unit * surface_radius(*trees.held);
  } else {
    notes_.skip("contact points", "no effect needs them");
  }
  if (trees.near_fixed) {
    parts.proximity = notes_.make("proximity query", "for effects.proximity", [&] {
      return std::make_unique<ToolContactQuery>(
          *trees.near_fixed, *trees.near_held, frames_,
          ToolContactOptions{.policy = SpherePolicy::kTight, .least_depth = -2, .margin = 0});
    });
  } else {
    notes_.skip("proximity query", "no effect needs it");
  }
  parts.tool = Tool(radius, built_.step_limit);
  parts.effects = std::move(effects_);
  built_.simulation = std::make_unique<Simulation>(std::move(parts));
}

}  // namespace

BuiltScene build_scene(const Scene& scene, std::vector<std::unique_ptr<Effect>> own,
                       std::uint64_t max_memory, Progress* progress) {
  const ScopedFloatEnvironment environment;
  check_scene(scene);
  if (std::any_of(own.begin(), own.end(), [](const auto& effect) { return !effect; })) {
    throw Error(ErrorCode::kArgumentInvalid, "an own effect is null: give effects only");
  }
  return Builder(scene, std::move(own), max_memory, progress).build();
}

}  // namespace ist
