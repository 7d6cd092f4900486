#include "cli/bench/contest.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "cli/bench/fixed_loop.h"

namespace ist::cli {
namespace {

// Long enough that a second worker, which sleeps between turns, is awake for most of it.
constexpr double kTurn = 0.01;  // s
constexpr int kFewestTurns = 3;

}  // namespace

double Contest::system_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Contest::Contest(std::vector<Contestant> contestants, std::vector<BenchPose> poses, Clock now)
    : now_(std::move(now)),
      contestants_(std::move(contestants)),
      poses_(std::move(poses)),
      scores_(contestants_.size(), std::vector<Score>(poses_.size())) {}

void Contest::hold(double seconds, const Proceed& proceed) {
  const double begin = now_();
  std::vector<double> spent(contestants_.size());
  std::vector<int> turns(contestants_.size());
  const auto everybody_had_turns = [&] {
    return std::ranges::all_of(turns, [](int taken) { return taken >= kFewestTurns; });
  };
  while (seconds_since(begin) < seconds || !everybody_had_turns()) {
    const auto next = static_cast<std::size_t>(std::ranges::min_element(spent) - spent.begin());
    const double turn = now_();
    loop_.add(run_fixed_loop());
    take_turn(next);
    spent[next] += seconds_since(turn);
    ++turns[next];
    proceed(std::min(1.0, seconds_since(begin) / seconds));
  }
  taken_ = seconds_since(begin);
}

void Contest::take_turn(std::size_t contestant) {
  const Contestant& asked = contestants_[contestant];
  for (std::size_t pose = 0; pose < poses_.size(); ++pose) static_cast<void>(asked.ask(pose));
  const double begin = now_();
  do {
    for (std::size_t pose = 0; pose < poses_.size(); ++pose) {
      const Contestant::Answer answer = asked.ask(pose);
      scores_[contestant][pose].times.add(answer.microseconds);
      scores_[contestant][pose].listed = answer.listed;
    }
  } while (seconds_since(begin) < kTurn);
}

}  // namespace ist::cli
