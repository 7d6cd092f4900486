#include "ist/query/world/world.h"

#include <fmt/format.h>

#include <algorithm>

#include "ist/base/error.h"
#include "ist/base/pose.h"
#include "ist/base/throw_error.h"
#include "ist/query/world/world_state.h"
#include "ist/tree/mesh_source.h"
#include "ist/tree/tree_parts.h"
#include "simd/dispatch.h"

namespace ist {
namespace {

static_assert(kMostThreads == ResidentWorker::kMost + 1);

WorldOptions in_range(const WorldOptions& options) {
  const auto refuse = [](const std::string& what) {
    throw Error(ErrorCode::kArgumentInvalid, "world option " + what);
  };
  if (options.query.workers != 1) {
    refuse(fmt::format(
        "query.workers is {}: give 1, and the threads of the world by its option threads",
        options.query.workers));
  }
  if (!(options.reach >= 0 && options.reach <= std::numeric_limits<double>::max())) {
    refuse(fmt::format("reach is {}: give a finite number of at least 0", options.reach));
  }
  if (options.threads < 1 || options.threads > kMostThreads) {
    refuse(fmt::format("threads is {}: give 1 to {}", options.threads, kMostThreads));
  }
  if (options.query.front_pairs > kMostItems) {
    refuse(fmt::format("query.front_pairs is {}: {} is the most", options.query.front_pairs,
                       kMostItems));
  }
  static_cast<void>(select_kernels(options.query.target));
  return options;
}

}  // namespace

namespace detail {
WorldState::WorldState(const WorldOptions& given) : options(in_range(given)) {}
}  // namespace detail

World::World(const WorldOptions& options) : state_(std::make_unique<detail::WorldState>(options)) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

BodyIndex World::add(const SphereTree& tree, const Eigen::Isometry3d& pose, std::string name) {
  const ScopedFloatEnvironment environment;
  detail::WorldState& s = *state_;
  const std::size_t index = s.bodies.size();
  if (name.empty()) name = fmt::format("body {}", index);
  if (index == kMostBodies) {
    throw_error(ErrorCode::kArgumentInvalid, "world: no room for '{}': {} bodies are the most",
                name, kMostBodies);
  }
  for (const auto& at : {s.with_frame, s.with_unit}) {
    if (!at) continue;
    const detail::WorldState::Body& other = s.bodies[*at];
    const std::string reason =
        contradiction(tree, fmt::format("'{}'", name), other.tree, fmt::format("'{}'", other.name));
    if (!reason.empty()) throw Error(ErrorCode::kArgumentInvalid, "world: " + reason);
  }
  SearchPlan::require_addresses(tree, name);
  if (s.options.query.policy) tree.require(*s.options.query.policy, name);
  if (!body_pose(pose)) {
    throw_error(ErrorCode::kPoseInvalid, "world: the pose of '{}' is no rigid motion: {}", name,
                why_not_rigid(pose));
  }
  if (index == s.bodies.capacity()) {
    s.broad.reserve(2 * index + 8);
    s.bodies.reserve(2 * index + 8);
  }
  const auto& [parts, facts] = *s.facts.try_emplace(&parts_of(tree), tree).first;
  s.broad.add();                                                   // nothing fails from here on
  s.bodies.push_back({tree, &facts, std::move(name), {}, {}, 0});  // zeros are no motion
  s.ready = false;
  const auto number = static_cast<BodyIndex>(index);
  if (!s.with_frame && tree.frame() != PatientFrame::kUnknown) s.with_frame = number;
  if (!s.with_unit && tree.source().unit != LengthUnit::kUnknown) s.with_unit = number;
  s.move(number, pose);
  return number;
}

void World::ignore(BodyIndex a, BodyIndex b) {
  detail::WorldState& s = *state_;
  s.ignored.add(s.checked(a, b));
  s.stale = true;
  s.reserved.felt.clear();
}

std::uint64_t World::bytes_needed(std::size_t near_pairs) const {
  const ScopedFloatEnvironment environment;
  return state_->bytes_for(state_->room_for(near_pairs), state_->sizes(),
                           std::numeric_limits<std::uint64_t>::max());
}

void World::reserve(std::size_t near_pairs) {
  const ScopedFloatEnvironment environment;
  state_->reserve(near_pairs);
}

QueryStatus World::set_pose(BodyIndex body, const Eigen::Isometry3d& pose) noexcept {
  const ScopedFloatEnvironment environment;
  detail::WorldState& s = *state_;
  const detail::Use use(s);
  if (!use) return QueryStatus::kBusy;
  if (!s.is_there(body)) return QueryStatus::kNoSuchBody;
  s.move(body, pose);
  return s.broad.has(body) ? QueryStatus::kDone : QueryStatus::kInvalidPose;
}

void World::forget() noexcept {
  detail::WorldState& s = *state_;
  const detail::Use use(s);
  if (!use) return;
  s.reserved.memories.clear();
  s.reserved.slots.forget();
}

std::optional<Eigen::Isometry3d> World::pose_of(BodyIndex a, BodyIndex b) const noexcept {
  const ScopedFloatEnvironment environment;
  const detail::WorldState& s = *state_;
  if (!s.is_there(a) || !s.is_there(b) || !s.broad.has(a) || !s.broad.has(b)) return std::nullopt;
  return to_isometry(between(s.bodies[a].pose, s.bodies[b].pose));
}

BodyIndex World::body_count() const noexcept {
  return static_cast<BodyIndex>(state_->bodies.size());
}

std::string_view World::name(BodyIndex body) const noexcept {
  return state_->is_there(body) ? std::string_view(state_->bodies[body].name) : std::string_view();
}

std::uint64_t World::bytes() const noexcept { return state_->reserved.bytes; }

}  // namespace ist
