#include "scaling/asked.h"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <span>

#include "ist/query/workers/shared_work.h"
#include "support/pacer.h"

namespace ist::bench {
namespace {

using Clock = std::chrono::steady_clock;
// Room for all of them: 64 MB. What is truncated ends the program.
constexpr std::size_t kContacts = 1 << 23;

void require(bool good, const char* flaw, std::size_t pose) {
  if (good) return;
  std::cerr << flaw << " at pose " << pose << '\n';
  std::exit(1);
}

bool is_whole(const QueryResult& result) {
  return result.status == QueryStatus::kDone && result.complete && !result.truncated;
}

bool is_same(const QueryResult& a, const QueryResult& b) {
  return a.leaf_pairs == b.leaf_pairs && a.sphere_tests == b.sphere_tests;
}

struct Answer {
  QueryResult result;
  std::vector<LeafPair> leaf_pairs;
};

Answer answer(Query& query, const Eigen::Isometry3d& pose, std::span<LeafPair> room) {
  const QueryResult result = query.leaf_pairs(pose, room);
  const auto found = room.first(std::min<std::uint64_t>(result.leaf_pairs, room.size()));
  return {result, {found.begin(), found.end()}};
}

// The twin is gone when the query is made: of large trees, there is not room for both.
std::vector<Answer> answers_of_twin(const std::pair<SphereTree, SphereTree>& trees,
                                    const std::vector<Eigen::Isometry3d>& poses,
                                    std::span<LeafPair> room) {
  QueryOptions options;
  options.target = "scalar";
  Query twin(trees.first, trees.second, options);
  std::vector<Answer> answers;
  for (const Eigen::Isometry3d& pose : poses) answers.push_back(answer(twin, pose, room));
  return answers;
}

}  // namespace

std::vector<Asked> ask(const std::pair<SphereTree, SphereTree>& trees,
                       const std::vector<Eigen::Isometry3d>& poses, const AskOptions& options) {
  std::vector<LeafPair> leaf_pairs(kContacts);
  const std::vector<Answer> wanted = answers_of_twin(trees, poses, leaf_pairs);
  QueryOptions asked_for;
  asked_for.workers = options.workers;
  asked_for.period = options.period;
  Query query(trees.first, trees.second, asked_for);
  for (std::size_t pose = 0; pose < poses.size(); ++pose) {
    const Answer found = answer(query, poses[pose], leaf_pairs);
    require(
        is_same(found.result, wanted[pose].result) && found.leaf_pairs == wanted[pose].leaf_pairs,
        "the query differs from its scalar twin", pose);
  }
  std::vector<Asked> asked(poses.size());
  Pacer pacer(options.period);
  for (int round = 0; round < options.rounds; ++round) {
    for (std::size_t pose = 0; pose < poses.size(); ++pose) {
      Asked& of = asked[pose];
      const Sharing before = sharing_of(query);
      if (options.period.count() > 0) pacer.wait();
      const auto begin = Clock::now();
      const QueryResult result = query.leaf_pairs(poses[pose], leaf_pairs);
      const std::chrono::duration<double, std::micro> time = Clock::now() - begin;
      const Sharing after = sharing_of(query);
      require(is_whole(result), "an answer that is not whole", pose);
      require(round == 0 || is_same(result, of.result), "another answer than before", pose);
      of.times.add(time.count());
      of.result = result;
      ++of.rounds;
      of.worth += after.worth - before.worth;
      of.shared += after.shared - before.shared;
    }
  }
  return asked;
}

void tell(benchmark::State& state, Asked& asked) {
  asked.times.report(state);
  state.counters["contacts"] = static_cast<double>(asked.result.leaf_pairs);
  state.counters["tests"] = static_cast<double>(asked.result.sphere_tests);
  state.counters["rounds"] = static_cast<double>(asked.rounds);
}

const Asked& Series::report(benchmark::State& state, std::size_t pose) {
  if (asked_.empty()) asked_ = measure_();
  Asked& asked = asked_[pose];
  for (auto _ : state) state.SetIterationTime(1e-6 * asked.times.quantile(0.5));
  tell(state, asked);
  return asked;
}

}  // namespace ist::bench
