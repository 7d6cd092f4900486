#include "stability/hard_pair.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ist/base/set_bits.h"
#include "ist/tree/tree_parts.h"
#include "query/contacts/contact_cases.h"
#include "query/scenes.h"
#include "query/triangles/meeting_pairs.h"
#include "query/triangles/mesh_distance.h"
#include "query/triangles/triangle_tree.h"
#include "simd/dispatch.h"
#include "support/rigid_pose.h"
#include "verify/read_bounds.h"

namespace ist::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The centre of a leaf's cube, in voxels from the root cube's.
Eigen::Vector3d cube_centre(const LinearOctree& octree, std::uint32_t leaf) {
  if (octree.depth() == 0) return Eigen::Vector3d::Zero();
  const std::uint32_t parent = parent_of(octree, 0, leaf);
  const auto& at = octree.nodes(1)[parent].centre;
  Eigen::Vector3d centre(at[0], at[1], at[2]);
  const unsigned octant = kSetBits[octree.mask(1, parent)][leaf - octree.first_child(1, parent)];
  for (unsigned axis = 0; axis < 3; ++axis) centre[axis] += (octant >> axis & 1) != 0 ? 0.5 : -0.5;
  return centre;
}

Bounds bounds_of(const SphereTree& tree, SpherePolicy policy, std::uint32_t leaf) {
  if (!is_implicit(policy)) return read_bounds(tree, policy, leaf);
  return {voxels_of(tree).ball(policy, 0, leaf, cube_centre(voxels_of(tree).octree, leaf)), {}};
}

}  // namespace

double leaf_overlap(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                    const Eigen::Isometry3d& between, const LeafPair& pair) {
  return overlap(policy, bounds_of(fixed, policy, pair.fixed),
                 moved(between, bounds_of(moving, policy, pair.moving)));
}

ShapeCases::ShapeCases(const std::string& shape)
    : voxels("shapes", shape + ": voxels", "pads between a triangle and a voxel that lists it"),
      leaf_pairs("shapes", shape + ": leaf pairs", "units that bounds in an answer are apart"),
      gap("shapes", shape + ": gap", "units that the distance is outside its interval"),
      answers("shapes", shape + ": all else", "wrong answers") {}

void check_voxels(const SphereTree& tree, StabilityCase& voxels) {
  constexpr int kParts = 16;  // of a pad: the step of the measurement
  const Lattice& lattice = voxels_of(tree).lattice;
  const std::vector<std::uint64_t> codes = voxels_of(tree).octree.codes(0);
  const TriangleMesh& mesh = parts_of(tree).triangles->mesh;
  const TriangleLists& lists = voxels_of(tree).lists;
  std::vector<std::vector<std::uint64_t>> found(mesh.triangles.size());
  for (std::size_t voxel = 0; voxel < codes.size(); ++voxel) {
    for (const std::uint32_t t : lists[voxel]) found[t].push_back(codes[voxel]);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const ExactPolygon triangle = exact_triangle(mesh, t);
    const std::vector<std::uint64_t> met = cells_met(triangle, lattice, 0);
    const bool whole = std::includes(found[t].begin(), found[t].end(), met.begin(), met.end());
    double most = whole ? 0 : kInfinity;
    for (const std::uint64_t code : found[t]) {
      if (std::binary_search(met.begin(), met.end(), code)) continue;
      int parts = 1;
      while (parts <= 2 * kParts &&
             clip(triangle,
                  grown(node_cube(lattice, 0, code), mpq_class(parts, kParts) * exact_pad(lattice)))
                 .empty()) {
        ++parts;
      }
      most = std::max(most, static_cast<double>(parts) / kParts);
    }
    voxels.samples_of(found[t].size(), most, 1, "triangle " + std::to_string(t));
  }
}

HardPair::Asked::Asked(const SphereTree& fixed, const SphereTree& moving, SpherePolicy by)
    : policy(by), reference(fixed, moving, by), points(fixed, moving, by, {32, 1 << 12}) {
  const auto add = [&](const std::string& target, int workers) {
    QueryOptions options = options_of(by, target, workers);
    options.frontier_pairs = 1 << 10;
    engines.push_back(std::make_unique<Query>(fixed, moving, options));
  };
  for (const Kernels& kernels : all_kernels()) add(kernels.target, 1);
  add("", 2);
}

HardPair::HardPair(const TriangleMesh& fixed, double fixed_voxel, const TriangleMesh& moving,
                   double moving_voxel)
    : fixed_(tree_with_triangles(fixed, fixed_voxel)),
      moving_(tree_with_triangles(moving, moving_voxel)),
      plain_fixed_(without_triangles(fixed_)),
      plain_moving_(without_triangles(moving_)),
      exact_fixed_(fixed, fixed_),
      exact_moving_(moving, moving_),
      longest_edge_(std::max(longest_edge(fixed), longest_edge(moving))) {
  for (const Eigen::Vector3d& v : moving.vertices) {
    largest_coordinate_ = std::max(largest_coordinate_, v.cwiseAbs().maxCoeff());
  }
  for (const SpherePolicy policy : kSpherePolicies) {
    asked_.push_back(std::make_unique<Asked>(fixed_, moving_, policy));
  }
}

