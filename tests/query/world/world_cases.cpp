#include "query/world/world_cases.h"

#include "query/triangles/triangle_tree.h"
#include "support/shapes.h"

namespace ist::test {

std::vector<PlacedTree> scattered(Random& random, std::size_t count, double extent) {
  std::vector<PlacedTree> bodies;
  for (std::size_t i = 0; i < count; ++i) {
    const TriangleMesh mesh = random_mesh(random);
    const Eigen::Isometry3d pose = pose_of(random.rotation(), random.point(0, extent));
    bodies.push_back({triangle_tree(mesh, random.uniform(2, 10)), pose});
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
  world.reserve();
  return world;
}

WorldAnswers answers_of(World& world) {
  std::vector<LeafPair> leaves(1 << 18);
  std::vector<TrianglePair> triangles(1 << 18);
  WorldAnswers all;
  for (const WorldPair& pair : world.ask(kIntersects).pairs) {
    all.pairs.push_back({.bodies = pair.bodies,
                         .status = pair.status,
                         .lower = pair.roots.lower,
                         .upper = pair.roots.upper,
                         .answer = pair.answer});
  }
  const auto of_each = [&](const WorldQuestion& question, const auto& take) {
    const WorldAnswer answer = world.ask(question);
    for (std::size_t k = 0; k < answer.pairs.size(); ++k) take(answer.pairs[k], all.pairs[k]);
  };
  of_each(leaf_pairs_in(leaves), [&](const WorldPair& pair, WorldAnswers::OfPair& of_pair) {
    const auto first = leaves.begin() + static_cast<std::ptrdiff_t>(pair.first);
    of_pair.leaf_pairs.assign(first, first + static_cast<std::ptrdiff_t>(pair.written));
  });
  of_each(triangle_pairs_in(triangles), [&](const WorldPair& pair, WorldAnswers::OfPair& of_pair) {
    const auto first = triangles.begin() + static_cast<std::ptrdiff_t>(pair.first);
    of_pair.triangles.assign(first, first + static_cast<std::ptrdiff_t>(pair.written));
  });
  of_each(kContacts, [](const WorldPair& pair, WorldAnswers::OfPair& of_pair) {
    if (pair.manifold == nullptr) return;
    of_pair.weight = pair.manifold->sums().weight;
    of_pair.contacts = pair.manifold->points().size();
  });
  return all;
}

}  // namespace ist::test
