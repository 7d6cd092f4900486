#include "ist/query/world/world.h"

#include <fmt/format.h>

#include <algorithm>

#include "ist/base/error.h"
#include "ist/base/pose.h"
#include "ist/base/throw_error.h"
#include "ist/query/world/world_state.h"
#include "ist/tree/mesh_source.h"
#include "simd/dispatch.h"

namespace ist {
namespace {

WorldOptions in_range(const WorldOptions& options) {
  const auto refuse = [](const std::string& what) {
    throw Error(ErrorCode::kArgumentInvalid, "world option " + what);
  };
  if (options.query.workers != 1) {
    refuse(fmt::format("query.workers is {}: give 1; each pair would have a thread of its own",
                       options.query.workers));
  }
  if (!(options.reach >= 0 && options.reach <= std::numeric_limits<double>::max())) {
    refuse(fmt::format("reach is {}: give a finite number of at least 0", options.reach));
  }
  if (options.most_near > kMostItems) {
    refuse(fmt::format("most_near is {}: {} is the most", options.most_near, kMostItems));
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
  for (const detail::WorldState::Body& other : s.bodies) {
    const std::string reason =
        contradiction(tree, fmt::format("'{}'", name), other.tree, fmt::format("'{}'", other.name));
    if (!reason.empty()) throw Error(ErrorCode::kArgumentInvalid, "world: " + reason);
  }
  if (s.options.query.policy) tree.require(*s.options.query.policy, name);
  if (!body_pose(pose)) {
    throw_error(ErrorCode::kPoseInvalid, "world: the pose of '{}' is no rigid motion: {}", name,
                why_not_rigid(pose));
  }
  if (index == s.bodies.capacity()) {
    s.broad.reserve(2 * index + 8);
    s.bodies.reserve(2 * index + 8);
  }
  s.table.add();  // the last that may fail
  s.broad.add();
  s.bodies.push_back({tree, std::move(name), {}, {}, 0});  // zeros are no motion
  s.ready = false;
  const auto number = static_cast<BodyIndex>(index);
  s.move(number, pose);
  return number;
}

void World::ignore(BodyIndex a, BodyIndex b) {
  detail::WorldState& s = *state_;
  std::uint32_t& place = s.table[s.checked(a, b)];
  if (place < PairTable::kIgnored) s.made[place].reset();
  place = PairTable::kIgnored;
  s.stale = true;
  ++s.felt;
}

std::uint64_t World::bytes_for(BodyIndex a, BodyIndex b) const {
  const ScopedFloatEnvironment environment;
  return state_->bytes_of(state_->checked(a, b));
}
std::uint64_t World::bytes_needed() const {
  const ScopedFloatEnvironment environment;
  return state_->bytes_for(state_->all_pairs(), std::numeric_limits<std::uint64_t>::max());
}
std::uint64_t World::bytes_needed(std::span<const BodyPair> pairs) const {
  const ScopedFloatEnvironment environment;
  return state_->bytes_for(state_->checked(pairs), std::numeric_limits<std::uint64_t>::max());
}

void World::prepare() {
  const ScopedFloatEnvironment environment;
  state_->prepare(state_->all_pairs(), {});
}
void World::prepare(std::span<const BodyPair> pairs) {
  const ScopedFloatEnvironment environment;
  state_->prepare(state_->checked(pairs), {});
}
void World::prepare(std::optional<std::span<const BodyPair>> pairs, const Proceed& proceed) {
  const ScopedFloatEnvironment environment;
  state_->prepare(pairs ? state_->checked(*pairs) : state_->all_pairs(), proceed);
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
  for (const auto& memory : s.made) {
    if (memory) memory->query.forget();
  }
}

std::optional<Eigen::Isometry3d> World::pose_of(BodyIndex a, BodyIndex b) const noexcept {
  const ScopedFloatEnvironment environment;
  const detail::WorldState& s = *state_;
  if (!s.is_there(a) || !s.is_there(b) || !s.broad.has(a) || !s.broad.has(b)) return std::nullopt;
  return to_isometry(between(s.bodies[a].pose, s.bodies[b].pose));
}

Query* World::query(BodyIndex a, BodyIndex b) noexcept {
  detail::WorldState::PairMemory* const memory = state_->find(a, b);
  return memory != nullptr ? &memory->query : nullptr;
}

BodyIndex World::body_count() const noexcept {
  return static_cast<BodyIndex>(state_->bodies.size());
}

std::string_view World::name(BodyIndex body) const noexcept {
  return state_->is_there(body) ? std::string_view(state_->bodies[body].name) : std::string_view();
}

std::uint64_t World::bytes() const noexcept {
  std::uint64_t sum = detail::WorldState::Answers::bytes_for(state_->answers.room);
  for (const auto& memory : state_->made) {
    if (!memory) continue;
    sum += memory->query.bytes() + (memory->manifold ? memory->manifold->bytes() : 0);
  }
  return sum;
}

}  // namespace ist
