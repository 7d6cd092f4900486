#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "answers/bodies.h"
#include "answers/engine.h"
#include "answers/examiner.h"
#include "ist/query/query.h"
#include "viewer/engine/reply.h"

namespace ist::viewer {

/// Answers questions about two trees under one policy of spheres, and holds the memory for them.
class Pair {
 public:
  /// Reserves all memory. Throws as Query does.
  explicit Pair(const answers::Bodies& bodies);

  /// Answers as `ist collide --json` does: "header", "line", and "microseconds", the median of
  /// groups of queries that are timed together, for a page's clock is coarse.
  [[nodiscard]] nlohmann::ordered_json collide(const Eigen::Isometry3d& pose);

  /// Answers what a frame of dragging shows: Tick of page/protocol.js.
  /// @param stiffness of the contacts' springs, force a mesh unit³
  void tick(const Eigen::Isometry3d& pose, double stiffness, Reply& reply);

  [[nodiscard]] Query& query() noexcept { return query_; }
  [[nodiscard]] const answers::Bodies& bodies() const noexcept { return bodies_; }

 private:
  answers::Bodies bodies_;
  answers::Engines engines_;
  answers::Examiner examiner_;
  Query query_;
  ContactManifold manifold_;
};

/// The pairs of two trees, by policy, each made when it is first asked.
class Pairs {
 public:
  explicit Pairs(answers::Bodies bodies) : bodies_(std::move(bodies)) {}

  /// Throws kPolicyMissing. @param policy nothing: the tightest that both trees have
  [[nodiscard]] Pair& of(std::optional<SpherePolicy> policy);
  [[nodiscard]] const answers::Bodies& bodies() const noexcept { return bodies_; }

 private:
  answers::Bodies bodies_;
  std::array<std::optional<Pair>, kSpherePolicies.size()> pairs_;
};

}  // namespace ist::viewer
