#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ist/base/error.h"
#include "ist/base/float_environment.h"
#include "ist/haptics/placement.h"
#include "ist/measure/penetration.h"
#include "ist/mesh/mesh.h"
#include "ist/query/inside.h"
#include "ist/query/query.h"
#include "loop/haptics/simulation_parts.h"
#include "loop/haptics/stability_border.h"
#include "loop/haptics/tool.h"
#include "loop/scene/load_body.h"
#include "loop/scene/make_effects.h"
#include "loop/scene/scene_lines.h"
#include "loop/scene/scene_pairs.h"
#include "loop/scene/scene_parts.h"
#include "loop/scene/scene_queries.h"

namespace ist {
namespace {

// Tests whether held bodies are free of fixed ones, and finds the nearest free place along an
// axis.
class FreeStart {
 public:
  // Adds a pair of bodies. All arguments but the last two must outlive the object. If a mesh is
  // null, a body inside the other one counts as free.
  // @param pose maps held mesh coordinates to fixed mesh coordinates
  // @param axis the axis of open_distance(), a unit vector in fixed mesh coordinates
  // @param step of open_distance(), mesh units
  void add(const SphereTree& fixed, const SphereTree& held, const TriangleMesh* fixed_mesh,
           const TriangleMesh* held_mesh, const Eigen::Isometry3d& pose,
           const Eigen::Vector3d& axis, double step);

  enum class Way { kIntersecting, kInside };
  // A pair that is not free, by the order of add(), and how.
  struct Flaw {
    std::size_t pair;
    Way way;
  };
  // Returns the first pair that is not free after a motion of the held bodies along the axis, mesh
  // units; empty if all are.
  [[nodiscard]] std::optional<Flaw> flaw(double distance = 0) noexcept;

  // Finds the distance by which the held bodies must move along the axis to be free, mesh units:
  // the first multiple of a step at which all are free and one step more. Empty where none is
  // within the bodies' extents. Cost: 20 to 300 µs a voxel and pair.
  [[nodiscard]] std::optional<double> open_distance() noexcept;

  // Returns the place at which a pair intersects, and how deep, for a message: " by 0.2 at x, y,
  // z"; or ", or may intersect" without triangles. In the unit and the fixed body's coordinates.
  [[nodiscard]] std::string place(const Flaw& flaw);

 private:
  struct CheckedPair {
    Query query;
    std::optional<InsideTest> inside;
    Placement pose;  // maps held to fixed mesh coordinates, mesh units
    Eigen::Vector3d axis;
  };

