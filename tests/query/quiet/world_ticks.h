#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ist/query/world/world.h"
#include "query/triangles/triangle_tree.h"
#include "support/shapes.h"

namespace ist::test {

/// Balls in a row, each near the next: most of them prepared, one pair ignored.
inline World row_of_balls() {
  WorldOptions options;
  options.query.frontier_pairs = 1 << 10;
  options.query.front_pairs = 1 << 10;
  World world(options);
  const SphereTree ball = triangle_tree(icosphere(2, 1), 10);
  for (int i = 0; i < 12; ++i) world.add(ball, shift({1.8 * i, 0, 0}));
  world.ignore(0, 1);
  std::vector<BodyPair> some;
  for (BodyIndex i = 1; i < 11; ++i) some.push_back({i, i + 1});
  world.prepare(some);
  return world;
}

/// Asks every verb, while bodies pass each other, far and near, and lose their poses.
/// Returns a sum of what was found.
inline std::uint64_t ask_everything(World& world, std::vector<LeafPair>& leaves,
                                    std::vector<TrianglePair>& triangles) {
  std::uint64_t found = 0;
  for (int tick = 0; tick < 40; ++tick) {
    Budget budget;
    if (tick % 5 == 0) budget.tests = 3000;
    if (tick % 7 == 0) budget.deadline = Budget::Clock::now() + std::chrono::microseconds(50);
    for (BodyIndex body = 0; body < 12; ++body) {
      Eigen::Vector3d to(1.8 * body, 0.05 * tick, 0);
      to[(tick / 10) % 3] += 3.0 * ((body + static_cast<BodyIndex>(tick)) % 5);
      Eigen::Isometry3d pose = shift(to);
      if (tick % 11 == 10 && body == 3) pose.translation()[0] = HUGE_VAL;
      static_cast<void>(world.set_pose(body, pose));
    }
    found += world.ask({}).near_pairs;
    for (const WorldQuestion& question :
         {WorldQuestion{WorldQuestion::kIntersects}, WorldQuestion{WorldQuestion::kContacts},
          WorldQuestion{.kind = WorldQuestion::kLeafPairs, .leaf_pairs = leaves},
          WorldQuestion{.kind = WorldQuestion::kTrianglePairs, .triangle_pairs = triangles},
          WorldQuestion{WorldQuestion::kDistance, 0.01}}) {
      for (const WorldPair& pair : world.ask(question, budget).pairs) {
        found += pair.sphere_tests + pair.found;
      }
    }
    found += world.distance(0.01, budget).sphere_tests;
    if (tick % 13 == 0) world.forget();
  }
  return found;
}

}  // namespace ist::test
