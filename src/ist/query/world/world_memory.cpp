#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "ist/base/access.h"
#include "ist/base/counted.h"
#include "ist/base/error.h"
#include "ist/base/throw_error.h"
#include "ist/query/world/world_state.h"

namespace ist::detail {
namespace {

// Returns the number of pair caches for so many pairs.
std::size_t slots_for(std::size_t room, const AskerRoom& sizes,
                      const WorldOptions& options) noexcept {
  if (!sizes.has_leaves() || options.query.front_pairs == 0) return 0;
  return std::min(room, options.pair_caches);
}

// Returns the bytes of one near pair.
std::uint64_t bytes_of_pair(const AskerRoom& sizes, const WorldOptions& options) noexcept {
  const std::uint64_t bytes = sizeof(PairAtPose) + 16 + PairMemories::bytes_for(1) +
                              sizeof(WorldState::Candidate) + 2 * sizeof(WorldPair) +
                              sizeof(WorldState::Felt);
  if (!sizes.has_leaves()) return bytes;
  return bytes + sizeof(ContactManifold) + sizeof(ContactReducer) +
         options.manifold.points * sizeof(Contact);
}

}  // namespace

WorldState::Reserved::Reserved(std::size_t most, WorldState& world, const AskerRoom& sizes)
    : room(most),
      bytes(world.bytes_for(most, sizes, world.options.max_memory)),
      near(most),
      memories(most),
      pairs(most),
      nearest(most) {
  candidates.reserve(most);
  felt.reserve(most);
  if (sizes.any == nullptr) return;
  const WorldOptions& given = world.options;
  if (sizes.has_leaves()) {
    const SphereTree& tree = *sizes.query.voxels;
    const SpherePolicy policy = QueryState::policy_of(tree, tree, given.query);
    manifolds.reserve(most);
    for (std::size_t k = 0; k < most; ++k) {
      manifolds.push_back(Access::made_of<ContactManifold>(
          std::make_unique<ContactReducer>(tree, policy, given.manifold)));
    }
  }
  slots = CacheSlots(slots_for(most, sizes, given), sizes, given);
  for (std::size_t k = 0; k < given.threads; ++k) {
    askers.push_back(std::make_unique<PairAsker>(sizes, given));
  }
  pool = std::make_unique<ResidentPool>(given.threads - 1, &world,
                                        [](void* self, std::size_t thread, std::size_t k) noexcept {
                                          WorldState& asked = *static_cast<WorldState*>(self);
                                          asked.ask_pair(thread, k, asked.round.budget);
                                        });
}

BodyPair WorldState::checked(BodyIndex a, BodyIndex b) const {
  for (const BodyIndex body : {a, b}) {
    if (is_there(body)) continue;
    throw_error(ErrorCode::kArgumentInvalid, "world: body {} is not there: {} added, from 0 on",
                body, counted(bodies.size(), "body was", "bodies were"));
  }
  if (a == b) {
    throw_error(ErrorCode::kArgumentInvalid, "world: '{}' is no pair with itself: give two bodies",
                bodies[a].name);
  }
  return {std::min(a, b), std::max(a, b)};
}

std::size_t WorldState::room_for(std::size_t near_pairs) const noexcept {
  const std::size_t count = bodies.size();
  const std::size_t all = count > 0 ? count * (count - 1) / 2 - ignored.size() : 0;
  return std::max<std::size_t>(1, std::min(near_pairs, all));
}

AskerRoom WorldState::sizes() const {
  require_answers();
  std::vector<AskedBody> all;
  all.reserve(bodies.size());
  for (const Body& body : bodies) all.push_back({body.tree, *body.facts});
  return AskerRoom::of(all, options);
}

void WorldState::require_answers() const {
  std::vector<BodyIndex> without_voxels, without_triangles;
  for (BodyIndex k = 0; k < bodies.size(); ++k) {
    if (!bodies[k].tree.has_voxels()) without_voxels.push_back(k);
    if (bodies[k].tree.triangles() == nullptr) without_triangles.push_back(k);
  }
  for (const BodyIndex a : without_voxels) {
    for (const BodyIndex b : without_triangles) {
      if (ignored.has({std::min(a, b), std::max(a, b)})) continue;
      const auto quoted = [&](BodyIndex k) { return fmt::format("'{}'", bodies[k].name); };
      const std::string nothing =
          lacks_common(bodies[a].tree, quoted(a), bodies[b].tree, quoted(b));
      throw Error(ErrorCode::kVoxelsMissing, "world: " + nothing);
    }
  }
}

std::uint64_t WorldState::bytes_for(std::size_t room, const AskerRoom& sizes,
                                    std::uint64_t limit) const {
  ContactReducer::check(options.manifold);
  const std::uint64_t of_pairs = std::uint64_t{room} * bytes_of_pair(sizes, options);
  std::uint64_t of_threads = 0, of_caches = 0;
  if (sizes.any != nullptr) {
    of_threads = std::uint64_t{options.threads} * PairAsker::bytes_for(sizes, options);
    if (const std::size_t slots = slots_for(room, sizes, options); slots > 0) {
      of_caches = std::uint64_t{slots} * CacheSlot::bytes_for(sizes, options);
    }
  }
  const std::uint64_t sum = of_pairs + of_threads + of_caches;
  if (sum <= limit) return sum;
  // C and Python have options of the same names.
  throw_error(ErrorCode::kMemoryLimit,
              "world: {} for {}, {} for {} and {} for {} are more than max_memory, {}: reserve for "
              "fewer pairs, lower frontier_pairs, front_pairs or pair_caches, keep fewer contacts, "
              "or raise max_memory",
              in_bytes(of_pairs), counted(room, "near pair"), in_bytes(of_threads),
              counted(options.threads, "thread"), in_bytes(of_caches),
              counted(slots_for(room, sizes, options), "pair cache"), in_bytes(limit));
}

void WorldState::reserve(std::size_t near_pairs) {
  Reserved next(room_for(near_pairs), *this, sizes());  // all that may fail
  reserved = std::move(next);
  ready = stale = true;
}

}  // namespace ist::detail
