#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ist/query/query.h"
#include "ist/query/results.h"
#include "ist/query/workers/resident_worker.h"
#include "ist/query/workers/split_queue.h"

namespace ist {

/// How often the second worker of a query helped, since the query was made.
struct Sharing {
  std::uint64_t queries = 0;  ///< all queries
  std::uint64_t worth = 0;    ///< queries with enough work to share
  std::uint64_t shared = 0;   ///< queries that the worker took up
  std::uint64_t chunks = 0;   ///< chunks of work that it did in them
  std::uint64_t dropped = 0;  ///< chunks that it did too late, or had no room for

  /// Adds the counts of another query.
  Sharing& operator+=(const Sharing& other) noexcept {
    queries += other.queries;
    worth += other.worth;
    shared += other.shared;
    chunks += other.chunks;
    dropped += other.dropped;
    return *this;
  }
};

/// Returns how often the second worker of a query helped; all zero with one worker.
[[nodiscard]] Sharing sharing_of(const Query& query) noexcept;

/// Work of a query that the resident worker helps with when it is awake. The owner cuts its work
/// into chunks. The caller does the chunks from the front. The worker does them from the back, into
/// memory of its own, and the caller takes over its results in order. So the answer is the answer
/// of one worker.
///
/// A worker that is late when the caller has returned is dropped. Until it is back, is_busy(), and
/// the owner must work alone and change nothing that help() reads.
///
/// The destructor waits for the worker, so this is the last member of its owner.
///
/// A `Part` is a result of the worker's for a chunk. It has at least these members:
///
///     std::size_t begin, count;  // its place in the worker's memory
///     bool whole;                // false if there was no room for it
template <class Part>
class SharedWork {
 public:
  /// Does a chunk on the worker's thread and writes all of `part` but `begin`, which is given.
  using Help = void (*)(void* owner, std::size_t chunk, Part& part) noexcept;

  /// Reserves memory for up to `most_chunks` chunks. @param period as for ResidentWorker::tick
  SharedWork(std::size_t most_chunks, std::chrono::nanoseconds period, void* owner, Help by)
      : period_(period),
        owner_(owner),
        help_(by),
        chunk_ends_(most_chunks),
        parts_(most_chunks),
        queue_(most_chunks),
        job_([](void* self) noexcept { static_cast<SharedWork*>(self)->help(); }, this) {}
  ~SharedWork() {
    worker_.retract(job_);
    job_.wait_idle();
  }
  SharedWork(const SharedWork&) = delete;
  SharedWork& operator=(const SharedWork&) = delete;

  /// Reports that a query begins.
  void begin() noexcept {
    worker_.tick(std::chrono::steady_clock::now(), period_);
    ++sharing_.queries;
  }
  /// Returns whether the worker is still in an earlier query. Once this is false, everything that
  /// it wrote is visible.
  [[nodiscard]] bool is_busy() const noexcept { return job_.busy(); }
  /// Counts a query with enough work to share.
  void note_worth() noexcept { ++sharing_.worth; }

  /// Cuts a list of items into chunks of at least `least` in size. `end_of(i)` returns the size of
  /// the items up to and with `i`. The worker must not be busy. It sees everything that the owner
  /// wrote before.
  template <class EndOf>
  void cut(std::size_t items, std::size_t least, EndOf end_of) noexcept {
    chunk_count_ = 0;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < items; ++i) {
      const std::size_t end = end_of(i);
      if (end - begin < least && i + 1 < items) continue;
      chunk_ends_[chunk_count_++] = i + 1;
      begin = end;
    }
    epoch_ = queue_.open(chunk_count_);
  }

  /// The items of a chunk: [first, last).
  struct Items {
    std::size_t first, last;
  };
  [[nodiscard]] Items items(std::size_t chunk) const noexcept {
    return {chunk == 0 ? 0 : chunk_ends_[chunk - 1], chunk_ends_[chunk]};
  }

  /// Does all chunks, each once, and returns whether all were done. `work(chunk)` does one and
  /// returns whether it came to its end. `take(part)` takes over a result of the worker's and
  /// returns whether there is time for more. May wait 20 µs for the worker, but not past a
  /// deadline.
  template <class Work, class Take>
  [[nodiscard]] bool run(const Budget& budget, Work work, Take take) noexcept;

  /// Returns how often the worker helped. Chunks are counted only in run() calls that took them.
  [[nodiscard]] const Sharing& sharing() const noexcept { return sharing_; }
  /// Returns the bytes that work of up to `most_chunks` chunks reserves.
  [[nodiscard]] static constexpr std::size_t bytes_for(std::size_t most_chunks) noexcept {
    return most_chunks * (sizeof(Part) + sizeof(std::size_t) + sizeof(std::uint64_t));
  }

 private:
  // The time that a caller, when done, waits for the worker's last chunk.
  [[nodiscard]] static std::chrono::nanoseconds patience(const Budget& budget) noexcept {
    constexpr std::chrono::microseconds kPatience{20};
    if (!budget.has_deadline()) return kPatience;
    return std::min<std::chrono::nanoseconds>(kPatience, budget.deadline - detail::budget_now());
  }
  void help() noexcept;

  std::chrono::nanoseconds period_;
  void* owner_;
  Help help_;
  Sharing sharing_;
  // The caller writes these only while the worker is not busy.
  std::vector<std::size_t> chunk_ends_;  // the item after the last one of each chunk
  std::size_t chunk_count_ = 0;
  std::uint64_t epoch_ = 0;
  std::vector<Part> parts_;
  SplitQueue queue_;
  Job job_;
  ResidentWorker worker_;
};

template <class Part>
template <class Work, class Take>
bool SharedWork<Part>::run(const Budget& budget, Work work, Take take) noexcept {
  // Offers the job before each chunk: if long queries follow back to back, the worker starts
  // polling in the middle of one.
  bool taken = worker_.offer(job_), in_time = true;
  std::size_t done = 0;
  while (in_time) {
    const auto chunk = queue_.claim_front();
    if (!chunk) break;
    in_time = work(*chunk);
    done += in_time ? 1U : 0U;
    if (!taken) taken = worker_.offer(job_);
  }
  for (std::size_t chunk = queue_.close(); chunk < chunk_count_ && in_time; ++chunk) {
    if (queue_.collect(chunk, patience(budget)) && parts_[chunk].whole) {
      in_time = take(parts_[chunk]);
      ++done;
      ++sharing_.chunks;
    } else {
      in_time = work(chunk);
      done += in_time ? 1U : 0U;
      ++sharing_.dropped;
    }
  }
  if (taken && !worker_.retract(job_)) ++sharing_.shared;
  return done == chunk_count_;
}

// The worker's side.
template <class Part>
void SharedWork<Part>::help() noexcept {
  std::size_t used = 0;  // of the worker's memory
  while (const auto chunk = queue_.claim_back(epoch_)) {
    hand_over(HandOver::kClaimed);
    Part& part = parts_[*chunk];
    part.begin = used;
    help_(owner_, *chunk, part);
    if (part.whole) used += part.count;
    hand_over(HandOver::kWorked);
    queue_.complete(epoch_, *chunk);
  }
}

}  // namespace ist
