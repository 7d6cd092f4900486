#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "ist/query/contacts/contact_visitor.h"
#include "ist/query/traversal/search.h"
#include "ist/query/workers/resident_worker.h"
#include "ist/query/workers/split_queue.h"

namespace ist {

/// A search that the resident worker helps with when it is awake and the work is worth it. The
/// caller searches the first levels; when there are enough pairs it cuts them into chunks, by the
/// pairs alone. The caller does the chunks from the front, right into its sink, and the worker from
/// the back, into its own memory, from which they are copied in order. So the answer is that of one
/// worker. A Lister is a PairLister or a ContactVisitor.
///
/// The worker reads a copy, which stays unchanged while the worker is in it. A worker that is late
/// when the caller has returned is dropped, and until it is back the caller searches alone.
class SharedSearch {
 public:
  /// Reserves twice the memory of a Search and 5.5 MB. @param period as for ResidentWorker::tick
  SharedSearch(const SearchPlan& plan, const Kernels& kernels, std::size_t pairs,
               std::chrono::nanoseconds period);
  ~SharedSearch();
  SharedSearch(const SharedSearch&) = delete;
  SharedSearch& operator=(const SharedSearch&) = delete;

  /// The end of a search.
  struct End {
    std::size_t steps;  ///< whole steps: all, unless the budget or the sink ended the search
    std::uint64_t tests, leaf_pairs;
    DistanceBounds bounds;
  };
  /// Searches as a Lister does, from the roots. With a limit of tests the caller searches
  /// alone. May wait 20 µs for the worker, but not past a deadline. If a deadline interrupts shared
  /// work, the result is that of the steps above the split, without leaf pairs, because which
  /// thread did which chunk is not repeatable: a search with a limit of as many tests ends there
  /// too.
  template <class Lister>
  [[nodiscard]] End run(const SearchPose& pose, typename Lister::Sink& sink,
                        const BudgetMeter& meter = {},
                        Measured measured = Measured::kNothing) noexcept;

  /// Returns the caller's own search, for work that is not shared.
  [[nodiscard]] Search& serial() noexcept { return caller_; }

  /// Returns how often the worker helped; chunks are counted only for searches that were completed.
  [[nodiscard]] const Sharing& sharing() const noexcept { return sharing_; }

  [[nodiscard]] std::size_t bytes() const noexcept;
  /// Returns the bytes that a search reserves: what bytes() is of it.
  [[nodiscard]] static std::size_t bytes_for(const SearchPlan& plan, std::size_t pairs) noexcept;

 private:
  struct Part {  // the worker's result for a chunk
    std::size_t begin, count;
    std::uint64_t tests;
    DistanceBounds bounds;
    ContactTotals totals;
    bool whole;  // false if there was no room for all leaf pairs, or leaves
  };
  // The data that the worker reads; the caller writes it only while the worker is not in it.
  struct Shared {
    SearchPose pose;
    Measured measured = Measured::kNothing;
    bool contacts = false;  // whether these are wanted, rather than leaf pairs
    std::size_t step = 0;
    std::uint64_t epoch = 0;
    std::vector<SearchGroup> groups;
    std::vector<std::uint32_t> moving;
    std::vector<std::size_t> chunk_ends;  // the group after the last one of each chunk
    Frontier frontier{};
  };

  void share(const SearchPose& pose, Measured measured, std::size_t step,
             const Frontier& frontier) noexcept;
  [[nodiscard]] Frontier chunk(std::size_t index, std::size_t& first) const noexcept;
  void want(const LeafPairSink& sink) noexcept;
  void want(const ContactOutput& sink) noexcept;
  // Does all chunks together with the worker, and adds their tests and bounds to `end`. Returns
  // whether all were done.
  template <class Lister>
  [[nodiscard]] bool do_chunks(const Budget& budget, typename Lister::Sink& sink,
                               End& end) noexcept;
  void collect(const Part& part, LeafPairSink& sink) noexcept;
  void collect(const Part& part, ContactOutput& sink) noexcept;
  void help() noexcept;
  template <class Lister>
  void help_with(const Frontier& part, std::size_t first, typename Lister::Sink& sink,
                 Part& made) noexcept;
  void help_pairs(const Frontier& part, std::size_t first, Part& made) noexcept;
  void help_contacts(const Frontier& part, std::size_t first, Part& made) noexcept;

  const SearchPlan& plan_;
  const Kernels& kernels_;
  Search caller_, helper_;
  std::chrono::nanoseconds period_;
  Shared shared_;
  Sharing sharing_;
  std::size_t chunk_count_ = 0;
  SplitQueue queue_;
  std::vector<Part> parts_;
  std::vector<LeafPair> found_;          // leaf pairs of the worker
  std::unique_ptr<ContactAdder> adder_;  // contacts of the worker
  LeafSums found_leaves_;
  Job job_;
  ResidentWorker worker_;
};

}  // namespace ist
