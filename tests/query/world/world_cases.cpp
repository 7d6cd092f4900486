#include "query/world/world_cases.h"

#include "query/exact/exact_tree.h"
#include "support/shapes.h"

namespace ist::test {

std::vector<PlacedTree> scattered(Random& random, std::size_t count, double extent) {
  std::vector<PlacedTree> bodies;
  for (std::size_t i = 0; i < count; ++i) {
    const TriangleMesh mesh = random_mesh(random);
    const Eigen::Isometry3d pose = pose_of(random.rotation(), random.point(0, extent));
    bodies.push_back({exact_tree(mesh, random.uniform(2, 10)), pose});
  }
  return bodies;
}

WorldOptions small_world() {
  WorldOptions options;
  options.query.frontier_pairs = 1 << 8;
  options.manifold.max_leaves = 1 << 8;
  return options;
}

World world_of(const std::vector<PlacedTree>& bodies, const WorldOptions& options) {
  World world(options);
  for (const auto& [tree, pose] : bodies) world.add(tree, pose);
  world.prepare();
  return world;
}

WorldAnswers answers_of(World& world) {
  std::vector<LeafPair> leaves(1 << 18);
  std::vector<TrianglePair> triangles(1 << 18);
  const auto intersections = world.intersects();
  const auto listed = world.leaf_pairs(leaves);
  const auto meeting = world.triangle_pairs(triangles);
  const auto felt = world.contacts();
  WorldAnswers all;
  for (std::size_t k = 0; k < intersections.pairs.size(); ++k) {
    const PairIntersection& pair = intersections.pairs[k];
    const PairLeaves& of_leaves = listed.pairs[k];
    const PairTriangles& of_triangles = meeting.pairs[k];
    const ContactManifold* manifold = felt.pairs[k].manifold;
    all.pairs.push_back({pair.bodies,
                         pair.status,
                         pair.roots.lower,
                         pair.roots.upper,
                         pair.result.answer,
                         {of_leaves.pairs.begin(), of_leaves.pairs.end()},
                         {of_triangles.pairs.begin(), of_triangles.pairs.end()},
                         manifold != nullptr ? manifold->sums().weight : 0,
                         manifold != nullptr ? manifold->points().size() : 0});
  }
  return all;
}

}  // namespace ist::test
