#include "ist/base/progress.h"

#include <gtest/gtest.h>

#include "ist/base/parallel.h"

namespace ist {
namespace {

TEST(Progress, BeginsWithNothingDone) {
  const Progress progress;
  EXPECT_STREQ(progress.stage(), "");
  EXPECT_EQ(progress.fraction(), 0.0);
}

TEST(Progress, CountsWhatAllThreadsAdd) {
  Progress progress;
  progress.begin_stage("counting", 4000);
  parallel_for(1000, 7, [&](std::size_t begin, std::size_t end) { progress.add(end - begin); });
  EXPECT_STREQ(progress.stage(), "counting");
  EXPECT_EQ(progress.fraction(), 0.25);
}

TEST(Progress, ANewStageBeginsAtZero) {
  Progress progress;
  progress.begin_stage("first", 2);
  progress.add(1);
  progress.begin_stage("second", 5);
  EXPECT_STREQ(progress.stage(), "second");
  EXPECT_EQ(progress.fraction(), 0.0);
}

TEST(Progress, StaysBetweenZeroAndOne) {
  Progress progress;
  progress.begin_stage("of unknown length", 0);
  progress.add(3);
  EXPECT_EQ(progress.fraction(), 0.0);
  progress.begin_stage("longer than announced", 2);
  progress.add(3);
  EXPECT_EQ(progress.fraction(), 1.0);
}

}  // namespace
}  // namespace ist
