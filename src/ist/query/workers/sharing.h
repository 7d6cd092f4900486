#pragma once

#include <cstdint>

#include "ist/query/query.h"

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

}  // namespace ist
