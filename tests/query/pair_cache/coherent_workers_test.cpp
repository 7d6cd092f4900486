// The resident worker makes the next cache, and may be late with it, or too late: the answers are
// those of a fresh query all the same.

#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "ist/query/workers/shared_work.h"
#include "query/pair_cache/kept_answers.h"
#include "query/pair_cache/motions.h"
#include "query/workers/stall.h"
#include "support/effort.h"

namespace ist::test {
namespace {

constexpr HandOver kPointsOfDelay[] = {HandOver::kSeen, HandOver::kEntered, HandOver::kClaimed,
                                       HandOver::kWorked};

class CoherentQueryThread : public ::testing::Test {
 protected:
  const Awake awake_;

  static QueryOptions helped() {
    QueryOptions options = options_of(SpherePolicy::kSlab, "", 2);
    options.front_pairs = 1 << 15;
    return options;
  }
  // A slow way to and fro, on which a cache lasts for some ticks.
  QueryResult tick(KeptAnswers& answers) {
    if (++ticks_ % 300 == 0) way_ = -way_;
    pose_.translation()[2] += 0.01 * way_ * scene_.fixed.voxel_size();
    return answers.check_contacts(pose_, static_cast<std::size_t>(ticks_ / 200 % 2));
  }
  // Ticks until `done`, without a limit: on a busy machine it takes longer, and is no failure. Ends
  // at the first wrong answer. Returns whether all answers were right.
  bool tick_until(KeptAnswers& answers, const std::function<bool(const QueryResult&)>& done) {
    while (!HasFailure()) {
      if (done(tick(answers))) return true;
    }
    return false;
  }
  bool tick_until_kept(KeptAnswers& answers) {
    return tick_until(answers, [](const QueryResult& r) { return r.found == Found::kKept; });
  }
  // Waits until the worker stalls with a cache to make: what is kept is then used up, and no other
  // comes. Where it stalls with a part of a search instead, it is let go, and stalled again.
  bool tick_until_stalled(KeptAnswers& answers, HandOver point, std::optional<Stall>& stall) {
    int fresh = 0, stalled = 0;
    stall.emplace(point);
    return tick_until(answers, [&](const QueryResult& r) {
      if (!Stall::reached()) return false;
      fresh = r.found == Found::kFresh ? fresh + 1 : 0;
      if (++stalled == 400) {
        stalled = fresh = 0;
        stall.reset();
        stall.emplace(point);
      }
      return fresh >= 100;
    });
  }

