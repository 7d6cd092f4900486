#include "query/contacts/plain_contacts.h"

#include <algorithm>
#include <cmath>

#include "ist/tree/saved_spheres.h"
#include "ist/tree/tree_parts.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

// A node in fixed mesh coordinates.
struct Node {
  Vector3d centre;
  double radius;
  Vector3d normal = Vector3d::Zero();
  double offset = 0, half = 0;
};

// All nodes of a tree, levels from the leaves up, and each leaf's ancestors.
struct Body {
  std::vector<std::vector<Node>> nodes;
  std::vector<std::vector<std::uint32_t>> ancestors;  // by leaf, by level
  std::vector<Vector3d> points, normals;              // of leaves
};

Body body_of(const SphereTree& tree, SpherePolicy policy, const Eigen::Isometry3d& pose) {
  Body body;
  const SavedSpheres spheres = save_spheres(tree, policy);
  const Vector3d origin = tree.origin();
  std::vector<std::vector<std::uint32_t>> parents;
  for (int level = 0; level <= tree.depth(); ++level) {
    auto& nodes = body.nodes.emplace_back();
    for (const Ball& ball : spheres[static_cast<std::size_t>(level)]) {
      nodes.push_back({pose * (origin + ball.centre), ball.radius});
    }
    auto& up = parents.emplace_back();
    for (std::uint32_t parent = 0; parent + 1 < tree.parts().octree.nodes(level + 1).size();
         ++parent) {
      for (int slot = 0; slot < tree.parts().octree.child_count(level + 1, parent); ++slot) {
        if (policy == SpherePolicy::kSlab) {
          const Slab slab = tree.parts().saved_slab(level, parent, slot);
          Node& node = nodes[up.size()];
          node.normal = pose.linear() * slab.normal;
          node.offset = slab.offset;
          node.half = slab.half;
        }
        up.push_back(parent);
      }
    }
  }
  for (std::uint32_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
    auto& line = body.ancestors.emplace_back(1, leaf);
    for (std::size_t level = 0; level + 1 < parents.size(); ++level) {
      line.push_back(parents[level][line.back()]);
    }
    const Node& node = body.nodes[0][leaf];
    const double length = node.normal.norm();
    body.points.push_back(node.centre);
    if (length > 0) body.points.back() += node.offset / length * (node.normal / length);
    body.normals.push_back(tree.parts().normals[leaf].coherence() *
                           (pose.linear() * tree.parts().normals[leaf].direction()));
  }
  return body;
}

double slabs_overlap(const Node& a, const Node& b) {
  const double over_a = std::abs(a.normal.dot(b.centre - a.centre) - a.offset);
  const double over_b = std::abs(b.normal.dot(a.centre - b.centre) - b.offset);
  return std::min(a.half + b.radius - over_a, b.half + a.radius - over_b);
}

// Of all pairs of ancestors that are tested: of two cubes the larger is opened, both where neither
// has over √2 times the other's edge.
double least_overlap(const SphereTree& fixed, const SphereTree& moving, const Body& a,
                     const Body& b, std::uint32_t f, std::uint32_t m, bool slabs) {
  auto i = static_cast<std::size_t>(fixed.depth()), j = static_cast<std::size_t>(moving.depth());
  double least = 1e300;
  while (true) {
    const Node &x = a.nodes[i][a.ancestors[f][i]], &y = b.nodes[j][b.ancestors[m][j]];
    const bool leaves = i == 0 && j == 0;
    if (!leaves) least = std::min(least, x.radius + y.radius - (x.centre - y.centre).norm());
    if (slabs) least = std::min(least, slabs_overlap(x, y));
    if (leaves) return least;
    const double ratio = std::ldexp(fixed.voxel_size(), static_cast<int>(i)) /
                         std::ldexp(moving.voxel_size(), static_cast<int>(j));
    const bool open_i = i > 0 && (j == 0 || ratio >= std::sqrt(0.5));
    const bool open_j = j > 0 && (i == 0 || ratio <= std::sqrt(2.0));
    i -= open_i ? 1 : 0;
    j -= open_j ? 1 : 0;
  }
}

}  // namespace

std::vector<PlainPair> plain_pairs(const SphereTree& fixed, const SphereTree& moving,
                                   SpherePolicy policy, const Eigen::Isometry3d& pose) {
  const Body a = body_of(fixed, policy, Eigen::Isometry3d::Identity());
  const Body b = body_of(moving, policy, pose);
  const double s_a = fixed.voxel_size(), s_b = moving.voxel_size();
  const double s = 0.5 * (s_a + s_b), farthest = 0.5 * std::sqrt(3.0) * (s_a + s_b);
  std::vector<PlainPair> pairs;
  for (std::uint32_t f = 0; f < a.points.size(); ++f) {
    for (std::uint32_t m = 0; m < b.points.size(); ++m) {
      const Node &x = a.nodes[0][f], &y = b.nodes[0][m];
      const double reach = x.radius + y.radius, d2 = (x.centre - y.centre).squaredNorm();
      if (d2 >= reach * reach) continue;
      const double u = std::min(1.0, (reach * reach - d2) / (farthest * farthest));
      const double least =
          least_overlap(fixed, moving, a, b, f, m, policy == SpherePolicy::kSlab) / (s / 2);
      const Vector3d mean = (a.normals[f] - b.normals[m]) / 2;
      const double weight = s_a * s_b * u * std::min(1.0, least) * mean.norm();
      if (weight <= 0) continue;
      const Vector3d normal = mean.normalized();
      const double depth = std::clamp(normal.dot(a.points[f] - b.points[m]), -2 * s, s);
      pairs.push_back({f, m, weight, depth, (a.points[f] + b.points[m]) / 2, normal});
    }
  }
  return pairs;
}

ContactSums plain_sums(const std::vector<PlainPair>& pairs, double voxel_size,
                       const Vector3d& about) {
  ContactSums sums;
  sums.about = about;
  for (const PlainPair& pair : pairs) {
    const Vector3d force = pair.weight * pair.normal, arm = pair.position - about;
    const double stretched = pair.depth + 2 * voxel_size;
    ++sums.pairs;
    sums.weight += pair.weight;
    sums.pressure.force += force;
    sums.pressure.torque += arm.cross(force);
    sums.spring.force += stretched * force;
    sums.spring.torque += stretched * arm.cross(force);
  }
  return sums;
}

std::map<std::uint32_t, Contact> plain_points(const std::vector<PlainPair>& pairs) {
  std::map<std::uint32_t, Contact> points;
  for (const PlainPair& pair : pairs) {
    Contact& point =
        points.try_emplace(pair.moving, Contact{Vector3d::Zero(), Vector3d::Zero(), 0, 0})
            .first->second;
    point.position += pair.weight * pair.position;
    point.normal += pair.weight * pair.normal;
    point.depth += pair.weight * pair.depth;
    point.weight += pair.weight;
  }
  for (auto& [leaf, point] : points) {
    point.position /= point.weight;
    point.normal.normalize();
    point.depth /= point.weight;
  }
  return points;
}

}  // namespace ist::test
