#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>
#include <utility>

#include "ist/query/query.h"
#include "ist/query/workers/shared_work.h"
#include "query/workers/stall.h"

namespace ist::test {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// All places where the second worker can stall.
constexpr HandOver kHandOvers[] = {HandOver::kSeen, HandOver::kEntered, HandOver::kClaimed,
                                   HandOver::kWorked};

/// Asks until `done`, without a limit: on a busy machine it takes longer, and is no failure. Ends
/// at the first wrong answer. Returns whether all answers were right.
inline bool ask_until(const std::function<bool()>& is_right, const std::function<bool()>& done) {
  do {
    if (!is_right()) return false;
  } while (!done());
  return true;
}

/// Asks until the second worker, in one query, has done chunks and had no room for others. A worker
/// that is late leaves one chunk, its last, to the caller. If it left two, it had no room for one
/// of them.
inline bool ask_until_short_of_room(const Query& query, const std::function<bool()>& is_right) {
  Sharing now = sharing_of(query);
  return ask_until(is_right, [&] {
    const Sharing before = std::exchange(now, sharing_of(query));
    return now.dropped >= before.dropped + 2 && now.chunks > before.chunks;
  });
}

/// Tests of a query with two workers that must give the answer of one.
class SharedQueryTest : public ::testing::Test {
 protected:
  /// The worker polls all the time: under ThreadSanitizer, and on a machine with one free core, its
  /// own schedule would find few of the queries.
  const Awake awake_;

  /// Asks once more: whether the answer is that of one worker.
  virtual bool is_right(Query& query) = 0;

  /// Asks until `done`, as above.
  bool ask_until(Query& query, const std::function<bool()>& done) {
    return test::ask_until([&] { return is_right(query); }, done);
  }
  /// Until the second worker has done a part.
  bool ask_until_helped(Query& query) {
    const std::uint64_t before = sharing_of(query).chunks;
    return ask_until(query, [&] { return sharing_of(query).chunks > before; });
  }
  /// Lets a worker that stalls go on after `pause`, in the midst of later queries. Asks until it
  /// has then done a part again.
  bool ask_while_let_go(Query& query, Clock::duration pause) {
    const std::jthread releaser([pause] {
      std::this_thread::sleep_for(pause);
      Stall::release();
    });
    int later = 0;
    return ask_until(query, [&] { return ++later >= 6 && Stall::released(); }) &&
           ask_until_helped(query);
  }
};

}  // namespace ist::test
