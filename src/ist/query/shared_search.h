#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "ist/query/chunk_board.h"
#include "ist/query/search.h"
#include "ist/query/workers.h"

namespace ist {

/// A search that the resident worker helps with when it happens to be awake and the work is worth
/// it. The first levels are searched by the caller; when there are pairs enough they are cut into
/// chunks, which depends on the pairs alone. The caller does them from the front, right into its
/// sink, and the worker from the back, into memory of its own, whence they are copied in order. So
/// the answer is that of one worker.
///
/// What the worker reads is a copy, left alone while the worker is in it: one that is late when
/// the caller has returned is dropped, and until it is back the caller searches alone.
class SharedSearch {
 public:
  /// Memory: twice that of a Search and 2.6 MB. @param period as for ResidentWorker::tick
  SharedSearch(const SearchPlan& plan, const Kernels& kernels, std::size_t pairs,
               std::chrono::nanoseconds period);
  ~SharedSearch();
  SharedSearch(const SharedSearch&) = delete;
  SharedSearch& operator=(const SharedSearch&) = delete;

  /// As Search::run.
  std::uint64_t run(const SearchPose& pose, ContactSink& sink) noexcept {
    return run_until({}, pose, sink).tests;
  }
  /// As Search::run_until, but that the first levels are always searched, until there are 512
  /// pairs, in some 3,000 tests, and that it may wait 20 µs for the worker. With a budget of tests
  /// the caller is alone. Where the clock ends what is shared, the first levels are all that
  /// counts, for who did what below is chance: so a budget of the tests that are told ends it there
  /// again.
  [[nodiscard]] Search::Stopped run_until(const Budget& budget, const SearchPose& pose,
                                          ContactSink& sink) noexcept;

  /// The caller's own search, for what is not to be shared.
  [[nodiscard]] Search& alone() noexcept { return caller_; }

  /// What became of the queries since it was made; chunks, of those that came to their end.
  struct Sharing {
    std::uint64_t queries = 0;  ///< all
    std::uint64_t worth = 0;    ///< with work enough to be shared
    std::uint64_t shared = 0;   ///< that the worker took up
    std::uint64_t chunks = 0;   ///< that it did in them
    std::uint64_t dropped = 0;  ///< that it did too late, or had no room for
  };
  [[nodiscard]] const Sharing& sharing() const noexcept { return sharing_; }

  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  struct Part {  // what the worker made of a chunk
    std::size_t begin, count;
    std::uint64_t tests;
    bool whole;  // not if there was no room for all
  };
  // What the worker reads; written by the caller while the worker is not in it.
  struct Shared {
    SearchPose pose;
    std::size_t step = 0;
    std::uint64_t epoch = 0;
    std::vector<SearchGroup> groups;
    std::vector<std::uint32_t> moving;
    std::vector<std::size_t> chunk_ends;  // in groups
    Frontier frontier{};
  };

  void share(const SearchPose& pose, std::size_t step, const Frontier& frontier) noexcept;
  [[nodiscard]] Frontier chunk(std::size_t index, std::size_t& first) const noexcept;
  // Does all chunks with the worker, or as many as there is time for; then it is false.
  [[nodiscard]] bool do_chunks(const Budget& budget, ContactSink& sink,
                               std::uint64_t& tests) noexcept;
  void help() noexcept;

  const SearchPlan& plan_;
  Search caller_, helper_;
  std::chrono::nanoseconds period_;
  Shared shared_;
  Sharing sharing_;
  std::size_t chunk_count_ = 0;
  ChunkBoard board_;
  std::vector<Part> parts_;
  std::vector<Contact> found_;  // by the worker
  Job job_;
  ResidentWorker worker_;
};

}  // namespace ist
