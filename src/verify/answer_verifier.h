#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ist/query/results.h"
#include "ist/tree/sphere_tree.h"
#include "verify/leaf_geometry.h"
#include "verify/read_bounds.h"

namespace ist {

/// The answer of an engine with all its leaf pairs.
struct GivenAnswer {
  QueryResult result;
  std::span<const LeafPair> leaf_pairs;
  bool nested = true;  ///< whether the tested bounds are nested: not the published ones of `table`
};

/// A violation of the guarantee by an answer.
struct Violation {
  std::size_t answer;  ///< index into the checked answers
  std::string detail;  ///< names the leaf pair, if any, and the violation
};

/// Checks answers against the guarantee of every query,
///
///   {leaf pairs whose bounds overlap} ⊆ answer ⊆ {leaf pairs whose bounds overlap, within the
///   pad},
///
/// sorted, without duplicates, as many as counted; and against what it is for: an answer has every
/// pair whose geometry intersects, as far as the trees hold it. Of an answer from bounds that are
/// not nested, the second is required alone.
///
/// Shares no step of a query: projects and composes the pose by itself (frame_motion), finds near
/// leaves by a hash of their cells, and tests them in double. Its input is the trees' leaves: it
/// reads their Morton codes and saved bounds, and clips their triangles, by the library's code.
///
/// Requires certain pairs only, so there are no false alarms: bounds that overlap by more than
/// `tolerance` of all lengths, cubes that intersect if shrunk by CubeAxes::kShrink, and triangles
/// that still cross if each corner moves by the tolerance. Triangles that only touch or are
/// coplanar are not required.
class AnswerVerifier {
 public:
  /// The tolerance relative to the edges of both root cubes plus their distance: 2⁻⁴⁰. The rounding
  /// of a pose far from the origin is added (FrameMotion::error).
  static constexpr double kTolerance = 0x1p-40;

  /// Prepares the checks. Both trees must have `policy` and outlive the verifier. Cost: 0.3 µs a
  /// leaf.
  AnswerVerifier(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy);

  /// Returns whether the geometry in the leaves is known: cubes always are, triangles if both trees
  /// hold them.
  [[nodiscard]] bool knows_geometry() const noexcept { return knows_geometry_; }

  /// Returns the first violation in the answers of several engines at one pose. Cost: 1 µs a moving
  /// leaf near the fixed body, and 0.2 µs a leaf pair.
  [[nodiscard]] std::optional<Violation> check(const Eigen::Isometry3d& pose,
                                               std::span<const GivenAnswer> answers) const;

 private:
  using Found = std::optional<std::string>;
  [[nodiscard]] Found check_list(const GivenAnswer& answer) const;
  [[nodiscard]] Found check_bounds(const Eigen::Isometry3d& motion, double tolerance,
                                   const GivenAnswer& answer) const;
  [[nodiscard]] std::optional<Violation> find_missing(const Eigen::Isometry3d& motion,
                                                      double tolerance,
                                                      std::span<const GivenAnswer> answers) const;
  [[nodiscard]] Bounds leaf_bounds(const SphereTree& tree, const std::vector<std::uint64_t>& codes,
                                   std::uint32_t leaf) const;

  const SphereTree& fixed_;
  const SphereTree& moving_;
  SpherePolicy policy_;
  bool knows_geometry_;
  double fixed_radius_;  // of the largest fixed leaf, mesh units
  LeafGrid grid_;        // the fixed leaves
  std::vector<std::uint64_t> moving_codes_;
};

}  // namespace ist
