#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "loop/haptics/bodies/hand_bodies.h"
#include "loop/haptics/bodies/tool_contact_query.h"

namespace ist {

/// A pair of bodies, by their numbers: one that may be fixed, while the other may be held.
struct HandPair {
  std::size_t fixed, held;
};

/// Finds the contacts of every pair of a fixed and a held body, one pair after the other.
class PairQueries {
 public:
  /// No pairs, for a simulation that needs no contacts.
  PairQueries() = default;

  /// Adds a pair, whose number is the count of those before it.
  void add(const HandPair& pair, std::unique_ptr<ToolContactQuery> query);
  /// Adds a pair that is not expected to meet, and has no query. Where the balls of its bodies
  /// overlap all the same, no answer is complete.
  void add_far(const HandPair& pair) { far_.push_back(pair); }

  [[nodiscard]] bool empty() const noexcept { return pairs_.empty() && far_.empty(); }
  /// Pairs with a query.
  [[nodiscard]] std::size_t size() const noexcept { return pairs_.size(); }
  [[nodiscard]] std::size_t bytes() const noexcept;

  /// Says where the bodies are, after some of them were moved, attached or released.
  void place(const HandBodies& bodies) noexcept;

  /// Finds all contacts at a pose of the tool. Empty if there are no pairs.
  ///
  /// The result is complete if that of every pair is; else `contacts` holds those of some pairs.
  /// Counts are sums over the pairs, the distance is the least, level, resolution and pad are the
  /// largest, and `found` is the way of the costliest pair. The budget is divided among the pairs:
  /// each may spend what those behind it did not need when they were asked last, and no less than
  /// its part by such needs.
  [[nodiscard]] std::optional<QueryResult> find(const HandBodies& bodies, const Placement& tool,
                                                const Budget& budget,
                                                ToolContacts& contacts) noexcept;
  /// Notes in `contacts` how the fixed bodies move in the step to come.
  void note_drift(const HandBodies& bodies, const Placement& tool,
                  ToolContacts& contacts) const noexcept;

 private:
  // What a pair spends. One unit at least, so that parts are defined.
  struct Need {
    double tests = 1, nanoseconds = 1;
  };
  struct PairQuery {
    HandPair bodies;
    std::unique_ptr<ToolContactQuery> query;
    Need need;
  };

  [[nodiscard]] QueryResult ask(PairQuery& pair, const Placement& tool, const Budget& budget,
                                ToolContacts& contacts) noexcept;

  std::vector<PairQuery> pairs_;
  std::vector<HandPair> far_;
};

}  // namespace ist
