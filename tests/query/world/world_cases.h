#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "ist/query/world/world.h"
#include "support/random.h"

namespace ist::test {

/// A body of a test, and its place.
struct PlacedTree {
  SphereTree tree;
  Eigen::Isometry3d pose;
};

/// Small bodies with triangles, some of them near each other, some touching, some far: `count` of
/// them in a cube of edge `extent`.
[[nodiscard]] std::vector<PlacedTree> scattered(Random& random, std::size_t count, double extent);

/// Options with little memory.
[[nodiscard]] WorldOptions small_world();

/// A world of these bodies, in this order, with a query for each pair.
[[nodiscard]] World world_of(const std::vector<PlacedTree>& bodies,
                             const WorldOptions& options = small_world());

/// Everything that a world answers, in numbers that can be compared: but for the distances, whose
/// ends depend on earlier questions, and `sphere_tests`.
struct WorldAnswers {
  struct OfPair {
    BodyPair bodies;
    QueryStatus status;
    double lower, upper;  // of the roots
    Answer answer;
    std::vector<LeafPair> leaf_pairs = {};
    std::vector<TrianglePair> triangles = {};
    double weight = 0;  // of the contacts
    std::size_t contacts = 0;
    friend bool operator==(const OfPair&, const OfPair&) = default;
  };
  std::vector<OfPair> pairs;
  friend bool operator==(const WorldAnswers&, const WorldAnswers&) = default;
};
[[nodiscard]] WorldAnswers answers_of(World& world);

/// Questions of each kind.
inline constexpr WorldQuestion kNear{WorldQuestion::kNear};
inline constexpr WorldQuestion kIntersects{WorldQuestion::kIntersects};
inline constexpr WorldQuestion kContacts{WorldQuestion::kContacts};
[[nodiscard]] inline WorldQuestion leaf_pairs_in(std::span<LeafPair> out) {
  return {.kind = WorldQuestion::kLeafPairs, .leaf_pairs = out};
}
[[nodiscard]] inline WorldQuestion triangle_pairs_in(std::span<TrianglePair> out) {
  return {.kind = WorldQuestion::kTrianglePairs, .triangle_pairs = out};
}
[[nodiscard]] inline WorldQuestion distance_within(double tolerance) {
  return {WorldQuestion::kDistance, tolerance};
}

/// The answer of a pair, or null where it is not listed.
[[nodiscard]] inline const WorldPair* find(const WorldAnswer& answer, BodyPair bodies) {
  for (const WorldPair& pair : answer.pairs) {
    if (pair.bodies == bodies) return &pair;
  }
  return nullptr;
}

}  // namespace ist::test