  std::vector<CheckedPair> pairs_;
  double step_ = 0, farthest_ = 0;  // mesh units
};

// Without voxels a held body is opened by this part of its diagonal.
constexpr double kOpenings = 500;

// All pairs have a query at once, beside those of the loop: these are small, and slower by a tenth.
QueryOptions small_query() {
  QueryOptions options;
  options.frontier_pairs = 1 << 12;
  return options;
}

void FreeStart::add(const SphereTree& fixed, const SphereTree& held, const TriangleMesh* fixed_mesh,
                    const TriangleMesh* held_mesh, const Eigen::Isometry3d& pose,
                    const Eigen::Vector3d& axis, double step) {
  step_ = pairs_.empty() ? step : std::min(step_, step);
  farthest_ = std::max(farthest_, 2 * (fixed.bounding_radius() + held.bounding_radius()));
  pairs_.push_back(
      {Query(fixed, held, small_query()), std::nullopt, {pose.linear(), pose.translation()}, axis});
  if (fixed_mesh != nullptr && held_mesh != nullptr) {
    pairs_.back().inside.emplace(*fixed_mesh, *held_mesh);
  }
}

std::optional<FreeStart::Flaw> FreeStart::flaw(double distance) noexcept {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    CheckedPair& pair = pairs_[i];
    Eigen::Isometry3d pose = pair.pose.isometry();
    pose.translation() += distance * pair.axis;
    if (const IntersectionResult found = pair.query.intersects(pose);
        found.status != QueryStatus::kDone || found.answer != Answer::kNo) {
      return Flaw{i, Way::kIntersecting};
    }
    if (pair.inside && pair.inside->at(pose) != Inside::kNone) return Flaw{i, Way::kInside};
  }
  return std::nullopt;
}

std::optional<double> FreeStart::open_distance() noexcept {
  double distance = step_;
  while (distance <= farthest_) {
    if (!flaw(distance) && !flaw(distance + step_)) return distance + step_;
    distance += step_;
  }
  return std::nullopt;
}

std::string FreeStart::place(const Flaw& flaw) {
  CheckedPair& pair = pairs_[flaw.pair];
  if (!pair.query.has_triangles()) return ", or may intersect";
  const Eigen::Isometry3d pose = pair.pose.isometry();
  std::array<NearPair, 1> meeting;
  const NearPairsResult near = pair.query.near_pairs(pose, 0, meeting);
  if (near.status != QueryStatus::kDone || near.near_pairs == 0) return "";
  Eigen::Vector3d at = meeting[0].fixed_point;
  std::string depth;
  if (pair.inside) {
    const Penetration deepest = penetration(pair.query, pose, step_);
    if (deepest.status == Penetration::Status::kDone && deepest.lower > 0) {
      at = deepest.point;
      depth = fmt::format(" by at least {:.3g}", deepest.lower);
    }
  }
  return fmt::format("{} at ({:.4g}, {:.4g}, {:.4g}) of the fixed body", depth, at[0], at[1],
                     at[2]);
}

class Builder {
 public:
  Builder(const Scene& scene, std::vector<std::unique_ptr<Effect>> own, std::uint64_t max_memory,
          Progress* progress)
      : scene_(scene),
        own_(std::move(own)),
        max_memory_(max_memory),
        progress_(progress),
        // In whole nanoseconds, as the loop's clock counts.
        period_(1e-9 * std::floor(1e9 / scene.rate)) {}

  BuiltScene build() {
    const bool own = std::any_of(own_.begin(), own_.end(),
                                 [](const auto& effect) { return effect->needs().contacts(); });
    voxels_ = !scene_.contact && (scene_.springs || own);
    bodies_ = load_bodies(scene_, voxels_, built_.warnings);
    home_ = home_of(bodies_[scene_.fixed.size()]);
    built_.origin = home_.origin;
    choose_effects();
    built_.trees = build_scene_trees(scene_, bodies_, needs_, max_memory_, notes_, progress_);
    place_bodies();
    place_tool();
    build_simulation();
    built_.notes = notes_.take();
    return std::move(built_);
  }

 private:
  void choose_effects();
  void warn_of_unknown_outside(const LoadedBody& body);
  void refuse_to_take(bool outside_is_known) const;
  void check_springs();
  void place_bodies();
  void place_tool();
  [[nodiscard]] WallSettings wall_settings() const;
  void build_simulation();
  void warn_of(const BorderLimit& limit, const char* key, const char* unit);
  [[nodiscard]] BodyHome home_of(const LoadedBody& body) const;
  [[nodiscard]] bool finds_contacts() const { return scene_.contact || needs_.contacts(); }
  [[nodiscard]] std::vector<Waypoint> plan() const;
  [[nodiscard]] std::unique_ptr<Device> make_device() const;

