#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "query/scenes.h"
#include "simd/targets.h"

namespace ist::test {

/// Every engine of the fast path for two trees and a policy: all targets, with one worker and with
/// two.
class AllEngines {
 public:
  /// Small frontiers are soon made; the second worker has its part with large ones alone.
  AllEngines(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
             std::size_t frontier_pairs = 1 << 10) {
    for (const std::string& target : all_targets()) {
      for (const int workers : {1, 2}) {
        QueryOptions options = options_of(policy, target, workers);
        options.frontier_pairs = frontier_pairs;
        engines_.push_back(std::make_unique<Query>(fixed, moving, options));
      }
    }
  }

  /// The one answer of all of them; a test fails where there are two.
  FoundPairs operator()(const Eigen::Isometry3d& pose) {
    FoundPairs answer = ask(first(), pose);
    EXPECT_EQ(answer.result.status, QueryStatus::kDone);
    EXPECT_TRUE(answer.result.complete);
    for (const auto& engine : engines_) {
      EXPECT_TRUE(same(ask(*engine, pose), answer))
          << engine->target() << " with " << engine->workers() << " at\n"
          << pose.matrix();
    }
    return answer;
  }

  /// One of them, to search with.
  [[nodiscard]] Query& first() { return *engines_.front(); }
  /// The best with two workers.
  [[nodiscard]] const Query& shared() const { return *engines_[1]; }

 private:
  std::vector<std::unique_ptr<Query>> engines_;
};

}  // namespace ist::test
