#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ist/query/reference/reference_query.h"
#include "query/scenes.h"
#include "simd/targets.h"

namespace ist::test {

/// A finder of leaf pairs: the published query with spheres of one source, or the fast one.
struct Engine {
  SpherePolicy policy;
  std::optional<SphereSource> published = {};  ///< nothing: the fast one
  std::string target = {};                     ///< of the fast one; "": the best
  int workers = 1;                             ///< of the fast one

  /// The relative size of the last bit of the numbers that it decides with.
  [[nodiscard]] double last_bit() const { return published ? 0x1p-53 : 0x1p-24; }
  /// Whether its bounds are nested.
  [[nodiscard]] bool nested() const { return !published || published_are_nested(policy); }
};

/// For tests with an engine as their parameter.
[[nodiscard]] inline std::string engine_name(const ::testing::TestParamInfo<Engine>& info) {
  const Engine& engine = info.param;
  std::string name(to_string(engine.policy));
  if (engine.published) name += "Published";
  if (engine.published == SphereSource::kSaved) name += "Saved";
  if (!engine.target.empty()) name += "_" + engine.target;
  return name;
}

/// The fast engine of each target in `targets`, and the published one with each source of spheres.
[[nodiscard]] inline std::vector<Engine> engines_of(SpherePolicy policy,
                                                    const std::vector<std::string>& targets) {
  std::vector<Engine> engines;
  for (const std::string& target : targets) engines.push_back({policy, {}, target});
  engines.push_back({policy, SphereSource::kOnTheFly});
  engines.push_back({policy, SphereSource::kSaved});
  return engines;
}

/// The engines of these targets, of every policy.
[[nodiscard]] inline std::vector<Engine> engines_of(const std::vector<std::string>& targets) {
  std::vector<Engine> engines;
  for (const SpherePolicy policy : kSpherePolicies) {
    for (const Engine& engine : engines_of(policy, targets)) engines.push_back(engine);
  }
  return engines;
}

/// A query by any engine.
class EngineQuery {
 public:
  EngineQuery(const SphereTree& fixed, const SphereTree& moving, const Engine& engine)
      : query_(made(fixed, moving, engine)) {}

  [[nodiscard]] QueryResult leaf_pairs(const Eigen::Isometry3d& pose, std::span<LeafPair> out) {
    return std::visit([&](auto& query) { return query.leaf_pairs(pose, out); }, query_);
  }

 private:
  using Any = std::variant<Query, ReferenceQuery>;
  [[nodiscard]] static Any made(const SphereTree& fixed, const SphereTree& moving,
                                const Engine& engine) {
    if (engine.published) return ReferenceQuery(fixed, moving, engine.policy, *engine.published);
    return Query(fixed, moving, options_of(engine.policy, engine.target, engine.workers));
  }
  Any query_;
};

}  // namespace ist::test