  const Scene& scene_;
  std::vector<std::unique_ptr<Effect>> own_;
  std::uint64_t max_memory_;
  Progress* progress_;
  double period_;        // s
  bool voxels_ = false;  // contacts are pairs of leaves
  BuiltScene built_;
  BuildNotes notes_;
  std::vector<LoadedBody> bodies_;
  std::vector<HandPair> pairs_;
  BodyHome home_;
  HandBodies placed_;
  double max_step_ = Tool::kNoLimit;  // of the held surfaces in a tick, m
  Placement start_;
  std::vector<std::unique_ptr<Effect>> effects_;
  EffectNeeds needs_;
};

BodyHome Builder::home_of(const LoadedBody& body) const {
  const SceneBody& named = *body.named;
  return {{named.rotation, scene_.unit * (named.rotation * body.origin + named.translation)},
          body.origin};
}

bool needs_outside(const EffectNeeds& needs) {
  return needs.normals || needs.depth || needs.proximity;
}

void Builder::warn_of_unknown_outside(const LoadedBody& body) {
  if (body.outside_is_known) return;
  const bool own = std::any_of(own_.begin(), own_.end(),
                               [](const auto& effect) { return needs_outside(effect->needs()); });
  if (!scene_.proximity && (scene_.contact || (!scene_.springs && !own))) return;
  built_.warnings.push_back(
      fmt::format("{}: the mesh is not closed and consistent, so its outside is not known and no "
                  "contact is felt: repair it, or say trust_normals = true in [{}]",
                  body.name, body.table));
}

void Builder::choose_effects() {
  pairs_ = pairs_of(bodies_);
  bool outside_is_known = true;
  for (const LoadedBody& body : bodies_) {
    warn_of_unknown_outside(body);
    outside_is_known = outside_is_known && body.outside_is_known;
  }
  effects_ = make_effects(scene_, home_, outside_is_known);
  for (auto& effect : own_) {
    const EffectNeeds needs = effect->needs();
    const bool has_all =
        outside_is_known || !needs_outside(needs) || (scene_.contact && !needs.proximity);
    if (has_all) effects_.push_back(std::move(effect));
  }
  needs_ = needs_of(effects_);
  if (scene_.springs && outside_is_known) check_springs();
  if (!finds_contacts()) refuse_to_take(outside_is_known);
}

// Without contacts nothing would tell whether a body that the hand takes is free.
void Builder::refuse_to_take(bool outside_is_known) const {
  const auto refuse = [&](const char* key, const std::vector<SceneBody>& bodies) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (!bodies[i].attachable) continue;
      fail_at(
          scene_, path_of_body(key, i, bodies.size()) + ".attachable",
          fmt::format("whether anything touches {} is not known: {}", bodies[i].name,
                      outside_is_known ? "add the table [effects.contact] or [effects.springs]"
                                       : "give closed meshes, or set trust_normals = true where "
                                         "the normals of one that is open point outward"));
    }
  };
  refuse("fixed", scene_.fixed);
  refuse("held", scene_.held);
}

// Refuses a margin that is wider than half a voxel, and a wall that breaks at less force than the
// coupling exerts.
void Builder::check_springs() {
  const SpringsSettings& springs = *scene_.springs;
  const auto voxel_of = [&](const HandPair& pair) {
    return 0.5 * (bodies_[pair.fixed].voxel_size + bodies_[pair.held].voxel_size) * scene_.unit;
  };
  const HandPair& least = *std::min_element(
      pairs_.begin(), pairs_.end(),
      [&](const HandPair& a, const HandPair& b) { return voxel_of(a) < voxel_of(b); });
  const double voxel = voxel_of(least);
  if (springs.margin > 0.5 * voxel) {
    fail_at(scene_, "effects.springs.margin",
            fmt::format("it is {:.4g}, more than half a voxel, {:.4g}: lower it, or give larger "
                        "voxels",
                        springs.margin / scene_.unit, 0.5 * voxel / scene_.unit));
  }
  const double force = breaking_force(springs, voxel);
  if (force >= scene_.coupling.max_force) return;
  const std::string breaks = fmt::format(
      "the wall of springs between {} and {} breaks at {:.3g} N, and the coupling exerts up to "
      "{:.3g} N",
      bodies_[least.fixed].named->name, bodies_[least.held].named->name, force,
      scene_.coupling.max_force);
  if (!springs.allow_breaking) {
    fail_at(scene_, "effects.springs.stiffness",
            fmt::format("{}: give larger voxels, a higher stiffness or a lower coupling.max_force, "
                        "or say allow_breaking = true in [effects.springs]",
                        breaks));
  }
  built_.warnings.push_back(fmt::format("{}: beyond that force the tool passes through", breaks));
}

