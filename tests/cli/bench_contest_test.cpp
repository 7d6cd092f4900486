// The parts of `ist bench`: who is asked when, what is made of it, and what is said of the machine.
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "cli/bench/bench_report.h"
#include "cli/bench/contest.h"
#include "cli/bench/machine.h"
#include "cli/bench/ratios.h"
#include "cli/cli_case.h"

namespace ist::test {
namespace {

cli::Samples times_of(const std::vector<double>& times) {
  cli::Samples all;
  for (const double time : times) all.add(time);
  return all;
}

TEST(BenchNoise, IsNamedWhereTheMachineIsNotQuiet) {
  cli::Machine machine;
  machine.load = {{0.1, 2, 3}};
  const cli::Samples steady = times_of(std::vector<double>(100, 200.0));
  EXPECT_EQ(cli::noise_of(machine, steady), std::nullopt);
  machine.load = {{0.8, 0, 0}};
  EXPECT_TRUE(says(cli::noise_of(machine, steady).value(), "other work took 0.8 cores"));
  std::vector<double> some = std::vector<double>(90, 200.0);
  some.insert(some.end(), 10, 300.0);
  const std::string both = cli::noise_of(machine, times_of(some)).value();
  EXPECT_TRUE(says(both, "other work took 0.8 cores"));
  EXPECT_TRUE(says(both, "1.50 times as long at times: ratios are rough"));
  machine.load.reset();  // where the system does not tell
  const std::string unsteady = cli::noise_of(machine, times_of(some)).value();
  EXPECT_FALSE(says(unsteady, "other work"));
  EXPECT_TRUE(says(unsteady, "ratios hold"));
}

// A bench of six seconds on a machine without other work, whose fixed loop never varies.
struct QuietBench {
  QuietBench() {
    setting.machine = {
        .processor = "P", .cores = 2, .governor = "performance", .load = {{0.1, 2, 3}}};
    setting.target = "t";
    setting.bodies = "two bodies";
    setting.seconds = 6;
  }
  cli::BenchSetting setting;
  cli::Samples loop = times_of(std::vector<double>(100, 200.0));
  double taken = 6.1;

  [[nodiscard]] std::string heading() const { return cli::bench_heading(setting, loop, taken); }
};

TEST(BenchHeading, SaysNoMoreOfAQuietMachine) {
  const std::string heading = QuietBench().heading();
  EXPECT_TRUE(says(heading,
                   ", t\nP, 2 cores, governor performance; load before 0.1, 2.0, 3.0; "
                   "a fixed loop took 200 to 200 µs\ntwo bodies\n"));
  EXPECT_TRUE(heading.ends_with("\ntwo bodies\n")) << heading;
}

// scripts/readme_bench.py finds other work by the beginning of this line.
TEST(BenchHeading, SaysWhereTheMachineIsNotQuiet) {
  QuietBench bench;
  bench.setting.machine.load = {{0.8, 0, 0}};
  EXPECT_TRUE(
      says(bench.heading(), "\ntwo bodies\nnot a quiet machine: other work took 0.8 cores"));
  bench.setting.machine.load = {{0.1, 0, 0}};
  bench.loop = times_of({200, 200, 200, 300, 300});
  EXPECT_TRUE(says(bench.heading(), "\nnot a quiet machine: a fixed loop took 1.50 times as long"));
}

TEST(BenchHeading, SaysWhereQueriesAreSoSlowThatTheirTurnsTakeLonger) {
  QuietBench bench;
  bench.taken = 14.2;
  EXPECT_TRUE(bench.heading().ends_with(
      "\ntook 14.2 s instead of 6: three turns of each query are the least\n"))
      << bench.heading();
}

// A contest of one that takes 1 ms and one that takes longer, by a clock that nothing else moves.
struct AgainstSlow {
  explicit AgainstSlow(int slow_milliseconds) : milliseconds(slow_milliseconds) {}

  const int milliseconds;
  int time = 0;            // ms
  int fast = 0, slow = 0;  // questions
  cli::Contest contest{{{"touch", "fast", "", 1, asked(fast, 1)},
                        {"touch", "slow", "", 1, asked(slow, milliseconds)}},
                       {{"here", "here", Eigen::Isometry3d::Identity()}},
                       [this] { return 1e-3 * time; }};

 private:
  std::function<cli::Contestant::Answer(std::size_t)> asked(int& count, int takes) {
    return [this, &count, takes](std::size_t) {
      ++count;
      time += takes;
      return cli::Contestant::Answer{1e3 * takes, std::nullopt};
    };
  }
};

TEST(BenchContest, GivesEverybodyThreeTurnsHoweverLongTheyTake) {
  AgainstSlow made(40);
  double last = 0;
  made.contest.hold(0.01, [&](double part) {
    last = part;
    return true;
  });
  EXPECT_EQ(last, 1);
  // A turn is one question that does not count and one that does.
  EXPECT_EQ(made.slow, 2 * 3);
  EXPECT_EQ(made.contest.score(1, 0).times.size(), 3u);
  EXPECT_GE(made.contest.score(0, 0).times.size(), 3u);
  EXPECT_DOUBLE_EQ(made.contest.taken(), 1e-3 * made.time);
}

TEST(BenchContest, GivesEverybodyAsMuchTime) {
  AgainstSlow made(20);
  double last = 0;
  made.contest.hold(0.5, [&](double part) {
    EXPECT_GE(part, last);
    last = part;
    return true;
  });
  EXPECT_EQ(last, 1);
  EXPECT_GT(made.fast, 10 * made.slow);  // 22 times; in as many turns 5.5 times
  EXPECT_GE(made.contest.score(1, 0).times.size(), 3u);
  EXPECT_EQ(made.contest.score(0, 0).times.median(), 1e3);
  EXPECT_FALSE(made.contest.loop().empty());
  EXPECT_DOUBLE_EQ(made.contest.taken(), 1e-3 * made.time);
  EXPECT_GE(made.contest.taken(), 0.5);
}

// Without a clock of its own it takes the system's.
TEST(BenchContest, LastsAsLongAsAsked) {
  const auto at_once = [](std::size_t) { return cli::Contestant::Answer{1, std::nullopt}; };
  cli::Contest contest({{"touch", "fast", "", 1, at_once}},
                       {{"here", "here", Eigen::Isometry3d::Identity()}});
  const auto begin = std::chrono::steady_clock::now();
  contest.hold(0.05, [](double) { return true; });
  const std::chrono::duration<double> around = std::chrono::steady_clock::now() - begin;
  EXPECT_GE(contest.taken(), 0.05);
  EXPECT_LE(contest.taken(), around.count() + 1e-6);  // for rounding
}

TEST(BenchRatios, AreNotMadeOfDifferentQuestions) {
  const auto nothing = [](std::size_t) { return cli::Contestant::Answer{1, std::nullopt}; };
  const auto groups = cli::ratios_of({{"touch", "IST", "", 1, nothing},
                                      {"touch", "fcl", "", 1, nothing},
                                      {"distance", "fcl", "", 1, nothing}});
  ASSERT_EQ(groups.size(), 1u);
  ASSERT_EQ(groups[0].ratios.size(), 1u);
  EXPECT_EQ(groups[0].ratios[0].words, "touch, against fcl");
  EXPECT_EQ(groups[0].ratios[0].of, 0u);
  EXPECT_EQ(groups[0].ratios[0].over, 1u);
}

}  // namespace
}  // namespace ist::test
