#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/traversal/search_plan.h"
#include "query/query_cases.h"
#include "simd/contact_step.h"

namespace ist::test {

/// Two trees and the way down them, and how all of their nodes are named on it.
struct PlannedSearch {
  PlannedSearch(SphereTree a, SphereTree b, SpherePolicy with);
  PlannedSearch(const PlannedSearch&) = delete;
  PlannedSearch& operator=(const PlannedSearch&) = delete;

  struct Names {
    std::vector<std::uint32_t> fixed, moving;
  };
  SphereTree fixed, moving;
  SpherePolicy policy;
  SearchPlan plan;
  std::vector<Names> names;  ///< before each step
};

/// For every policy: bodies of one voxel and of some thousand, of equal voxels and of others, so
/// that in some steps both sides are opened, in some the fixed and in some the moving one alone,
/// at the top and at the bottom.
[[nodiscard]] const std::vector<std::unique_ptr<PlannedSearch>>& all_plans();

/// A motion that brings the moving body near the fixed one, with pads from nothing up to `most`.
[[nodiscard]] SearchPose random_pose(Random& random, double most);

/// Keeps the terms of all pairs that it is given, batch after batch.
class TermsRecorder final : public ContactTermsStream {
 public:
  void take(const ContactTerms& terms) noexcept override {
    ++batches;
    for (std::size_t i = 0; i < terms.count; ++i) {
      fixed.push_back(terms.fixed[i]);
      for (const float* of : {terms.weight, terms.depth, terms.x, terms.y, terms.z, terms.force_x,
                              terms.force_y, terms.force_z}) {
        numbers.push_back(of[i]);
      }
    }
  }
  [[nodiscard]] bool is(const TermsRecorder& other) const {
    return fixed == other.fixed && numbers == other.numbers;
  }
  /// Returns the terms of the pairs with a weight above 0.
  [[nodiscard]] TermsRecorder with_weight() const {
    TermsRecorder left;
    for (std::size_t i = 0; i < fixed.size(); ++i) {
      const auto from = numbers.begin() + static_cast<std::ptrdiff_t>(kNumbers * i);
      if (!(*from > 0)) continue;
      left.fixed.push_back(fixed[i]);
      left.numbers.insert(left.numbers.end(), from, from + kNumbers);
    }
    return left;
  }

  static constexpr std::ptrdiff_t kNumbers = 8;
  int batches = 0;
  std::vector<std::uint32_t> fixed;
  std::vector<float> numbers;
};

/// Whether two totals are the same numbers.
[[nodiscard]] inline bool same(const ContactTotals& a, const ContactTotals& b) {
  return std::equal(a.sum, a.sum + kContactSums, b.sum) && a.counted == b.counted &&
         a.pairs == b.pairs;
}

/// The rule of the contacts of two trees with a margin.
[[nodiscard]] inline ContactRule rule_of(const PlannedSearch& search, double margin) {
  const ContactScale scale(search.fixed, search.moving, margin);
  return contact_rule(scale,
                      contact_rates(search.fixed, search.moving, search.policy, scale).lever);
}

}  // namespace ist::test
