#include <cstring>

#include "ist/capi/handle.h"
#include "ist/capi/objects.h"
#include "ist/capi/sized_struct.h"

namespace ist::capi {
namespace {

constexpr std::uint64_t kMostPairs = std::uint64_t{1} << 26;
constexpr std::int64_t kMostPoints = 4096, kDefaultPoints = 32;

struct QueryOptions {
  CollisionOptions collision;
  std::size_t points = kDefaultPoints;  // 0: no contact points
};

ist_status check_query_options(const Call& call, const ist_query_options& known) {
  if (!are_spheres(known.spheres)) {
    return call.fail(IST_ARGUMENT_INVALID, "options->spheres is {}: take one of IST_SPHERES_...",
                     known.spheres);
  }
  if (known.workers < 0 || known.workers > 2) {
    return call.fail(IST_ARGUMENT_INVALID, "options->workers is {}: take 1 or 2", known.workers);
  }
  if (known.period_ns < -1) {
    return call.fail(IST_ARGUMENT_INVALID,
                     "options->period_ns is {}: take a number above 0, or -1 for at once",
                     known.period_ns);
  }
  if (known.frontier_pairs > kMostPairs || known.triangle_pairs > kMostPairs) {
    return call.fail(IST_ARGUMENT_INVALID,
                     "options->frontier_pairs is {}, triangle_pairs {}: {} is the most",
                     known.frontier_pairs, known.triangle_pairs, kMostPairs);
  }
  if (known.contact_points < -1 || known.contact_points > kMostPoints) {
    return call.fail(IST_ARGUMENT_INVALID,
                     "options->contact_points is {}: take 1 to {}, or -1 for none",
                     known.contact_points, kMostPoints);
  }
  return IST_OK;
}

ist_status read_query_options(const Call& call, const ist_query_options& given,
                              QueryOptions& options) {
  ist_query_options known;
  if (const ist_status wrong = read_sized(call, "options", given, known)) return wrong;
  if (const ist_status wrong = check_query_options(call, known)) return wrong;
  CollisionOptions& collision = options.collision;
  collision.policy = policy_of(known.spheres);
  if (known.target != nullptr) collision.target = known.target;
  if (known.frontier_pairs > 0) collision.frontier_pairs = known.frontier_pairs;
  if (known.triangle_pairs > 0) collision.triangle_pairs = known.triangle_pairs;
  if (known.workers > 0) collision.workers = known.workers;
  if (known.period_ns != 0) {
    collision.period = std::chrono::nanoseconds(std::max(known.period_ns, std::int64_t{0}));
  }
  if (known.contact_points != 0) {
    options.points = static_cast<std::size_t>(std::max(known.contact_points, std::int64_t{0}));
  }
  return IST_OK;
}

ist_query_info info_of(const Query& query) {
  ist_query_info info{};
  info.bytes = query.query.bytes() + (query.points ? query.points->bytes() : 0);
  info.contact_points = query.most_points;
  info.spheres = spheres_of(query.query.policy());
  info.workers = query.query.workers();
  info.exact = query.query.is_exact();
  std::strncpy(info.target, query.query.target(), sizeof(info.target) - 1);
  return info;
}

}  // namespace
}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_query_create(const ist_tree* fixed, const ist_tree* moving,
                            const ist_query_options* options, ist_query** query) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status missing = call.need({{"query", query}})) return missing;
    *query = nullptr;
    QueryOptions asked;
    if (options != nullptr) {
      if (const ist_status wrong = read_query_options(call, *options, asked)) return wrong;
    }
    const Held<Tree> held_fixed(call, "fixed", fixed);
    if (held_fixed.status() != IST_OK) return held_fixed.status();
    const Held<Tree> held_moving(call, "moving", moving);
    if (held_moving.status() != IST_OK) return held_moving.status();
    auto made = std::make_unique<Query>(held_fixed->tree, held_moving->tree, asked.collision);
    made->prepare_points(asked.points);
    return give(call, std::move(made), query);
  });
}

ist_status ist_query_get_info(ist_query* query, ist_query_info* info) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status wrong = clear_sized(call, "info", info)) return wrong;
    const Held<Query> held(call, "query", query);
    if (held.status() != IST_OK) return held.status();
    write_sized(info_of(*held), *info);
    return IST_OK;
  });
}

ist_status ist_query_free(ist_query* query) IST_NOEXCEPT {
  return give_back<Query>(__func__, query);
}
