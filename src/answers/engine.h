#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ist/query/query.h"
#include "ist/query/reference/reference_query.h"

namespace ist::answers {

/// The values of --engine, the default first.
inline constexpr std::array kEngineNames = {"simd", "reference"};

/// The options of an engine. All but the policy apply to simd alone.
struct EngineOptions {
  SpherePolicy policy = SpherePolicy::kTable;
  std::string target = {};  ///< instruction set; empty: IST_TARGET's, or the best
  int workers = 1;
  std::optional<std::uint64_t> max_tests = {};  ///< most sphere tests of a query
};

/// A query of leaf pairs on a pair of trees, with a span that grows until every pair fits.
class Engine {
 public:
  struct Answer {
    QueryResult result;
    double microseconds;  ///< of the query alone, with a span that is large enough
  };

  /// Makes the engine of a name in kEngineNames; both trees must outlive it. Throws kPolicyMissing,
  /// kTargetMissing, kMemoryLimit.
  Engine(std::string_view name, const SphereTree& fixed, const SphereTree& moving,
         const EngineOptions& options);

  [[nodiscard]] std::string_view name() const { return kEngineNames[simd_ ? 0 : 1]; }
  [[nodiscard]] std::string_view target() const;
  /// Returns whether the engine finds all pairs of leaves whose bounds overlap.
  [[nodiscard]] bool nested() const { return nested_; }
  [[nodiscard]] int workers() const { return simd_ ? simd_->workers() : 1; }
  [[nodiscard]] Answer ask(const Eigen::Isometry3d& pose);
  /// Returns all leaf pairs of the last answer.
  [[nodiscard]] std::span<const LeafPair> leaf_pairs() const {
    return {leaf_pairs_.data(), count_};
  }

 private:
  std::optional<Query> simd_;
  std::optional<ReferenceQuery> reference_;  // exactly one of both
  bool nested_ = true;
  Budget budget_;
  std::vector<LeafPair> leaf_pairs_ = std::vector<LeafPair>(1 << 16);
  std::size_t count_ = 0;
};

using Engines = std::vector<Engine>;

/// Returns the instruction sets of simd that this processor has, best first: "avx3, avx2, …".
[[nodiscard]] std::string target_names();

}  // namespace ist::answers
