#include "loop/scene/scene_queries.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <string>

#include "ist/base/counted.h"
#include "loop/haptics/effects/proximity_effect.h"
#include "loop/scene/scene_lines.h"

namespace ist {
namespace {

// "contact points", or of several pairs "contact points, splint – mandible".
std::string label_of(const PlacedBodies& of, const char* what, const HandPair& pair) {
  if (of.pairs.size() == 1) return what;
  return fmt::format("{}, {} – {}", what, of.bodies[pair.fixed].named->name,
                     of.bodies[pair.held].named->name);
}

// A query of a pair before it is made.
struct PlannedQuery {
  const SphereTree &fixed, &held;
  ToolContactOptions options;
};

// The part of the tool's diagonal whose square is the default of SpringsSettings::full_area.
constexpr double kFullWidth = 1.0 / 160;

// The options of springs, whose lengths are in voxels.
ToolContactOptions options_of(const PlacedBodies& of, const SphereTree& fixed,
                              const SphereTree& held) {
  const SpringsSettings springs = of.scene.springs.value_or(SpringsSettings());
  const double unit = of.scene.unit;
  const double width = kFullWidth * of.bodies[of.scene.fixed.size()].diagonal;
  const double area =
      springs.full_area > 0 ? springs.full_area / (unit * unit) : width * width;  // mesh units²
  const double size = 0.5 * (fixed.voxel_size() + held.voxel_size());
  return {.margin = springs.margin / (unit * size),
          .full_area = area / (fixed.voxel_size() * held.voxel_size())};
}

PlannedQuery contact_query(const PlacedBodies& of, const HandPair& pair) {
  const SphereTree &fixed = *of.trees[pair.fixed].contact, &held = *of.trees[pair.held].contact;
  const SpherePolicy policy =
      std::min(of.bodies[pair.fixed].named->spheres.value_or(fixed.tightest()),
               of.bodies[pair.held].named->spheres.value_or(held.tightest()));
  ToolContactOptions options = options_of(of, fixed, held);
  options.policy = policy;
  options.workers = of.scene.workers;
  options.period = std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * of.period));
  return {fixed, held, options};
}

std::uint64_t bytes_of(const PlannedQuery& query) {
  return ToolContactQuery::bytes_for(query.fixed, query.held, query.options);
}

PlannedQuery proximity_query(const PlacedBodies& of, const HandPair& pair) {
  return {*of.trees[pair.fixed].near, *of.trees[pair.held].coarse,
          ToolContactOptions{.policy = SpherePolicy::kTight,
                             .margin = 2,
                             .full_area = ProximityEffect::kFullPairs,
                             .reach = 0}};
}

WallPair::Options wall_options(const PlacedBodies& of) {
  WallPair::Options options;
  options.workers = of.scene.workers;
  options.period = of.period;
  return options;
}

// Adds up what queries will reserve, before any of them is made, and refuses the one too many.
class QueryMemory {
 public:
  QueryMemory(const PlacedBodies& of, std::uint64_t most) : of_(of), most_(most) {}

  void add(const HandPair& pair, std::uint64_t bytes) {
    bytes_ += bytes;
    if (bytes_ <= most_) return;
    const LoadedBody &fixed = of_.bodies[pair.fixed], &held = of_.bodies[pair.held];
    fail_at(of_.scene, fixed.table,
            fmt::format("the queries up to that of {} and {} take {}, and {} are allowed: "
                        "allow more with --max-memory, or take bodies out",
                        fixed.named->name, held.named->name, in_bytes(bytes_), in_bytes(most_)));
  }

 private:
  const PlacedBodies& of_;
  std::uint64_t most_, bytes_ = 0;
};

}  // namespace

void build_queries(const PlacedBodies& of, const EffectNeeds& needs, const PlanReach& reach,
                   std::uint64_t max_memory, BuildNotes& notes, detail::SimulationParts& parts) {
  // A body brakes the tool from this distance on: proximity voxels reach as far as the scene says,
  // and the leaves' cubes have a diagonal of less than that distance on either side.
  const double near = needs.proximity && of.scene.proximity ? 3 * of.scene.proximity->distance : 0;
  const auto may_meet = [&](const HandPair& pair) {
    const LoadedBody &fixed = of.bodies[pair.fixed], &held = of.bodies[pair.held];
    const bool lasts =
        fixed.named->script.empty() && !fixed.named->attachable && !held.named->attachable;
    return of.pairs.size() == 1 || !lasts || !(parts.wall || needs.contacts()) ||
           !reach.keeps_apart(of.placed, pair, near);
  };
  QueryMemory memory(of, max_memory);
  std::vector<bool> meet;
  for (const HandPair& pair : of.pairs) {
    meet.push_back(may_meet(pair));
    if (!meet.back()) continue;
    if (parts.wall) {
      memory.add(pair, WallPair::bytes_for(*of.trees[pair.fixed].contact,
                                           *of.trees[pair.held].contact, wall_options(of)));
    } else if (needs.contacts()) {
      memory.add(pair, bytes_of(contact_query(of, pair)));
    }
    if (needs.proximity) memory.add(pair, bytes_of(proximity_query(of, pair)));
  }
  const auto make = [&](PairQueries& queries, const HandPair& pair, const char* what,
                        const std::string& why, const PlannedQuery& query) {
    queries.add(pair, notes.make(label_of(of, what, pair), why, [&] {
      return std::make_unique<ToolContactQuery>(
          query.fixed, query.held, of.placed.frames(pair.fixed, pair.held), query.options);
    }));
  };
  std::map<std::size_t, std::shared_ptr<const WallBody>> wall_bodies;
  const auto wall_body = [&](std::size_t body) {
    std::shared_ptr<const WallBody>& made = wall_bodies[body];
    if (!made) made = std::make_shared<const WallBody>(*of.trees[body].contact);
    return made;
  };
  for (std::size_t i = 0; i < of.pairs.size(); ++i) {
    const HandPair& pair = of.pairs[i];
    if (!meet[i]) {
      const char* why = "their roots stay apart wherever the plan leads";
      notes.skip(label_of(of, "contact points", pair), why);
      parts.wall ? parts.wall->add_far(pair) : parts.contacts.add_far(pair);
      continue;
    }
    if (parts.wall) {
      const char* why = "for effects.contact; near triangles are kept from tick to tick";
      parts.wall->add(pair, notes.make(label_of(of, "contact points", pair), why, [&] {
        return std::make_unique<WallPair>(wall_body(pair.fixed), wall_body(pair.held),
                                          wall_options(of));
      }));
    }
    if (needs.contacts() && !parts.wall) {
      const std::string why = fmt::format("for effects at contacts; up to {} leaf pairs are kept",
                                          ToolContactOptions().front_pairs);
      make(parts.contacts, pair, "contact points", why, contact_query(of, pair));
    }
    if (needs.proximity) {
      make(parts.proximity, pair, "proximity query", "for effects.proximity",
           proximity_query(of, pair));
    }
  }
  if (!needs.contacts() && !parts.wall) notes.skip("contact points", "no effect needs them");
  if (!needs.proximity) notes.skip("proximity query", "no effect needs it");
}

}  // namespace ist