// Puts the bodies at their places. With springs the least voxel bounds the tool's step, so that
// nothing tunnels: what a script moves in a tick is taken off.
void Builder::place_bodies() {
  for (std::size_t i = 0; i < bodies_.size() && voxels_; ++i) {
    if (!built_.trees[i].contact) continue;
    max_step_ = std::min(max_step_, scene_.unit * bodies_[i].voxel_size);
  }
  std::vector<BodyPart> parts;
  double script_step = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const LoadedBody& body = bodies_[i];
    const SceneBody& named = *body.named;
    BodyPart part{.name = named.name,
                  .place = {named.rotation, scene_.unit * named.translation},
                  .centre = body.origin,
                  .radius = scene_.unit * body.radius,
                  .held = body.held,
                  .attachable = named.attachable};
    if (!named.script.empty()) {
      script_step =
          std::max(script_step, step_of(scene_, body, part.radius, period_, 0.5 * max_step_));
      part.script = plan_of(named, home_of(body), scene_.unit);
    }
    parts.push_back(std::move(part));
  }
  if (max_step_ < Tool::kNoLimit) max_step_ -= script_step;
  placed_ = HandBodies(scene_.unit, home_.pose, std::move(parts));
  placed_.set_time(0, period_);
}

// The device's plan in the scene; empty if it has none.
std::vector<Waypoint> Builder::plan() const {
  std::vector<Waypoint> plan;
  if (const auto* script = std::get_if<ScriptSettings>(&scene_.device)) plan = script->plan;
  if (const auto* hand = std::get_if<HandSettings>(&scene_.device)) plan = hand->plan;
  for (Waypoint& waypoint : plan) waypoint.pose = home_.moved(waypoint.pose);
  return plan;
}

