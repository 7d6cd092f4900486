
#include <algorithm>
#include <map>
#include <utility>

#include "ist/base/cancellation.h"
#include "ist/base/counted.h"
#include "ist/base/error.h"
#include "ist/base/throw_error.h"
#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/world/world_state.h"
#include "ist/tree/tree_parts.h"

namespace ist::detail {
namespace {

constexpr double kMegabyte = 1e6;

// The bytes of the queries and manifolds of pairs: those of the same trees take the same.
class PairBytes {
 public:
  explicit PairBytes(const WorldOptions& options) : options_(options) {}

  std::uint64_t of(const SphereTree& a, const SphereTree& b) {
    const auto [at, is_new] = known_.try_emplace({&parts_of(a), &parts_of(b)}, 0);
    if (is_new) {
      at->second = QueryState::bytes_for(a, b, options_.query);
      if (a.has_voxels() && b.has_voxels()) {
        at->second += ContactReducer::bytes_for(a, b, options_.manifold);
      }
    }
    return at->second;
  }

 private:
  const WorldOptions& options_;
  std::map<std::pair<const TreeParts*, const TreeParts*>, std::uint64_t> known_;
};

}  // namespace

std::uint64_t WorldState::Answers::bytes_for(std::size_t room) noexcept {
  return std::uint64_t{room} *
         (sizeof(PairAtPose) + 16 + sizeof(Candidate) + 2 * sizeof(WorldPair));
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

std::vector<BodyPair> WorldState::checked(std::span<const BodyPair> pairs) const {
  std::vector<BodyPair> in_order;
  for (const auto& [a, b] : pairs) {
    const BodyPair pair = checked(a, b);
    if (table[pair] == PairTable::kIgnored) {
      throw_error(ErrorCode::kArgumentInvalid,
                  "world: the pair of '{}' and '{}' is ignored: it cannot be prepared",
                  bodies[pair.a].name, bodies[pair.b].name);
    }
    in_order.push_back(pair);
  }
  std::sort(in_order.begin(), in_order.end());
  in_order.erase(std::unique(in_order.begin(), in_order.end()), in_order.end());
  return in_order;
}

std::vector<BodyPair> WorldState::all_pairs() const {
  std::vector<BodyPair> all;
  const auto count = static_cast<BodyIndex>(bodies.size());
  for (BodyIndex a = 0; a < count; ++a) {
    for (BodyIndex b = a + 1; b < count; ++b) {
      if (table[{a, b}] != PairTable::kIgnored) all.push_back({a, b});
    }
  }
  return all;
}

std::size_t WorldState::room_for(std::size_t prepared) const noexcept {
  return std::min(table.size(), std::max<std::size_t>(prepared + options.most_near, 1));
}

std::uint64_t WorldState::bytes_of(BodyPair pair) const {
  return PairBytes(options).of(bodies[pair.a].tree, bodies[pair.b].tree);
}

std::uint64_t WorldState::bytes_for(std::span<const BodyPair> pairs, std::uint64_t limit) const {
  const std::size_t room = room_for(pairs.size());
  std::uint64_t sum = Answers::bytes_for(room);
  const auto megabytes = [](std::uint64_t bytes) { return static_cast<double>(bytes) / kMegabyte; };
  if (sum > limit) {
    throw_error(ErrorCode::kMemoryLimit,
                "world: answers of up to {} pairs take {:.1f} MB, and max_memory is "
                "{:.1f} MB: lower most_near, or raise max_memory",
                room, megabytes(sum), megabytes(limit));
  }
  PairBytes bytes_of(options);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    cancellation_point();
    const Body &a = bodies[pairs[k].a], &b = bodies[pairs[k].b];
    const std::uint64_t bytes = bytes_of.of(a.tree, b.tree);
    sum += bytes;
    if (sum <= limit) continue;
    throw_error(ErrorCode::kMemoryLimit,
                "world: the pair of '{}' and '{}' takes {:.1f} MB, which with {} before "
                "it makes {:.1f} MB, and max_memory is {:.1f} MB: prepare fewer pairs, ignore "
                "some, lower query.frontier_pairs or manifold.max_leaves, or raise max_memory",
                a.name, b.name, megabytes(bytes), counted(k, "pair"), megabytes(sum),
                megabytes(limit));
  }
  return sum;
}

void WorldState::prepare(std::span<const BodyPair> pairs, const Proceed& proceed) {
  static_cast<void>(bytes_for(pairs, options.max_memory));
  // All that may fail comes first.
  std::vector<std::unique_ptr<PairMemory>> next(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (proceed && !proceed(static_cast<double>(k) / static_cast<double>(pairs.size()))) {
      throw Error(ErrorCode::kCancelled, "world: prepare() was ended by its caller");
    }
    const auto [a, b] = pairs[k];
    if (table[pairs[k]] != PairTable::kNoQuery) continue;
    next[k] = std::make_unique<PairMemory>(pairs[k], bodies[a], bodies[b], options);
  }
  const std::size_t room = room_for(pairs.size());
  if (room != answers.room) answers = Answers(room);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (!next[k]) next[k] = std::move(made[table[pairs[k]]]);
  }
  table.clear();
  made = std::move(next);
  for (std::size_t k = 0; k < pairs.size(); ++k) table[pairs[k]] = static_cast<std::uint32_t>(k);
  ready = stale = true;
  ++felt;
}

}  // namespace ist::detail
