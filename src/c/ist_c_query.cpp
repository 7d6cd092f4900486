#include <cstring>

#include "c/objects.h"

namespace ist::capi {
namespace {

constexpr std::uint64_t kMostPairs = std::uint64_t{1} << 26;
constexpr std::int64_t kMostContacts = 4096;
constexpr double kMostMargin = 2;

void check_query_options(Call& call, const ist_query_options& known) {
  if (!are_spheres(known.spheres)) {
    call.fail(IST_ARGUMENT_INVALID, "options->spheres is {}: pass one of IST_SPHERES_...",
              known.spheres);
  }
  if (known.workers < 0 || known.workers > 2) {
    call.fail(IST_ARGUMENT_INVALID, "options->workers is {}: pass 1 or 2, or 0 for the default",
              known.workers);
  }
  if (known.period_ns < -1) {
    call.fail(IST_ARGUMENT_INVALID,
              "options->period_ns is {}: pass a number above 0, 0 for 1 ms, or -1 for no pause",
              known.period_ns);
  }
  if (std::max({known.frontier_pairs, known.front_pairs, known.near_pairs}) > kMostPairs) {
    call.fail(IST_ARGUMENT_INVALID,
              "options->frontier_pairs is {}, front_pairs is {} and near_pairs is {}: pass at most "
              "{}",
              known.frontier_pairs, known.front_pairs, known.near_pairs, kMostPairs);
  }
  if (known.contacts < -1 || known.contacts > kMostContacts) {
    call.fail(IST_ARGUMENT_INVALID,
              "options->contacts is {}: pass 1 to {}, 0 for the default, or -1 for no contacts",
              known.contacts, kMostContacts);
  }
  if (!(known.margin >= 0 && known.margin <= kMostMargin)) {
    call.fail(
        IST_ARGUMENT_INVALID,
        "options->margin is {}: pass a number from 0, where surfaces meet, to {} mean voxel sizes",
        known.margin, kMostMargin);
  }
}

ist_query_info query_info_of(const QueryObject& query) {
  ist_query_info info{};
  info.bytes = query.query.bytes() + (query.manifold ? query.manifold->bytes() : 0);
  info.contacts = query.max_contacts;
  info.spheres = spheres_of(query.query.policy(), query.has_voxels());
  info.workers = query.query.workers();
  info.has_triangles = query.query.has_triangles();
  std::strncpy(info.target, query.query.target(), sizeof(info.target) - 1);
  return info;
}

}  // namespace

CQueryOptions read_query_options(Call& call, const ist_query_options* given) {
  const ist_query_options known = read_sized(call, "options", given);
  check_query_options(call, known);
  CQueryOptions options;
  if (given == nullptr || call.status() != IST_OK) return options;
  QueryOptions& query = options.query;
  query.policy = policy_of(known.spheres);
  if (known.target != nullptr) query.target = known.target;
  if (known.frontier_pairs > 0) query.frontier_pairs = known.frontier_pairs;
  query.front_pairs = known.front_pairs;
  query.near_pairs = known.near_pairs;
  if (known.workers > 0) query.workers = known.workers;
  if (known.period_ns != 0) {
    query.period = std::chrono::nanoseconds(std::max(known.period_ns, std::int64_t{0}));
  }
  if (known.contacts < 0) {
    options.manifold.reset();
    return options;
  }
  if (known.contacts > 0) options.manifold->points = static_cast<std::size_t>(known.contacts);
  options.manifold->margin = known.margin;
  return options;
}

}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_query_create(const ist_tree* fixed, const ist_tree* moving,
                            const ist_query_options* options, ist_query** query) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.clear("query", query);
    const CQueryOptions asked = read_query_options(call, options);
    const Held<Tree> held_fixed(call, "fixed", fixed);
    const Held<Tree> held_moving(call, "moving", moving);
    if (!held_moving) return;
    give(call,
         std::make_unique<QueryObject>(held_fixed->tree, held_moving->tree, asked.query,
                                       asked.manifold),
         query);
  });
}

ist_status ist_query_get_info(ist_query* query, ist_query_info* info) IST_NOEXCEPT {
  return get_info<QueryObject>(__func__, query, info, query_info_of);
}

ist_status ist_query_free(ist_query* query) IST_NOEXCEPT {
  return give_back<QueryObject>(__func__, query);
}
