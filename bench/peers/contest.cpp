#include "peers/contest.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>

namespace ist::bench {

const char* to_string(Question question) {
  constexpr const char* kNames[] = {"meets", "pairs", "candidates", "distance"};
  return kNames[static_cast<std::size_t>(question)];
}

const char* to_string(Guarantee guarantee) {
  constexpr const char* kNames[] = {"exact", "rounded", "sampled"};
  return kNames[static_cast<std::size_t>(guarantee)];
}

namespace {

using Clock = std::chrono::steady_clock;
constexpr int kMostRounds = 2001;
constexpr double kRounding = 1e-5;  // what two ways to compute a distance may differ by, mm

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

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

// The same, with the nearest points.
Answer ask_all(Peer& peer, Question question, const Eigen::Isometry3d& pose) {
  Answer answer = ask(peer, question, pose);
  if (question != Question::kDistance) return answer;
  if (const auto points = peer.nearest()) answer.apart = ((*points)[0] - (*points)[1]).norm();
  return answer;
}

// Points of two surfaces are no nearer than the surfaces are. A contestant's own are within its
// interval too.
bool points_agree(const Answer& ist, const Answer& peer) {
  if (!peer.apart || peer.gap.upper == 0) return true;
  return *peer.apart >= ist.gap.lower - kRounding && *peer.apart >= peer.gap.lower - kRounding &&
         *peer.apart <= peer.gap.upper + kRounding;
}

}  // namespace

bool agree(Question question, const Answer& ist, const Answer& peer, Guarantee guarantee) {
  if (question == Question::kCandidates) return peer.pairs >= ist.pairs;
  const double slack = guarantee == Guarantee::kSampled ? voxel_size() : kRounding;
  if (!points_agree(ist, peer)) return false;
  return ist.meets == peer.meets && ist.pairs == peer.pairs &&
         ist.gap.lower <= peer.gap.upper + slack && peer.gap.lower <= ist.gap.upper + slack;
}

std::optional<std::string> untrue(Question question, const Answer& ist, const NamedPose& pose) {
  if (!pose.truth) return {};
  const std::uint64_t pairs = pose.truth->pairs;
  const double distance = pose.truth->distance;
  const std::string place = " at " + pose.name + ", where ";
  if (question == Question::kMeets) {
    if (ist.meets != (pairs > 0)) return "ist: whether triangles meet" + place + "it is known";
  } else if (question != Question::kDistance) {
    if (ist.pairs != pairs) {
      return "ist: " + std::to_string(ist.pairs) + " pairs" + place + std::to_string(pairs) +
             " meet";
    }
  } else if (ist.gap.lower > distance + kRounding || ist.gap.upper < distance - kRounding) {
    return "ist: the gap" + place + "it is " + std::to_string(distance);
  }
  return {};
}

Contest::Contest(Question question, const std::vector<Peer*>& all,
                 const std::vector<NamedPose>& poses)
    : question_(question), poses_(poses) {
  for (Peer* peer : all) {
    if (peer->answers(question)) players_.push_back({*peer, {}, {}});
  }
}

void Contest::hold(double seconds, int fewest) {
  if (!players_[0].answers.empty()) return;
  for (Player& player : players_) {
    player.latencies.resize(poses_.size());
    for (const NamedPose& pose : poses_) {
      player.peer.prepare(pose.pose);
      player.answers.push_back(ask_all(player.peer, question_, pose.pose));
    }
  }
  const auto rank = [&](const Player& player) {
    return player.rounds < kMostRounds ? player.spent : 1e30;
  };
  const auto begin = Clock::now();
  for (;;) {
    Player& next = *std::min_element(players_.begin(), players_.end(),
                                     [&](auto& a, auto& b) { return rank(a) < rank(b); });
    const bool over = next.rounds == kMostRounds || seconds_since(begin) > seconds;
    if (!over) {
      take_turn(next);
      continue;
    }
    const auto few = std::find_if(players_.begin(), players_.end(),
                                  [&](const Player& player) { return player.rounds < fewest; });
    if (few == players_.end()) return;
    take_turn(*few);
  }
}

void Contest::take_turn(Player& player) {
  const auto turn = Clock::now();
  player.peer.prepare(poses_.back().pose);  // so that nobody begins where another has been
  benchmark::DoNotOptimize(ask(player.peer, question_, poses_.back().pose));
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    player.peer.prepare(poses_[i].pose);
    const auto begin = Clock::now();
    benchmark::DoNotOptimize(ask(player.peer, question_, poses_[i].pose));
    player.latencies[i].add(1e6 * seconds_since(begin));
  }
  player.spent += seconds_since(turn);
  ++player.rounds;
}

}  // namespace ist::bench
