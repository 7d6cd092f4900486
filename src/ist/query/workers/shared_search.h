#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "ist/query/contacts/contact_visitor.h"
#include "ist/query/traversal/search.h"
#include "ist/query/workers/shared_work.h"

namespace ist {

/// A search that the resident worker helps with. The caller searches the first levels. If there are
/// enough pairs then, it cuts them into chunks, by the pairs alone. It searches its chunks right
/// into its sink, and copies the worker's results into it. A Lister is a PairLister or a
/// ContactVisitor.
class SharedSearch {
 public:
  /// Reserves twice the memory of a Search and 5.5 MB. @param period as for ResidentWorker::tick
  SharedSearch(const SearchPlan& plan, const Kernels& kernels, std::size_t pairs,
               std::chrono::nanoseconds period);

  /// The end of a search.
  struct End {
    std::size_t steps;  ///< whole steps: all, unless the budget or the sink ended the search
    std::uint64_t tests, leaf_pairs;
    DistanceBounds bounds;
  };
  /// Searches as a Lister does, from the roots. If tests are limited, the caller searches alone.
  /// May wait 20 µs for the worker, but not past a deadline. If a deadline interrupts shared work,
  /// the result ends above the split and has no leaf pairs, because the split between the threads
  /// is not repeatable. A search with a limit of as many tests ends there too.
  template <class Lister>
  [[nodiscard]] End run(const SearchPose& pose, typename Lister::Sink& sink,
                        const BudgetMeter& meter = {},
                        Measured measured = Measured::kNothing) noexcept;

  /// Returns the caller's own search, for work that is not shared.
  [[nodiscard]] Search& serial() noexcept { return caller_; }
  [[nodiscard]] const Sharing& sharing() const noexcept { return work_.sharing(); }

  /// Returns the bytes that a search reserves.
  [[nodiscard]] static std::size_t bytes_for(const SearchPlan& plan, std::size_t pairs) noexcept;

 private:
  struct Part {
    std::size_t begin, count;
    std::uint64_t tests;
    DistanceBounds bounds;
    ContactTotals totals;
    bool whole;
  };
  // The data that the worker reads.
  struct Shared {
    SearchPose pose;
    Measured measured = Measured::kNothing;
    bool contacts = false;  // contacts are wanted, rather than leaf pairs
    std::size_t step = 0;
    std::vector<SearchGroup> groups;
    std::vector<std::uint32_t> moving;
    Frontier frontier{};
  };

  void share(const SearchPose& pose, Measured measured, std::size_t step,
             const Frontier& frontier) noexcept;
  // Does all chunks and adds their tests and bounds to `end`. Returns whether all were done.
  template <class Lister>
  bool do_chunks(const Budget& budget, typename Lister::Sink& sink, End& end) noexcept;
  // Searches a chunk. Returns whether the search came to its end.
  template <class Lister>
  bool descend(std::size_t chunk, Search& search, Lister& lister) const noexcept;
  void help(std::size_t chunk, Part& part) noexcept;

  const SearchPlan& plan_;
  const Kernels& kernels_;
  Search caller_, helper_;
  Shared shared_;
  std::vector<LeafPair> found_;          // leaf pairs of the worker
  std::unique_ptr<ContactAdder> adder_;  // contacts of the worker
  LeafSums found_leaves_;
  SharedWork<Part> work_;  // the last
};

}  // namespace ist