bool HardPair::check(const Eigen::Isometry3d& pose, ShapeCases& cases) {
  const ExactPair exact(exact_fixed_, exact_moving_, pose);
  const std::vector<TrianglePair> meeting = meeting_pairs(fixed_, moving_, pose);
  const double distance = meeting.empty() ? mesh_distance(parts_of(fixed_).triangles->mesh,
                                                          parts_of(moving_).triangles->mesh, pose)
                                          : 0;
  std::vector<TrianglePair> pairs(meeting.size() + 1);
  for (const auto& asked : asked_) {
    SCOPED_TRACE(to_string(asked->policy));
    check_leaf_pairs(*asked, exact, pose, cases);
    check_contact_points(*asked, pose, cases.answers);
    for (const auto& engine : asked->engines) {
      const TrianglePairsResult found = engine->triangle_pairs(pose, pairs);
      const bool right = found.triangle_pairs == meeting.size() &&
                         std::equal(meeting.begin(), meeting.end(), pairs.begin()) &&
                         engine->intersects(pose).answer ==
                             (meeting.empty() ? ist::Answer::kNo : ist::Answer::kYes);
      cases.answers.sample(right ? 0 : 1, 0, "triangle pairs");
      check_gap(*engine, distance, pose, cases.gap);
    }
    Query plain(plain_fixed_, plain_moving_, options_of(asked->policy));
    check_gap(plain, distance, pose, cases.gap);
  }
  return !meeting.empty();
}

void HardPair::check_leaf_pairs(Asked& asked, const ExactPair& exact, const Eigen::Isometry3d& pose,
                                ShapeCases& cases) {
  const FoundPairs answer = ask(*asked.engines.front(), pose);
  for (const auto& engine : asked.engines) {
    cases.answers.sample(same(ask(*engine, pose), answer) ? 0 : 1, 0, engine->target());
  }
  const double pad = answer.result.pad;
  const Eigen::Isometry3d between = between_frames(pose, fixed_, moving_);
  double apart = 0;
  for (const LeafPair& pair : answer.leaf_pairs) {
    apart = std::max(apart, -leaf_overlap(fixed_, moving_, asked.policy, between, pair));
  }
  const auto kept = keeps_guarantee(exact, asked.policy, answer.leaf_pairs, pad);
  cases.leaf_pairs.samples_of(std::max<std::size_t>(answer.leaf_pairs.size(), 1),
                              kept ? apart : kInfinity, pad, kept.message());
  const FoundPairs reference = ask(asked.reference, pose);
  const auto guaranteed = keeps_guarantee(exact, asked.policy, reference.leaf_pairs,
                                          reference.result.pad, published_are_nested(asked.policy));
  cases.answers.sample(guaranteed ? 0 : 1, 0, guaranteed.message());
}

void HardPair::check_contact_points(Asked& asked, const Eigen::Isometry3d& pose,
                                    StabilityCase& answers) {
  const double size = 0.5 * (fixed_.voxel_size() + moving_.voxel_size());
  const FoundContacts first = find_contacts(*asked.engines.front(), asked.points, pose);
  answers.sample(is_sound(first, size) ? 0 : 1, 0, "contact points");
  for (const auto& engine : asked.engines) {
    answers.sample(same(find_contacts(*engine, asked.points, pose), first) ? 0 : 1, 0,
                   "contact points of another engine");
  }
}

void HardPair::check_gap(Query& query, double distance, const Eigen::Isometry3d& pose,
                         StabilityCase& gap) {
  const double place = largest_coordinate_ + pose.translation().cwiseAbs().maxCoeff();
  // Of the distance that it is held against, and of the one that a query with triangles measures;
  // and as far as either's moved vertices are rounded.
  const double error = kTriangleDistanceError * (longest_edge_ + distance) + 0x1p-50 * place;
  for (const double tolerance : {0.0, 0.05 * fixed_.voxel_size()}) {
    const DistanceInterval found = query.distance(pose, tolerance).distance;
    gap.sample(outside(found, distance), error);
    const double wide = query.has_triangles()
                            ? tolerance + 2 * error + 0x1p-47 * place
                            : std::max(tolerance, 2 * query.leaf_pairs(pose, {}).resolution);
    gap.sample(std::max(0.0, found.upper - found.lower - wide), error, "width");
  }
  for (const std::uint64_t tests : {1u, 40u, 1000u}) {
    const QueryResult found = query.leaf_pairs(pose, {}, {.tests = tests});
    gap.sample(outside(*found.distance, distance), error, "stopped early");
  }
}

}  // namespace ist::test
