#include "ist/query/promise/promise_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ist/base/float_environment.h"
#include "ist/query/promise/leaf_geometry.h"
#include "ist/tree/saved_spheres.h"

namespace ist {
namespace {

constexpr std::uint64_t key(const Contact& c) { return std::uint64_t{c.fixed} << 32 | c.moving; }
constexpr bool precedes(const Contact& p, const Contact& q) { return key(p) < key(q); }

bool holds(const GivenAnswer& answer, const Contact& pair) {
  return std::binary_search(answer.contacts.begin(), answer.contacts.end(), pair, precedes);
}

std::string name(const Contact& pair) {
  return fmt::format("the pair of fixed leaf {} and moving leaf {}", pair.fixed, pair.moving);
}

// Whether any triangle in one leaf surely crosses any in the other; `b` is in a's frame.
bool surely_cross(std::span<const ClippedTriangle> a, std::span<const ClippedTriangle> b,
                  double tolerance) {
  return std::any_of(a.begin(), a.end(), [&](const ClippedTriangle& p) {
    return std::any_of(b.begin(), b.end(),
                       [&](const ClippedTriangle& q) { return surely_cross(p, q, tolerance); });
  });
}

}  // namespace

PromiseCheck::PromiseCheck(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy)
    : fixed_(fixed),
      moving_(moving),
      policy_(policy),
      knows_geometry_(is_implicit(policy) || (fixed.triangles() && moving.triangles())),
      moving_radius_(0.5 * kSqrt3 * moving.lattice().voxel_size),
      grid_(fixed, moving_radius_),
      moving_codes_(moving.octree().codes(0)) {
  fixed.require(policy, "fixed");
  moving.require(policy, "moving");
}

std::optional<Breach> PromiseCheck::check(const Eigen::Isometry3d& pose,
                                          std::span<const GivenAnswer> answers) const {
  const ScopedFloatEnvironment environment;
  const std::optional<RelativePose> relative =
      relative_pose(pose, fixed_.lattice(), moving_.lattice());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if ((answers[i].result.status == QueryStatus::kDone) != relative.has_value()) {
      return Breach{i, "it takes for a rigid pose what is none, or the other way round"};
    }
  }
  if (!relative) return std::nullopt;
  const double tolerance =
      kTolerance * (fixed_.reach() + moving_.reach() + relative->translation.norm());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    Found found = check_list(answers[i]);
    if (!found) found = check_bounds(*relative, tolerance, answers[i]);
    if (found) return Breach{i, *found};
  }
  return knows_geometry_ ? find_missing(*relative, tolerance, answers)
                         : compare(*relative, tolerance, answers);
}

PromiseCheck::Found PromiseCheck::check_list(const GivenAnswer& answer) const {
  const std::span<const Contact> contacts = answer.contacts;
  if (answer.result.contacts != contacts.size()) {
    return fmt::format("it counts {} contacts and gives {}", answer.result.contacts,
                       contacts.size());
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (contacts[i].fixed >= fixed_.octree().leaf_count() ||
        contacts[i].moving >= moving_.octree().leaf_count()) {
      return name(contacts[i]) + " is in the answer, but there is no such leaf";
    }
    if (i > 0 && !precedes(contacts[i - 1], contacts[i])) {
      return name(contacts[i]) + " is in the answer out of order, or twice";
    }
  }
  return std::nullopt;
}

Bounds PromiseCheck::leaf_bounds(const SphereTree& tree, const std::vector<std::uint64_t>& codes,
                                 std::uint32_t leaf) const {
  if (!is_implicit(policy_)) return read_bounds(tree, policy_, 0, leaf);
  const Lattice& lattice = tree.lattice();
  return {implicit_ball(policy_, lattice, 0, cube_centre(lattice, 0, codes[leaf]), 0), {}};
}

PromiseCheck::Found PromiseCheck::check_bounds(const RelativePose& pose, double tolerance,
                                               const GivenAnswer& answer) const {
  for (const Contact& pair : answer.contacts) {
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

std::optional<Breach> PromiseCheck::find_missing(const RelativePose& pose, double tolerance,
                                                 std::span<const GivenAnswer> answers) const {
  const Lattice &fixed = fixed_.lattice(), &moving = moving_.lattice();
  const CubeAxes axes(fixed.voxel_size, moving.voxel_size, pose.rotation);
  std::optional<Breach> breach;
  std::vector<ClippedTriangle> moved_polygons;
  for (std::uint32_t m = 0; m < moving_codes_.size() && !breach; ++m) {
    const Eigen::Vector3d centre =
        pose.rotation * (moving.voxel_size * cube_centre(moving, 0, moving_codes_[m])) +
        pose.translation;
    bool polygons_made = false;
    grid_.near(centre, moving_radius_, [&](std::uint32_t f) {
      const auto lacking =
          std::find_if(answers.begin(), answers.end(), [&](const GivenAnswer& answer) {
            return answer.result.complete && !holds(answer, {f, m});
          });
      if (lacking == answers.end() || breach) return;
      const std::uint64_t code = grid_.codes()[f];
      const Eigen::Vector3d apart = centre - fixed.voxel_size * cube_centre(fixed, 0, code);
      if (!axes.surely_meet(apart)) return;  // so neither does what is in them, surely
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
      breach = Breach{static_cast<std::size_t>(lacking - answers.begin()),
                      fmt::format("{} is not in the answer, but its {}", name({f, m}),
                                  is_implicit(policy_) ? "cubes meet" : "triangles cross")};
    });
  }
  return breach;
}

// Whether every pair of nodes over a pair of leaves overlaps by more than the doubt: then a search
// comes to the leaves, in whatever order it opens nodes.
bool PromiseCheck::surely_reached(const RelativePose& pose, Contact pair, double doubt) const {
  const auto path = [this](const SphereTree& tree, std::uint32_t node) {
    std::vector<Bounds> bounds;
    for (int level = 0; level <= tree.depth(); ++level) {
      bounds.push_back(read_bounds(tree, policy_, level, node));
      node = parent_of(tree.octree(), level, node);
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

std::optional<Breach> PromiseCheck::compare(const RelativePose& pose, double tolerance,
                                            std::span<const GivenAnswer> answers) const {
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const GivenAnswer& has = answers[i];
    for (std::size_t j = 0; j < answers.size(); ++j) {
      if (!answers[j].result.complete) continue;
      for (const Contact& pair : has.contacts) {
        if (holds(answers[j], pair)) continue;
        const double doubt = has.result.pad + answers[j].result.pad + tolerance;
        if (surely_reached(pose, pair, doubt)) {
          return Breach{j, name(pair) +
                               " is in another engine's answer and not in this one's, but "
                               "its bounds overlap"};
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace ist
