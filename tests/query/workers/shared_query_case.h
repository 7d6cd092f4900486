#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>

#include "ist/query/query.h"
#include "query/workers/stall.h"

namespace ist::test {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// All places where the second worker can stall.
constexpr HandOver kHandOvers[] = {HandOver::kSeen, HandOver::kEntered, HandOver::kClaimed,
                                   HandOver::kWorked};

/// Tests of a query with two workers that must give the answer of one.
class SharedQueryTest : public ::testing::Test {
 protected:
  /// The worker polls all the time: under ThreadSanitizer, and on a machine with one free core, its
  /// own schedule would find few of the queries.
  const Awake awake_;

  /// Asks once more: whether the answer is that of one worker.
  virtual bool is_right(Query& query) = 0;

  /// Asks until `done`, or for five minutes: a machine that is busy is no failure. Whether it was
  /// done, and all answers were right.
  bool ask_until(Query& query, const std::function<bool()>& done) {
    for (const auto give_up = Clock::now() + 300s; Clock::now() < give_up;) {
      if (!is_right(query)) return false;
      if (done()) return true;
    }
    return false;
  }
  /// Until the second worker has done a part.
  bool ask_until_helped(Query& query) {
    const std::uint64_t before = query.sharing().chunks;
    return ask_until(query, [&] { return query.sharing().chunks > before; });
  }
};

/// Asks until the second worker, in one query, has done chunks and had no room for others, or for
/// five minutes. A late worker leaves one chunk to the caller, its last; it had no room for the
/// second of two. Whether it got so far, and all answers were right.
inline bool ask_until_short_of_room(const Query& query, const std::function<bool()>& is_right) {
  for (const auto give_up = Clock::now() + 300s; Clock::now() < give_up;) {
    const Sharing before = query.sharing();
    if (!is_right()) return false;
    const Sharing after = query.sharing();
    if (after.dropped >= before.dropped + 2 && after.chunks > before.chunks) return true;
  }
  return false;
}

}  // namespace ist::test
