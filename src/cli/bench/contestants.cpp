#include "cli/bench/contestants.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "cli/engine.h"
#include "ist/query/manifold.h"
#include "ist/query/query.h"

namespace ist::cli {
namespace {

using Clock = std::chrono::steady_clock;

double microseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
}

struct Asked {
  const SphereTree& fixed;
  const SphereTree& moving;
  std::span<const BenchPose> poses;
};

SpherePolicy tightest(const Asked& asked) {
  return std::min(asked.fixed.tightest(), asked.moving.tightest());
}

Contestant leaf_pairs(const Asked& asked, const char* way, const char* engine, SpherePolicy policy,
                      int workers) {
  const auto made = std::make_shared<Engine>(engine, asked.fixed, asked.moving,
                                             EngineOptions{.policy = policy, .workers = workers});
  return {"leaf pairs", way, std::string(to_string(policy)), workers,
          [made, poses = asked.poses](std::size_t pose) {
            const Engine::Answer answer = made->ask(poses[pose].pose);
            return Contestant::Answer{answer.microseconds, answer.result.leaf_pairs};
          }};
}

// A hand that trembles about each pose: on a circle of a tenth of a voxel, 100 ticks a turn, which
// at 1,000 Hz is the 10 Hz of a hand. One query a pose, since a leap to another would lose what is
// kept.
class Trembling {
 public:
  Trembling(const Asked& asked, std::size_t front_pairs)
      : poses_(asked.poses),
        voxel_size_(0.5 * (asked.fixed.voxel_size() + asked.moving.voxel_size())) {
    QueryOptions options;
    options.front_pairs = front_pairs;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      places_.push_back(
          {Query(asked.fixed, asked.moving, options),
           ContactManifold(asked.fixed, asked.moving, tightest(asked), kAsALoopAsks)});
    }
  }

  Contestant::Answer tick(std::size_t pose) {
    Place& place = places_[pose];
    Eigen::Isometry3d at = poses_[pose].pose;
    const double turn = 2 * std::numbers::pi * (place.ticks++ % kTicks) / kTicks;
    at.pretranslate(kRadius * voxel_size_ * Eigen::Vector3d(std::cos(turn), std::sin(turn), 0));
    const auto begin = Clock::now();
    static_cast<void>(place.query.contacts(at, place.manifold));
    return {microseconds_since(begin), std::nullopt};  // another number at each tick
  }

 private:
  static constexpr ManifoldOptions kAsALoopAsks{.points = 0, .margin = 0.25, .reach = 0.375};
  static constexpr double kRadius = 0.1;
  static constexpr int kTicks = 100;

  struct Place {
    Query query;
    ContactManifold manifold;
    int ticks = 0;
  };
  std::span<const BenchPose> poses_;
  double voxel_size_;
  std::vector<Place> places_;
};

Contestant trembling(const Asked& asked, const char* way, std::size_t front_pairs) {
  const auto made = std::make_shared<Trembling>(asked, front_pairs);
  return {"contacts", way, std::string(to_string(tightest(asked))), 1,
          [made](std::size_t pose) { return made->tick(pose); }};
}

// Triangles are asked as of a new query each time, so that no answer is known from the one before.
template <typename Question>
Contestant exact(const Asked& asked, const char* question, Question&& ask) {
  const auto query = std::make_shared<Query>(asked.fixed, asked.moving);
  return {question, kFastWay, "", 1, [query, poses = asked.poses, ask](std::size_t pose) mutable {
            query->forget();
            return ask(*query, poses[pose].pose);
          }};
}

void add_exact(const Asked& asked, std::vector<Contestant>& all) {
  all.push_back(exact(asked, "touch", [](Query& query, const Eigen::Isometry3d& pose) {
    const auto begin = Clock::now();
    static_cast<void>(query.intersects(pose));
    return Contestant::Answer{microseconds_since(begin), std::nullopt};
  }));
  all.push_back(exact(asked, "triangle pairs",
                      [pairs = std::vector<TrianglePair>(1 << 12)](
                          Query& query, const Eigen::Isometry3d& pose) mutable {
                        while (true) {
                          const auto begin = Clock::now();
                          const TrianglePairsResult result = query.triangle_pairs(pose, pairs);
                          const double time = microseconds_since(begin);
                          if (!result.truncated)
                            return Contestant::Answer{time, result.triangle_pairs};
                          pairs.resize(2 * result.triangle_pairs);
                          query.forget();
                        }
                      }));
  all.push_back(exact(asked, "distance", [](Query& query, const Eigen::Isometry3d& pose) {
    const auto begin = Clock::now();
    static_cast<void>(query.distance(pose, 0));
    return Contestant::Answer{microseconds_since(begin), std::nullopt};
  }));
}

}  // namespace

std::vector<Contestant> contestants_of(const SphereTree& fixed, const SphereTree& moving,
                                       std::span<const BenchPose> poses) {
  const Asked asked{fixed, moving, poses};
  std::vector<Contestant> all;
  for (const SpherePolicy policy : kSpherePolicies) {
    if (!fixed.has(policy) || !moving.has(policy)) continue;
    all.push_back(leaf_pairs(asked, kPublishedWay, kEngineNames.back(), policy, 1));
    for (const int workers : {1, 2}) {
      all.push_back(leaf_pairs(asked, kFastWay, kEngineNames.front(), policy, workers));
    }
  }
  constexpr std::size_t kFrontPairs = 1 << 17;
  all.push_back(trembling(asked, kSearchWay, 0));
  all.push_back(trembling(asked, kKeptWay, kFrontPairs));
  if (fixed.triangles() != nullptr && moving.triangles() != nullptr) add_exact(asked, all);
  return all;
}

}  // namespace ist::cli
