// This library beside others that answer the same questions, in one run: on the closing and on the
// poses whose truth is known, at 0.2 mm, one worker. Each round asks everybody who answers a
// question all poses; times are medians over the rounds, and `ratio` how much longer the peer
// takes.
//
//   IST_PEERS_SECONDS   for how long each question is asked, at least 5 rounds; by default 30
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>

#include "peers/ist_peer.h"
#include "peers/poses.h"
#ifdef IST_PEER_FCL
#include "peers/fcl_peer.h"
#endif
#ifdef IST_PEER_EMBREE
#include "peers/embree_peer.h"
#endif
#include "support/bodies.h"
#include "support/latencies.h"

namespace ist::bench {

const char* to_string(Question question) {
  constexpr const char* kNames[] = {"meets", "pairs", "candidates", "distance"};
  return kNames[static_cast<std::size_t>(question)];
}

namespace {

using Clock = std::chrono::steady_clock;
constexpr int kFewestRounds = 5, kMostRounds = 501;

// The first one is this library.
Peers peers() {
  Peers all;
  all.push_back(make_ist_peer());
  const auto add = [&](Peers some) {
    std::move(some.begin(), some.end(), std::back_inserter(all));
  };
#ifdef IST_PEER_FCL
  add(make_fcl_peers(upper_jaw(), lower_jaw()));
#endif
#ifdef IST_PEER_EMBREE
  add(make_embree_peers(upper_jaw(), lower_jaw()));
#endif
  return all;
}

// What anybody said; the pairs are candidates where these were asked for.
struct Answer {
  bool meets = false;
  std::uint64_t pairs = 0;
  GapInterval gap{};
};

Answer ask(Peer& peer, Question question, const Eigen::Isometry3d& pose) {
  Answer answer;
  switch (question) {
    case Question::kMeets:
      answer.meets = peer.meets(pose);
      break;
    case Question::kPairs:
      answer.pairs = peer.pairs(pose);
      break;
    case Question::kCandidates:
      answer.pairs = peer.candidates(pose);
      break;
    case Question::kDistance:
      answer.gap = peer.distance(pose);
      break;
  }
  return answer;
}

bool agree(Question question, const Answer& ist, const Answer& peer) {
  constexpr double kRounding = 1e-5;  // what two ways to compute a distance may differ by, mm
  if (question == Question::kCandidates) return peer.pairs >= ist.pairs;
  return ist.meets == peer.meets && ist.pairs == peer.pairs &&
         ist.gap.lower <= peer.gap.upper + kRounding && peer.gap.lower <= ist.gap.upper + kRounding;
}

// A question, and all who answer it: measured when the first time of it is to be reported.
class Contest {
 public:
  Contest(Question question, const Peers& all, const std::vector<NamedPose>& poses)
      : question_(question), poses_(poses) {
    for (const auto& peer : all) {
      if (peer->answers(question)) players_.push_back({*peer, {}, {}});
    }
  }

  [[nodiscard]] Question question() const { return question_; }
  [[nodiscard]] std::size_t size() const { return players_.size(); }
  [[nodiscard]] const std::string& name(std::size_t player) const {
    return players_[player].peer.name();
  }

  void report(benchmark::State& state, std::size_t player, std::size_t pose) {
    for (auto _ : state) {
      if (rounds_ == 0) measure();
      state.SetIterationTime(1e-6 * players_[player].latencies[pose].quantile(0.5));
    }
    const double of_ist = players_[0].latencies[pose].quantile(0.5);
    const double of_peer = players_[player].latencies[pose].quantile(0.5);
    const Answer &ist = players_[0].answers[pose], &peer = players_[player].answers[pose];
    state.counters["ist_us"] = of_ist;
    state.counters["peer_us"] = of_peer;
    state.counters["ratio"] = of_peer / of_ist;
    state.counters["rounds"] = rounds_;
    state.counters["agree"] = agree(question_, ist, peer) ? 1 : 0;
    if (question_ == Question::kDistance) {
      state.counters["ist_lower"] = ist.gap.lower;
      state.counters["ist_upper"] = ist.gap.upper;
      state.counters["peer_lower"] = peer.gap.lower;
      state.counters["peer_upper"] = peer.gap.upper;
    } else if (question_ == Question::kMeets) {
      state.counters["ist_meets"] = ist.meets ? 1 : 0;
      state.counters["peer_meets"] = peer.meets ? 1 : 0;
    } else {
      state.counters["ist_pairs"] = static_cast<double>(ist.pairs);
      state.counters["peer_pairs"] = static_cast<double>(peer.pairs);
    }
    state.SetLabel(poses_[pose].label);
  }

 private:
  struct Player {
    Peer& peer;
    std::vector<Answer> answers;
    std::vector<Latencies> latencies;
  };

  // Those who differ are named, and their answers reported; they are measured all the same.
  void check() {
    for (Player& player : players_) {
      for (std::size_t i = 0; i < poses_.size(); ++i) {
        player.peer.prepare(poses_[i].pose);
        player.answers.push_back(ask(player.peer, question_, poses_[i].pose));
        if (agree(question_, players_[0].answers[i], player.answers[i])) continue;
        std::cerr << player.peer.name() << " differs in " << to_string(question_) << " at "
                  << poses_[i].label << '\n';
      }
      player.latencies.resize(poses_.size());
    }
  }

  void measure() {
    check();
    const char* seconds = std::getenv("IST_PEERS_SECONDS");
    const auto end =
        Clock::now() + std::chrono::seconds(seconds != nullptr ? std::atoi(seconds) : 30);
    for (; rounds_ < kMostRounds && (rounds_ < kFewestRounds || Clock::now() < end); ++rounds_) {
      for (Player& player : players_) {
        player.peer.prepare(poses_.back().pose);  // so that nobody begins where another has been
        static_cast<void>(ask(player.peer, question_, poses_.back().pose));
        for (std::size_t i = 0; i < poses_.size(); ++i) {
          player.peer.prepare(poses_[i].pose);
          const auto begin = Clock::now();
          benchmark::DoNotOptimize(ask(player.peer, question_, poses_[i].pose));
          player.latencies[i].add(
              std::chrono::duration<double, std::micro>(Clock::now() - begin).count());
        }
      }
    }
  }

  Question question_;
  const std::vector<NamedPose>& poses_;
  std::vector<Player> players_;
  int rounds_ = 0;
};

void add(const std::shared_ptr<Contest>& contest, const std::vector<NamedPose>& poses) {
  for (std::size_t player = 1; player < contest->size(); ++player) {
    for (std::size_t pose = 0; pose < poses.size(); ++pose) {
      const std::string name = std::string("peers/") + to_string(contest->question()) + "/" +
                               contest->name(player) + "/" + poses[pose].name;
      benchmark::RegisterBenchmark(
          name.c_str(), [=](benchmark::State& state) { contest->report(state, player, pose); })
          ->Unit(benchmark::kMicrosecond)
          ->UseManualTime()
          ->Iterations(1);
    }
  }
}

}  // namespace
}  // namespace ist::bench

int main(int argc, char** argv) {
  using namespace ist::bench;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  const Peers all = peers();
  const std::vector<NamedPose> poses = peer_poses();
  for (const Question question : kQuestions) {
    add(std::make_shared<Contest>(question, all, poses), poses);
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
