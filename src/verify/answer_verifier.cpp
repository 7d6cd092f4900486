#include "verify/answer_verifier.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "ist/base/float_environment.h"
#include "ist/tree/tree_parts.h"
#include "ist/voxel/morton.h"
#include "verify/frame_motion.h"

namespace ist {
namespace {

constexpr std::uint64_t key(const LeafPair& c) { return std::uint64_t{c.fixed} << 32 | c.moving; }
constexpr bool precedes(const LeafPair& p, const LeafPair& q) { return key(p) < key(q); }

bool holds(const GivenAnswer& answer, const LeafPair& pair) {
  return std::binary_search(answer.leaf_pairs.begin(), answer.leaf_pairs.end(), pair, precedes);
}

std::string name(const LeafPair& pair) {
  return fmt::format("the pair of fixed leaf {} and moving leaf {}", pair.fixed, pair.moving);
}

// Returns whether a triangle of one leaf surely crosses one of the other; `b` is in a's frame.
bool surely_cross(std::span<const ClippedTriangle> a, std::span<const ClippedTriangle> b,
                  double tolerance) {
  return std::any_of(a.begin(), a.end(), [&](const ClippedTriangle& p) {
    return std::any_of(b.begin(), b.end(),
                       [&](const ClippedTriangle& q) { return surely_cross(p, q, tolerance); });
  });
}

// The centre of a leaf's cube in the tree's frame, mesh units.
Eigen::Vector3d leaf_centre(const Lattice& lattice, std::uint64_t code) {
  const Cell cell = morton_decode(code);
  const Eigen::Vector3d middle(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5);
  return lattice.voxel_size * (middle.array() - lattice.root_centre()).matrix();
}

// Half a voxel's diagonal, mesh units.
double half_diagonal(const Lattice& lattice) { return std::sqrt(0.75) * lattice.voxel_size; }

// Returns the radius of the largest bound of a leaf, mesh units; throws where the tree has none.
double largest_radius(const SphereTree& tree, SpherePolicy policy, std::string_view body) {
  tree.require(policy, body);
  if (is_implicit(policy)) return half_diagonal(voxels_of(tree).lattice);
  double largest = 0;
  for (std::uint32_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
    largest = std::max(largest, read_bounds(tree, policy, leaf).ball.radius);
  }
  return largest;
}

}  // namespace

AnswerVerifier::AnswerVerifier(const SphereTree& fixed, const SphereTree& moving,
                               SpherePolicy policy)
    : fixed_(fixed),
      moving_(moving),
      policy_(policy),
      knows_geometry_(is_implicit(policy) || (fixed.triangles() && moving.triangles())),
      fixed_radius_(largest_radius(fixed, policy, "fixed")),
      grid_(fixed, fixed_radius_ + largest_radius(moving, policy, "moving")),
      moving_codes_(voxels_of(moving).octree.codes(0)) {}

std::optional<Violation> AnswerVerifier::check(const Eigen::Isometry3d& pose,
                                               std::span<const GivenAnswer> answers) const {
  const ScopedFloatEnvironment environment;
  const Rigidity rigid = rigidity_of(pose);
  for (std::size_t i = 0; i < answers.size() && rigid != Rigidity::kEither; ++i) {
    if ((answers[i].result.status == QueryStatus::kDone) != (rigid == Rigidity::kRigid)) {
      return Violation{i, "it accepts a pose that is not rigid, or refuses one that is"};
    }
  }
  if (rigid == Rigidity::kNone) return std::nullopt;
  const Lattice &fixed = voxels_of(fixed_).lattice, &moving = voxels_of(moving_).lattice;
  const auto [motion, error] = frame_motion(pose, fixed, moving);
  const double lengths =
      fixed.edge(fixed.depth) + moving.edge(moving.depth) + motion.translation().norm();
  const double tolerance = kTolerance * lengths + error;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    Found found = check_list(answers[i]);
    if (!found) found = check_bounds(motion, tolerance, answers[i]);
    if (found) return Violation{i, *found};
  }
  return find_missing(motion, tolerance, answers);
}

