#pragma once

#include <array>
#include <vector>

#include "ist/query/manifold.h"
#include "ist/query/query.h"

namespace ist::test {

/// Room for the answers of every verb of a query. Both trees have voxels and triangles.
struct VerbRoom {
  explicit VerbRoom(const Query& query, const ManifoldOptions& options = {})
      : manifold(query.fixed(), query.moving(), query.policy(), options) {}

  ContactManifold manifold;
  std::vector<LeafPair> leaf_pairs = std::vector<LeafPair>(1 << 17);
  std::vector<TrianglePair> triangle_pairs = std::vector<TrianglePair>(1 << 16);
  std::vector<NearPair> near_pairs = std::vector<NearPair>(1 << 10);
  std::array<NearPair, Query::kMostNearParts> near_parts;
};

/// Asks each verb that a loop may call, and passes each result to `see`. A new verb has a line
/// here.
template <class See>
void ask_every_verb(Query& query, const Eigen::Isometry3d& pose, VerbRoom& room,
                    const Budget& budget, const See& see) {
  see(query.intersects(pose, budget));
  see(query.leaf_pairs(pose, room.leaf_pairs, budget));
  see(query.contacts(pose, room.manifold, budget));
  see(query.distance(pose, 0.01, budget));
  see(query.triangle_pairs(pose, room.triangle_pairs, budget));
  see(query.near_pairs(pose, 0.02, room.near_pairs, budget));
  see(query.near_parts(pose, {0, 1}, 9, room.near_parts));
}

}  // namespace ist::test