void Builder::place_tool() {
  const std::vector<Waypoint> plan = this->plan();
  start_ = plan.empty() ? home_.pose : plan.front().pose;
  if (!finds_contacts()) {
    notes_.skip("free start", "no effect needs contacts");
    return;
  }
  const Eigen::Vector3d axis = scene_.open.value_or(Eigen::Vector3d::Zero());
  FreeStart start;
  std::vector<HandPair> asked;
  for (const HandPair& pair : pairs_) {
    if (!placed_.may_touch(pair.fixed, pair.held)) continue;
    const LoadedBody &fixed = bodies_[pair.fixed], &held = bodies_[pair.held];
    const BodyFrames frames = placed_.frames(pair.fixed, pair.held);
    const bool closed = fixed.outside_is_known && held.outside_is_known;
    start.add(*built_.trees[pair.fixed].contact, *built_.trees[pair.held].contact,
              closed ? fixed.mesh.get() : nullptr, closed ? held.mesh.get() : nullptr,
              frames.query_pose(start_), frames.fixed.rotation.transpose() * axis,
              voxels_ ? std::min(fixed.voxel_size, held.voxel_size) : held.diagonal / kOpenings);
    asked.push_back(pair);
  }
  for (const LoadedBody& body : bodies_) {
    if (body.mesh) continue;
    built_.warnings.push_back(
        fmt::format("{}: the tree has no triangles, so a start inside the other body cannot be "
                    "detected: build it without --no-triangles",
                    body.name));
  }
  const std::optional<FreeStart::Flaw> flaw = start.flaw();
  if (!flaw) return;
  const HandPair& pair = asked[flaw->pair];
  const std::string which = asked.size() == 1
                                ? "the bodies"
                                : fmt::format("{} and {}", bodies_[pair.fixed].named->name,
                                              bodies_[pair.held].named->name);
  const std::string how = flaw->way == FreeStart::Way::kIntersecting
                              ? fmt::format("{} intersect{},", which, start.place(*flaw))
                          : asked.size() == 1 ? "one body is inside the other"
                                              : fmt::format("of {} one is inside the other", which);
  if (!scene_.open) {
    fail_at(scene_, "held.open",
            fmt::format("{} where the device starts: name the axis along which they open in "
                        "[held], as open = \"-z\", or start elsewhere",
                        how));
  }
  const std::optional<double> way = start.open_distance();
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

// Lengths that a scene does not name are parts of the size of its largest body: a small tool may go
// as fast along a jaw as a jaw.
WallSettings Builder::wall_settings() const {
  constexpr double kSkins = 32'000, kTrusts = 8'000;
  double diagonal = 0;
  for (const LoadedBody& body : bodies_) {
    diagonal = std::max(diagonal, scene_.unit * body.diagonal);
  }
  const ContactSettings& contact = *scene_.contact;
  const auto length = [&](double asked, double part) {
    return asked > 0 ? scene_.unit * asked : diagonal / part;
  };
  return {length(contact.skin, kSkins), length(contact.trust, kTrusts), contact.steps,
          scene_.friction ? scene_.friction->coefficient : 0};
}

std::unique_ptr<Device> Builder::make_device() const {
  if (const auto* script = std::get_if<ScriptSettings>(&scene_.device)) {
    return make_script_device(plan(), script->mechanics);
  }
  if (const auto* hand = std::get_if<HandSettings>(&scene_.device)) {
    HandSettings settings = *hand;
    settings.plan = plan();
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
  const ClampedCoupling coupling =
      clamp_coupling(scene_.coupling, built_.device->mechanics(), period_);
  warn_of(coupling.damping, "coupling.damping", "N s/m");
  warn_of(coupling.stiffness, "coupling.stiffness", "N/m");
  warn_of(coupling.angular_damping, "coupling.angular_damping", "N m s/rad");
  warn_of(coupling.angular_stiffness, "coupling.angular_stiffness", "N m/rad");

  built_.step_limit = max_step_;
  detail::SimulationParts parts{.coupling = coupling.settings,
                                .safety = scene_.safety,
                                .max_step = max_step_,
                                .start = start_,
                                .dt = period_};
  if (scene_.contact) {
    const WallSettings settings = wall_settings();
    parts.wall.emplace(settings);
    built_.step_limit = settings.steps * settings.trust;
  }
  build_queries({scene_, bodies_, built_.trees, placed_, pairs_, period_}, needs_,
                PlanReach(plan(), start_), max_memory_, notes_, parts);
  for (const SceneChange& change : scene_.changes) {
    const auto body = std::find_if(bodies_.begin(), bodies_.end(), [&](const LoadedBody& each) {
      return each.named->name == change.body;
    });
    parts.changes.push_back(
        {change.time, static_cast<std::size_t>(body - bodies_.begin()), change.attach});
  }
  parts.bodies = std::move(placed_);
  parts.effects = std::move(effects_);
  built_.simulation = std::make_unique<Simulation>(detail::simulation_from(std::move(parts)));
}

Scene with_names(Scene scene) {
  const auto name_all = [](const char* key, std::vector<SceneBody>& bodies) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (bodies[i].name.empty()) bodies[i].name = path_of_body(key, i, bodies.size());
    }
  };
  name_all("fixed", scene.fixed);
  name_all("held", scene.held);
  return scene;
}

}  // namespace

BuiltScene build_scene(const Scene& scene, std::vector<std::unique_ptr<Effect>> own,
                       std::uint64_t max_memory, Progress* progress) {
  const ScopedFloatEnvironment environment;
  const Scene named = with_names(scene);
  check_scene(named);
  if (std::any_of(own.begin(), own.end(), [](const auto& effect) { return !effect; })) {
    throw Error(ErrorCode::kArgumentInvalid, "an own effect is null: give effects only");
  }
  return Builder(named, std::move(own), max_memory, progress).build();
}

}  // namespace ist