AnswerVerifier::Found AnswerVerifier::check_list(const GivenAnswer& answer) const {
  const std::span<const LeafPair> leaf_pairs = answer.leaf_pairs;
  if (answer.result.leaf_pairs != leaf_pairs.size()) {
    return fmt::format("it counts {} leaf pairs and lists {}", answer.result.leaf_pairs,
                       leaf_pairs.size());
  }
  for (std::size_t i = 0; i < leaf_pairs.size(); ++i) {
    if (leaf_pairs[i].fixed >= fixed_.leaf_count() ||
        leaf_pairs[i].moving >= moving_.leaf_count()) {
      return name(leaf_pairs[i]) + " is in the answer, but there is no such leaf";
    }
    if (i > 0 && !precedes(leaf_pairs[i - 1], leaf_pairs[i])) {
      return name(leaf_pairs[i]) + " is in the answer out of order, or twice";
    }
  }
  return std::nullopt;
}

Bounds AnswerVerifier::leaf_bounds(const SphereTree& tree, const std::vector<std::uint64_t>& codes,
                                   std::uint32_t leaf) const {
  if (!is_implicit(policy_)) return read_bounds(tree, policy_, leaf);
  const Lattice& lattice = voxels_of(tree).lattice;  // the circumsphere of the leaf's cube
  return {{leaf_centre(lattice, codes[leaf]), half_diagonal(lattice)}, {}};
}

AnswerVerifier::Found AnswerVerifier::check_bounds(const Eigen::Isometry3d& motion,
                                                   double tolerance,
                                                   const GivenAnswer& answer) const {
  for (const LeafPair& pair : answer.leaf_pairs) {
    const Bounds fixed = leaf_bounds(fixed_, grid_.codes(), pair.fixed);
    const Bounds other = moved(motion, leaf_bounds(moving_, moving_codes_, pair.moving));
    const double overlapping = overlap(policy_, fixed, other);
    if (overlapping < -(answer.result.pad + tolerance)) {
      return fmt::format(
          "{} is in the answer, but its bounds are {:.3g} apart, which is more than "
          "the pad of {:.3g}",
          name(pair), -overlapping, answer.result.pad);
    }
  }
  return std::nullopt;
}

std::optional<Violation> AnswerVerifier::find_missing(const Eigen::Isometry3d& motion,
                                                      double tolerance,
                                                      std::span<const GivenAnswer> answers) const {
  const Lattice &fixed = voxels_of(fixed_).lattice, &moving = voxels_of(moving_).lattice;
  const CubeAxes axes(fixed.voxel_size, moving.voxel_size, motion.linear(), tolerance);
  std::optional<Violation> violation;
  std::vector<ClippedTriangle> moved_polygons;
  for (std::uint32_t m = 0; m < moving_codes_.size() && !violation; ++m) {
    const Eigen::Vector3d centre = motion * leaf_centre(moving, moving_codes_[m]);
    const Bounds own = moved(motion, leaf_bounds(moving_, moving_codes_, m));
    // Why a pair must be in the answer, or null if it need not be.
    const auto reason = [&](std::uint32_t f, bool nested) -> const char* {
      if (nested && overlap(policy_, leaf_bounds(fixed_, grid_.codes(), f), own) > tolerance) {
        return "bounds overlap";
      }
      if (!knows_geometry_) return nullptr;
      const std::uint64_t code = grid_.codes()[f];
      const Eigen::Vector3d apart = centre - leaf_centre(fixed, code);
      if (!axes.surely_meet(apart)) return nullptr;  // nor do their contents surely intersect
      if (is_implicit(policy_)) return "cubes intersect";
      if (moved_polygons.empty()) {
        moved_polygons = leaf_polygons(moving_, m, moving_codes_[m]);
        for (ClippedTriangle& polygon : moved_polygons) {
          for (Eigen::Vector3d& p : polygon.corners) p = motion * p;
        }
      }
      return surely_cross(leaf_polygons(fixed_, f, code), moved_polygons, tolerance)
                 ? "triangles cross"
                 : nullptr;
    };
    moved_polygons.clear();
    grid_.near(own.ball.centre, fixed_radius_ + own.ball.radius, [&](std::uint32_t f) {
      for (std::size_t i = 0; i < answers.size() && !violation; ++i) {
        if (!answers[i].result.complete || holds(answers[i], {f, m})) continue;
        if (const char* const why = reason(f, answers[i].nested)) {
          violation =
              Violation{i, fmt::format("{} is not in the answer, but its {}", name({f, m}), why)};
        }
      }
    });
  }
  return violation;
}

}  // namespace ist
