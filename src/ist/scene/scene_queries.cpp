#include "ist/scene/scene_queries.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "ist/scene/scene_lines.h"

namespace ist {
namespace {

// "contact points", or of several pairs "contact points, splint – mandible".
std::string label_of(const PlacedBodies& of, const char* what, const HandPair& pair) {
  if (of.pairs.size() == 1) return what;
  return fmt::format("{}, {} – {}", what, of.bodies[pair.fixed].named->name,
                     of.bodies[pair.held].named->name);
}

std::unique_ptr<ToolContactQuery> contact_query(const PlacedBodies& of, const HandPair& pair) {
  const SphereTree &fixed = *of.trees[pair.fixed].contact, &held = *of.trees[pair.held].contact;
  const SpherePolicy policy =
      std::min(of.bodies[pair.fixed].named->spheres.value_or(fixed.tightest()),
               of.bodies[pair.held].named->spheres.value_or(held.tightest()));
  return std::make_unique<ToolContactQuery>(
      fixed, held, of.placed.frames(pair.fixed, pair.held),
      ToolContactOptions{
          .policy = policy,
          .least_depth = -of.scene.contact.value_or(ContactSettings()).margin,
          .workers = of.scene.workers,
          .period = std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * of.period))});
}

std::unique_ptr<ToolContactQuery> proximity_query(const PlacedBodies& of, const HandPair& pair) {
  return std::make_unique<ToolContactQuery>(
      *of.trees[pair.fixed].near, *of.trees[pair.held].coarse,
      of.placed.frames(pair.fixed, pair.held),
      ToolContactOptions{.policy = SpherePolicy::kTight, .least_depth = -2, .margin = 0});
}

}  // namespace

void build_queries(const PlacedBodies& of, const EffectNeeds& needs, const PlanReach& reach,
                   std::uint64_t max_memory, BuildNotes& notes, detail::SimulationParts& parts) {
  std::uint64_t bytes = 0;
  // Refuses the query that is one too many.
  const auto add = [&](PairQueries& queries, const HandPair& pair,
                       std::unique_ptr<ToolContactQuery> query) {
    bytes += query->bytes();
    if (bytes > max_memory) {
      const LoadedBody &fixed = of.bodies[pair.fixed], &held = of.bodies[pair.held];
      fail_at(of.scene, fixed.table,
              fmt::format("the queries up to that of {} and {} take {:.0f} MB, and {:.0f} MB are "
                          "allowed: allow more with --max-memory, or take bodies out",
                          fixed.named->name, held.named->name, 1e-6 * static_cast<double>(bytes),
                          1e-6 * static_cast<double>(max_memory)));
    }
    queries.add(pair, std::move(query));
  };
  // A body brakes the tool from this distance on: proximity voxels reach as far as the scene says,
  // and the leaves' cubes have a diagonal of less than that distance on either side.
  const double near = needs.proximity && of.scene.proximity ? 3 * of.scene.proximity->distance : 0;
  for (const HandPair& pair : of.pairs) {
    const LoadedBody &fixed = of.bodies[pair.fixed], &held = of.bodies[pair.held];
    const bool lasts =
        fixed.named->script.empty() && !fixed.named->attachable && !held.named->attachable;
    if (of.pairs.size() > 1 && lasts && needs.contacts() &&
        reach.keeps_apart(of.placed, pair, near)) {
      const char* why = "their roots stay apart wherever the plan leads";
      notes.skip(label_of(of, "contact points", pair), why);
      parts.contacts.add_far(pair);
      continue;
    }
    if (needs.contacts()) {
      const std::string why = fmt::format("for effects at contacts; up to {} leaf pairs are kept",
                                          ToolContactOptions().front_pairs);
      add(parts.contacts, pair, notes.make(label_of(of, "contact points", pair), why, [&] {
        return contact_query(of, pair);
      }));
    }
    if (needs.proximity) {
      add(parts.proximity, pair,
          notes.make(label_of(of, "proximity query", pair), "for effects.proximity",
                     [&] { return proximity_query(of, pair); }));
    }
  }
  if (!needs.contacts()) notes.skip("contact points", "no effect needs them");
  if (!needs.proximity) notes.skip("proximity query", "no effect needs it");
}

}  // namespace ist
