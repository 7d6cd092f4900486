#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ist/query/contacts/contact_pair.h"
#include "ist/query/contacts/node_parents.h"

namespace ist {

/// The factor of a leaf pair's weight, 0 … 1, that comes from its ancestors.
///
/// The table's balls are not nested: two leaves whose own bounds overlap leave the answer where the
/// bounds of two of their ancestors come apart. A weight of the leaves alone would jump there. So
/// the weight has as a factor the least overlap of all pairs of ancestors that the search tests, in
/// parts of the width over which weights fade.
///
/// Leaf pairs come in the order of the fixed tree, so the same ancestors recur: each step of the
/// search keeps its last factors and its last bounds. Cost: 3 ns for a pair in the cache, 20 ns for
/// another.
class AncestorShare {
 public:
  AncestorShare(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                const NodeParents& fixed_parents, const NodeParents& moving_parents,
                const ContactScale& scale);

  /// Begins a query; `pose` must outlive it.
  void begin(const RelativePose& pose) noexcept;

  /// Returns the factor of two leaves.
  [[nodiscard]] double of(std::uint32_t fixed, std::uint32_t moving) noexcept {
    if (steps_.empty()) return 1;
    const Step& first = steps_[0];
    const std::uint32_t a = first.fixed_level > 0 ? fixed_parents_.of(0, fixed) : fixed;
    const std::uint32_t b = first.moving_level > 0 ? moving_parents_.of(0, moving) : moving;
    const Known& known = first.known[b & (kKnown - 1)];
    return is(known, a, b) ? known.share : find(0, a, b);
  }

  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  struct Known {
    std::uint32_t query = 0;
    std::uint32_t fixed, moving;
    double share;
  };
  struct MovedBound {
    std::uint32_t query = 0;
    std::uint32_t node;
    NodeBound bound;
  };
  static constexpr std::size_t kKnown = 256;  // entries a step; a power of two
  struct Step {
    int fixed_level, moving_level;
    std::uint32_t bound_of;  // the fixed node that `bound` belongs to
    NodeBound bound;
    std::array<MovedBound, kKnown> moved;  // moving nodes, by their last bits
    std::array<Known, kKnown> known;       // pairs, by the last bits of the moving node
  };

  [[nodiscard]] bool is(const Known& known, std::uint32_t fixed,
                        std::uint32_t moving) const noexcept {
    return known.query == query_ && known.fixed == fixed && known.moving == moving;
  }
  // Returns the factor of a pair of nodes of a step and of all pairs of their ancestors.
  [[nodiscard]] double find(std::size_t step, std::uint32_t fixed, std::uint32_t moving) noexcept;
  [[nodiscard]] double own(Step& step, std::uint32_t fixed, std::uint32_t moving) noexcept;
  [[nodiscard]] const NodeBound& moved(Step& step, std::uint32_t moving) noexcept;

  const SphereTree& fixed_;
  const SphereTree& moving_;
  SpherePolicy policy_;
  const NodeParents& fixed_parents_;
  const NodeParents& moving_parents_;
  double width_, margin_;
  const RelativePose* pose_ = nullptr;
  std::uint32_t query_ = 0;
  std::vector<Step> steps_;  // the search's steps, from the last but one to the roots
};

}  // namespace ist
