#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ist/query/contact.h"
#include "ist/query/promise/leaf_grid.h"
#include "ist/query/promise/read_bounds.h"
#include "ist/query/relative_pose.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// An answer with all its contacts.
struct GivenAnswer {
  QueryResult result;
  std::span<const Contact> contacts;
};

/// What is wrong with an answer.
struct Breach {
  std::size_t answer;  ///< which of those that were checked
  std::string what;    ///< names the pair
};

/// Checks whether answers are what every query promises,
///
///   {leaf pairs whose geometry meets} ⊆ answer ⊆ {leaf pairs whose bounds meet, within the pad},
///
/// sorted, each pair once, as many as are counted. It finds near leaves by a hash of their cells
/// and not by the trees, and calculates in double.
///
/// "Meets" is what surely does: cubes a little smaller than they are, and triangles that cross
/// though each corner moved by `tolerance` of all lengths; so there is no false alarm. Triangles
/// that only touch, or lie in one plane, are not asked for. Where spheres stand for triangles and
/// the trees hold none, several answers are compared instead: they may differ only in pairs whose
/// bounds, or those of a pair of their ancestors, overlap by no more than the pads.
class PromiseCheck {
 public:
  /// In parts of the reach of both trees and the distance between them: 2⁻⁴⁰.
  static constexpr double kTolerance = 0x1p-40;

  /// Both trees must have `policy` and outlive it. Cost: 0.2 µs a leaf.
  PromiseCheck(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy);

  /// Whether what the spheres stand for is known: cubes always are, triangles where both trees hold
  /// them.
  [[nodiscard]] bool knows_geometry() const noexcept { return knows_geometry_; }

  /// The first breach in answers of several engines to one pose. Cost: 1 µs a moving leaf near the
  /// fixed body, and 0.2 µs a contact.
  [[nodiscard]] std::optional<Breach> check(const Eigen::Isometry3d& pose,
                                            std::span<const GivenAnswer> answers) const;

 private:
  using Found = std::optional<std::string>;
  [[nodiscard]] Found check_list(const GivenAnswer& answer) const;
  [[nodiscard]] Found check_bounds(const RelativePose& pose, double tolerance,
                                   const GivenAnswer& answer) const;
  [[nodiscard]] std::optional<Breach> find_missing(const RelativePose& pose, double tolerance,
                                                   std::span<const GivenAnswer> answers) const;
  [[nodiscard]] std::optional<Breach> compare(const RelativePose& pose, double tolerance,
                                              std::span<const GivenAnswer> answers) const;
  [[nodiscard]] bool surely_reached(const RelativePose& pose, Contact pair, double doubt) const;
  [[nodiscard]] Bounds leaf_bounds(const SphereTree& tree, const std::vector<std::uint64_t>& codes,
                                   std::uint32_t leaf) const;

  const SphereTree& fixed_;
  const SphereTree& moving_;
  SpherePolicy policy_;
  bool knows_geometry_;
  double moving_radius_;  // of a cube's circumsphere
  LeafGrid grid_;         // of the fixed leaves
  std::vector<std::uint64_t> moving_codes_;
};

}  // namespace ist
