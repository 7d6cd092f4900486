#include "verify/answer_verifier.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ist/base/float_environment.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/tree_parts.h"
#include "verify/leaf_geometry.h"

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

}  // namespace

AnswerVerifier::AnswerVerifier(const SphereTree& fixed, const SphereTree& moving,
                               SpherePolicy policy)
    : fixed_(fixed),
      moving_(moving),
      policy_(policy),
      knows_geometry_(is_implicit(policy) || (fixed.triangles() && moving.triangles())),
      fixed_radius_(fixed.largest_leaf_radius(policy)),
      grid_(fixed, fixed_radius_ + moving.largest_leaf_radius(policy)),
      moving_codes_(moving.parts().octree.codes(0)) {
  fixed.require(policy, "fixed");
  moving.require(policy, "moving");
}

std::optional<Violation> AnswerVerifier::check(const Eigen::Isometry3d& pose,
                                               std::span<const GivenAnswer> answers) const {
  const ScopedFloatEnvironment environment;
  const std::optional<RelativePose> relative =
      relative_pose(pose, fixed_.parts().lattice, moving_.parts().lattice);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if ((answers[i].result.status == QueryStatus::kDone) != relative.has_value()) {
      return Violation{i, "it accepts a pose that is not rigid, or refuses one that is"};
    }
  }
  if (!relative) return std::nullopt;
  const double tolerance = kTolerance * (fixed_.bounding_radius() + moving_.bounding_radius() +
                                         relative->translation.norm());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    Found found = check_list(answers[i]);
    if (!found) found = check_bounds(*relative, tolerance, answers[i]);
    if (found) return Violation{i, *found};
  }
  return find_missing(*relative, tolerance, answers);
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
  const Lattice& lattice = tree.parts().lattice;
  return {implicit_ball(policy_, lattice, 0, cube_centre(lattice, 0, codes[leaf]), 0), {}};
}

AnswerVerifier::Found AnswerVerifier::check_bounds(const RelativePose& pose, double tolerance,
                                                   const GivenAnswer& answer) const {
  for (const LeafPair& pair : answer.leaf_pairs) {
    const Bounds fixed = leaf_bounds(fixed_, grid_.codes(), pair.fixed);
    const Bounds other = moved(pose, leaf_bounds(moving_, moving_codes_, pair.moving));
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

std::optional<Violation> AnswerVerifier::find_missing(const RelativePose& pose, double tolerance,
                                                      std::span<const GivenAnswer> answers) const {
  const Lattice &fixed = fixed_.parts().lattice, &moving = moving_.parts().lattice;
  const CubeAxes axes(fixed.voxel_size, moving.voxel_size, pose.rotation);
  std::optional<Violation> violation;
  std::vector<ClippedTriangle> moved_polygons;
  for (std::uint32_t m = 0; m < moving_codes_.size() && !violation; ++m) {
    const Eigen::Vector3d centre =
        pose.rotation * (moving.voxel_size * cube_centre(moving, 0, moving_codes_[m])) +
        pose.translation;
    const Bounds own = moved(pose, leaf_bounds(moving_, moving_codes_, m));
    // Why a pair must be in the answer, or null if it need not be.
    const auto reason = [&](std::uint32_t f, bool nested) -> const char* {
      if (nested && overlap(policy_, leaf_bounds(fixed_, grid_.codes(), f), own) > tolerance) {
        return "bounds overlap";
      }
      if (!knows_geometry_) return nullptr;
      const std::uint64_t code = grid_.codes()[f];
      const Eigen::Vector3d apart = centre - fixed.voxel_size * cube_centre(fixed, 0, code);
      if (!axes.surely_meet(apart)) return nullptr;  // nor do their contents surely intersect
      if (is_implicit(policy_)) return "cubes intersect";
      if (moved_polygons.empty()) {
        moved_polygons = leaf_polygons(moving_, m, moving_codes_[m]);
        for (ClippedTriangle& polygon : moved_polygons) {
          for (Eigen::Vector3d& p : polygon.corners) p = pose.rotation * p + pose.translation;
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
