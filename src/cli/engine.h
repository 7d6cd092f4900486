#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ist/query/contact.h"
#include "ist/tree/sphere_tree.h"

namespace ist::cli {

/// The names that --engine takes, the default first.
inline constexpr std::array kEngineNames = {"simd", "reference"};

/// What an engine is made with, beside the trees. All but the policy are simd's alone.
struct EngineOptions {
  SpherePolicy policy;
  std::string target;  ///< empty: IST_TARGET's, or the best
  int workers = 1;
  bool exact = false;                           ///< triangles too, and who is inside whom
  std::optional<std::uint64_t> max_tests = {};  ///< that a query may make
  std::optional<double> gap = {};               ///< the tolerance of the gap, if it is asked for
};

/// One query on one pair of trees, with a span that grows until every contact fits.
class Engine {
 public:
  struct Answer {
    QueryResult result;
    double microseconds;  ///< of the query alone, the spans long enough; the gap's is not counted
    std::optional<std::uint64_t> triangle_pairs;  ///< where they were asked for
    std::optional<GapInterval> gap;               ///< where it was asked for
  };

  virtual ~Engine() = default;

  [[nodiscard]] virtual std::string_view name() const = 0;
  [[nodiscard]] virtual std::string_view target() const = 0;
  [[nodiscard]] virtual int workers() const = 0;
  [[nodiscard]] virtual double resolution(const QueryResult& result) const = 0;

  [[nodiscard]] virtual Answer ask(const Eigen::Isometry3d& pose) = 0;
  /// Of the last answer, all of them.
  [[nodiscard]] std::span<const Contact> contacts() const { return {contacts_.data(), count_}; }

 protected:
  std::vector<Contact> contacts_ = std::vector<Contact>(1 << 16);
  std::size_t count_ = 0;
};

/// `name` is one of kEngineNames; both trees must outlive it. Throws kPolicyMissing,
/// kTargetMissing, kMemoryLimit.
[[nodiscard]] std::unique_ptr<Engine> make_engine(std::string_view name, const SphereTree& fixed,
                                                  const SphereTree& moving,
                                                  const EngineOptions& options);

using Engines = std::vector<std::unique_ptr<Engine>>;

/// The instruction sets of simd that this processor has, best first: "avx3, avx2, …".
[[nodiscard]] std::string target_names();

}  // namespace ist::cli
