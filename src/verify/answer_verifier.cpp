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
      moving_radius_(0.5 * kSqrt3 * moving.voxel_size()),
      grid_(fixed, moving_radius_),
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
  return knows_geometry_ ? find_missing(*relative, tolerance, answers)
                         : compare(*relative, tolerance, answers);
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
  if (!is_implicit(policy_)) return read_bounds(tree, policy_, 0, leaf);
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
    bool polygons_made = false;
    grid_.near(centre, moving_radius_, [&](std::uint32_t f) {
      const auto lacking =
          std::find_if(answers.begin(), answers.end(), [&](const GivenAnswer& answer) {
            return answer.result.complete && !holds(answer, {f, m});
          });
      if (lacking == answers.end() || violation) return;
      const std::uint64_t code = grid_.codes()[f];
      const Eigen::Vector3d apart = centre - fixed.voxel_size * cube_centre(fixed, 0, code);
      if (!axes.surely_meet(apart)) return;  // then their contents do not surely intersect either
      if (!is_implicit(policy_)) {
        if (!polygons_made) {
          moved_polygons = leaf_polygons(moving_, m, moving_codes_[m]);
          for (ClippedTriangle& polygon : moved_polygons) {
            for (Eigen::Vector3d& p : polygon.corners) p = pose.rotation * p + pose.translation;
          }
          polygons_made = true;
        }
        if (!surely_cross(leaf_polygons(fixed_, f, code), moved_polygons, tolerance)) return;
      }
      violation =
          Violation{static_cast<std::size_t>(lacking - answers.begin()),
                    fmt::format("{} is not in the answer, but its {}", name({f, m}),
                                is_implicit(policy_) ? "cubes intersect" : "triangles cross")};
    });
  }
  return violation;
}

// Returns whether the bounds of a pair of leaves, and of all pairs of their ancestors, overlap by
// more than the doubt: then every order of traversal reaches the leaves.
bool AnswerVerifier::ancestors_overlap(const RelativePose& pose, LeafPair pair,
                                       double doubt) const {
  const auto path = [this](const SphereTree& tree, std::uint32_t node) {
    std::vector<Bounds> bounds;
    for (int level = 0; level <= tree.depth(); ++level) {
      bounds.push_back(read_bounds(tree, policy_, level, node));
      node = parent_of(tree.parts().octree, level, node);
    }
    return bounds;
  };
  const std::vector<Bounds> fixed = path(fixed_, pair.fixed);
  for (const Bounds& own : path(moving_, pair.moving)) {
    const Bounds other = moved(pose, own);
    for (const Bounds& bounds : fixed) {
      if (!(overlap(policy_, bounds, other) > doubt)) return false;
    }
  }
  return true;
}

std::optional<Violation> AnswerVerifier::compare(const RelativePose& pose, double tolerance,
                                                 std::span<const GivenAnswer> answers) const {
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const GivenAnswer& has = answers[i];
    for (std::size_t j = 0; j < answers.size(); ++j) {
      if (!answers[j].result.complete) continue;
      for (const LeafPair& pair : has.leaf_pairs) {
        if (holds(answers[j], pair)) continue;
        const double doubt = has.result.pad + answers[j].result.pad + tolerance;
        if (ancestors_overlap(pose, pair, doubt)) {
          return Violation{j, name(pair) +
                                  " is in another engine's answer and not in this one's, but "
                                  "its bounds overlap"};
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace ist