  // Too little to search for it to be shared: all that the worker gets is caches to make.
  const Scene scene_{"small", tree_of(icosphere(2, 1), 8),
                     tree_of(box({-0.9, -0.7, -0.8}, {0.9, 0.7, 0.8}), 7), shift({0.5, 0.25, 0})};
  Eigen::Isometry3d pose_ = scene_.pose;
  int ticks_ = 0;
  double way_ = 1;
};

TEST_F(CoherentQueryThread, AnswersWithoutAWorkerThatStalls) {
  KeptAnswers answers(scene_, helped());
  for (const HandOver point : kPointsOfDelay) {
    SCOPED_TRACE(static_cast<int>(point));
    ASSERT_TRUE(tick_until_kept(answers));
    {
      std::optional<Stall> stall;
      ASSERT_TRUE(tick_until_stalled(answers, point, stall));
      for (int later = 0; later < 100; ++later) {
        ASSERT_EQ(tick(answers).found, Found::kFresh);
      }
    }
    ASSERT_TRUE(tick_until_kept(answers));  // it goes on
  }
  EXPECT_EQ(sharing_of(answers.kept()).worth, 0u);
}

// It stalls each time it reaches a point, for a while that ends at any moment of a later tick.
TEST_F(CoherentQueryThread, AnswersWhereTheWorkerIsLate) {
  Random random(1);
  for (int round = 0; round < samples(6); ++round) {
    const bool wide = round % 2 == 0;
    QueryOptions options = helped();
    if (!wide) options.front_pairs = 2000;
    KeptAnswers answers(scene_, options);
    Motion motion(scene_, random.below(1000));
    motion.limit_step(0.1);
    for (const HandOver point : kPointsOfDelay) {
      for (int again = 0; again < 4; ++again) {
        const Stall stall(point);
        // A wide cache is wanted sooner or later, and then the worker stalls.
        for (int i = 0; (i < 20 || (wide && again == 0 && !Stall::reached())) && !HasFailure(); ++i)
          answers.check(motion.next(), random);
        const auto late = std::chrono::microseconds(random.below(300));
        const std::jthread releaser([late] {
          std::this_thread::sleep_for(late);
          Stall::release();
        });
        for (int i = 0; (i < 20 || !Stall::released()) && !HasFailure(); ++i)
          answers.check(motion.next(), random);
      }
      answers.choose(random);
    }
  }
}

// A query goes away only when the worker has left it.
TEST_F(CoherentQueryThread, IsDestroyedWhereTheWorkerStalls) {
  for (const HandOver point : kPointsOfDelay) {
    SCOPED_TRACE(static_cast<int>(point));
    std::optional<KeptAnswers> answers(std::in_place, scene_, helped());
    ASSERT_TRUE(tick_until_kept(*answers));
    std::optional<Stall> stall;
    ASSERT_TRUE(tick_until_stalled(*answers, point, stall));
    ReleaseOnWait release;
    answers.reset();
    EXPECT_EQ(release.awaited(), point != HandOver::kSeen);  // where it has entered the query
  }
  // And at any moment.
  for (int i = 0; i < 20; ++i) {
    KeptAnswers answers(scene_, helped());
    for (int k = 0; k < i; ++k) tick(answers);
  }
}

// In a child process there is no worker: what it was about is never taken up, nor waited for.
TEST_F(CoherentQueryThread, GoesOnInAChildProcessWhereTheWorkerStalls) {
  std::optional<KeptAnswers> answers(std::in_place, scene_, helped());
  ASSERT_TRUE(tick_until_kept(*answers));
  std::optional<Stall> stall;
  ASSERT_TRUE(tick_until_stalled(*answers, HandOver::kClaimed, stall));
  const pid_t child = fork();
  if (child == 0) {
    // A child that waits for ever ends with the test.
    prctl(PR_SET_PDEATHSIG, static_cast<unsigned long>(SIGKILL));
    for (int i = 0; i < 100; ++i) tick(*answers);
    answers.reset();
    _exit(HasFailure() ? 1 : 0);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST_F(CoherentQueryThread, IsMovedBetweenTicks) {
  for (const int workers : {1, 2}) {
    QueryOptions options = helped();
    options.workers = workers;
    KeptAnswers answers(scene_, options);
    for (int i = 0; (i < 100 || answers.counts().kept <= 5) && !HasFailure(); ++i) {
      tick(answers);
      Query moved = std::move(answers.kept());
      if (i % 3 == 0) {
        Query again(scene_.fixed, scene_.moving, options);
        again = std::move(moved);
        answers.kept() = std::move(again);
      } else {
        answers.kept() = std::move(moved);
      }
    }
    ASSERT_TRUE(tick_until_kept(answers));
  }
  // Also where the worker has a job of it.
  KeptAnswers answers(scene_, helped());
  ASSERT_TRUE(tick_until_kept(answers));
  std::optional<Stall> stall;
  ASSERT_TRUE(tick_until_stalled(answers, HandOver::kClaimed, stall));
  Query moved = std::move(answers.kept());
  Stall::release();
  answers.kept() = std::move(moved);
  EXPECT_TRUE(tick_until_kept(answers));
}

// A query that replaces another ends what the worker does for that one.
TEST_F(CoherentQueryThread, IsReplacedWhereTheWorkerStalls) {
  KeptAnswers answers(scene_, helped());
  ASSERT_TRUE(tick_until_kept(answers));
  std::optional<Stall> stall;
  ASSERT_TRUE(tick_until_stalled(answers, HandOver::kClaimed, stall));
  ReleaseOnWait release;
  answers.kept() = Query(scene_.fixed, scene_.moving, helped());
  EXPECT_TRUE(release.awaited());
  EXPECT_TRUE(tick_until_kept(answers));
}

}  // namespace
}  // namespace ist::test
