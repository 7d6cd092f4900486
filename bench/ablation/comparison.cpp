#include "ablation/comparison.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <string>

#include "ist/query/reference/reference_query.h"
#include "ist/tree/tree_parts.h"
#include "support/effort.h"
#include "verify/answer_verifier.h"

namespace ist::bench {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using Search = Parts::Search;
constexpr milliseconds kUntimed{12}, kTimed{15};
constexpr std::size_t kContacts = 1 << 20;

std::string name(const Parts& parts) {
  constexpr const char* kSearches[] = {"pointers", "linear", "batches"};
  return std::string(kSearches[static_cast<int>(parts.search)]) + ", " +
         std::string(to_string(parts.policy)) + ", " + parts.target +
         ", workers: " + std::to_string(parts.workers);
}

[[noreturn]] void fail(const Parts& parts, std::size_t pose, const std::string& what) {
  std::cerr << "ablation: the query of " << name(parts) << " at dz = " << kClosing[pose] << ": "
            << what << '\n';
  std::exit(1);
}

bool same_counts(const QueryResult& a, const QueryResult& b) {
  return a.leaf_pairs == b.leaf_pairs && a.sphere_tests == b.sphere_tests;
}

struct Answer {
  QueryResult result;
  std::vector<LeafPair> leaf_pairs;
};

Answer ask(Measured& measured, std::size_t pose) {
  Answer answer{{}, std::vector<LeafPair>(kContacts)};
  answer.result = measured.variant.leaf_pairs(closing(kClosing[pose]), answer.leaf_pairs);
  if (!answer.result.complete || answer.result.truncated) {
    fail(measured.parts, pose, "it does not give all its contacts");
  }
  answer.leaf_pairs.resize(answer.result.leaf_pairs);  // what lies behind them is no answer
  return answer;
}

}  // namespace

Comparison::Comparison(double voxel_size, const std::vector<Parts>& parts)
    : bodies_{trees(voxel_size).first, trees(voxel_size).second,
              PointerTree(voxels_of(trees(voxel_size).first).octree),
              PointerTree(voxels_of(trees(voxel_size).second).octree)},
      leaf_pairs_(kContacts) {
  for (const Parts& one : parts) {
    const bool known = std::any_of(measured_.begin(), measured_.end(),
                                   [&](const Measured& other) { return other.parts == one; });
    if (!known) measured_.push_back({one, Variant(bodies_, one)});
  }
}

Measured& Comparison::of(const Parts& parts) {
  return *std::find_if(measured_.begin(), measured_.end(),
                       [&](const Measured& other) { return other.parts == parts; });
}

void Comparison::check() {
  for (const SpherePolicy policy : kSpherePolicies) check(policy);
}

void Comparison::check(SpherePolicy policy) {
  const Parts as_specified{Search::kLinear, policy}, in_batches{Search::kBatches, policy};
  Measured reference{as_specified, Variant(bodies_, as_specified)};
  Measured scalar{in_batches, Variant(bodies_, in_batches)};
  const AnswerVerifier verifier(bodies_.fixed, bodies_.moving, policy);
  for (std::size_t pose = 0; pose < kPoses; ++pose) {
    const Answer specified = ask(reference, pose), batches = ask(scalar, pose);
    if (pose == 0 || !quick()) {  // the longest of the checks; pose 0 has the most contacts
      const GivenAnswer given[] = {
          {specified.result, specified.leaf_pairs, published_are_nested(policy)},
          {batches.result, batches.leaf_pairs}};
      if (const std::optional<Violation> violation =
              verifier.check(closing(kClosing[pose]), given)) {
        fail(violation->answer == 0 ? as_specified : in_batches, pose, violation->detail);
      }
    }
    for (Measured& measured : measured_) {
      if (measured.parts.policy != policy) continue;
      const Answer answer = ask(measured, pose);
      const Answer& twin = measured.parts.search == Search::kBatches ? batches : specified;
      if (!same_counts(answer.result, twin.result) || answer.leaf_pairs != twin.leaf_pairs) {
        fail(measured.parts, pose, "it differs from its twin");
      }
      measured.results[pose] = answer.result;
    }
  }
}

void Comparison::measure(int rounds) {
  for (int round = 0; round < rounds; ++round) {
    for (Measured& measured : measured_) take_turn(measured);
  }
}

void Comparison::take_turn(Measured& measured) {
  const auto ask_closing = [&](bool timed) {
    for (std::size_t pose = 0; pose < kPoses; ++pose) {
      const auto begin = Clock::now();
      const QueryResult result = measured.variant.leaf_pairs(closing(kClosing[pose]), leaf_pairs_);
      const std::chrono::duration<double, std::micro> time = Clock::now() - begin;
      if (!same_counts(result, measured.results[pose])) {
        fail(measured.parts, pose, "it does not repeat its answer");
      }
      if (timed) measured.latencies[pose].add(time.count());
    }
    if (timed) ++measured.rounds;
  };
  auto begin = Clock::now();
  do {
    ask_closing(false);
  } while (Clock::now() - begin < kUntimed);
  begin = Clock::now();
  do {
    ask_closing(true);
  } while (Clock::now() - begin < kTimed);
}

}  // namespace ist::bench
