#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "ist/mesh/mesh.h"
#include "ist/query/results.h"
#include "ist/tree/sphere_tree.h"
#include "support/random.h"

namespace ist::test {

/// Small meshes of all kinds: spheres, boxes, soups, single triangles, slivers.
[[nodiscard]] TriangleMesh random_mesh(Random& random);

/// A tree of about `cells` voxels along the mesh's largest extent, for every policy.
[[nodiscard]] SphereTree tree_of(const TriangleMesh& mesh, double cells);

/// The 24 turns of the cube onto itself, exact in double.
[[nodiscard]] std::vector<Eigen::Matrix3d> quarter_turns();

[[nodiscard]] Eigen::Isometry3d pose_of(const Eigen::Matrix3d& rotation,
                                        const Eigen::Vector3d& translation);
[[nodiscard]] Eigen::Isometry3d shift(const Eigen::Vector3d& translation);

/// An answer with all its contacts.
struct FoundPairs {
  QueryResult result;
  std::vector<LeafPair> leaf_pairs;
};

/// Whether two answers are the same bits.
[[nodiscard]] bool same(const FoundPairs& a, const FoundPairs& b);

/// Asks any engine for all contacts of a pose.
template <class Query>
[[nodiscard]] FoundPairs ask(Query& query, const Eigen::Isometry3d& pose) {
  FoundPairs answer{{}, std::vector<LeafPair>(1 << 12)};
  answer.result = query.leaf_pairs(pose, answer.leaf_pairs);
  if (answer.result.truncated) {
    answer.leaf_pairs.resize(answer.result.leaf_pairs);
    answer.result = query.leaf_pairs(pose, answer.leaf_pairs);
  }
  answer.leaf_pairs.resize(answer.result.leaf_pairs);
  return answer;
}

/// The last double `t` in [from, to] at which `touches(t)`: true at `from` and false at `to`.
template <class Touches>
[[nodiscard]] double last_touching(double from, double to, const Touches& intersects) {
  while (true) {
    const double middle = from + 0.5 * (to - from);
    if (middle == from || middle == to) return from;
    (intersects(middle) ? from : to) = middle;
  }
}

}  // namespace ist::test
