#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "answers/bodies.h"
#include "answers/depth_meter.h"
#include "ist/measure/escape.h"
#include "ist/query/inside.h"
#include "ist/query/query.h"

namespace ist::answers {

/// The tolerances and the budget of an examination.
struct Questions {
  /// Tolerances, mesh units; by default a 10,000th of the smaller body's largest extent.
  std::optional<double> distance, depth;
  bool triangle_pairs = false;  ///< count all intersecting pairs
  bool escape = false;          ///< find a motion that frees the bodies
  /// The most tests of bounds, points of depth, and verdicts of an escape, that each question may
  /// take.
  std::optional<std::uint64_t> max_tests;
};

/// How bodies meet, from not at all to certainly. kMayBeInside: the surfaces are apart, and one
/// body may lie in the other.
enum class Meeting : std::uint8_t { kNone, kMayBeInside, kUnknown, kMayTouch, kInside, kTouch };
/// Returns a clause: "the bodies touch".
[[nodiscard]] const char* to_string(Meeting meeting);

/// All answers about two bodies at one pose, in mesh units. A member is empty if it is not known or
/// nobody asked for it; `notes` hold the reasons.
struct Findings {
  Answer touch = Answer::kUnknown;
  std::optional<Inside> inside{};
  std::optional<std::uint64_t> triangle_pairs{};
  std::optional<DistanceInterval> distance{};
  std::optional<double> narrowest{};  ///< the width below which the distance cannot be told
  std::optional<NearPair> nearest{};  ///< triangles whose distance lies in the interval
  Depth depth;
  std::optional<Escape> escape{};
  /// Whether a surface intersects itself. Inside is by winding numbers then.
  std::optional<bool> self_intersecting{};
  std::optional<std::uint64_t> contacts{};  ///< contact points of voxels
  std::optional<double> contact_depth{};    ///< of the deepest of them
  double rotation_error = 0;                ///< of the given pose
  std::vector<std::string> notes{};         ///< for people, a few words each

  [[nodiscard]] Meeting meeting() const;
};

/// Answers the questions of people: touch, depth, distance. An answer does not depend on earlier
/// poses.
class Examiner {
 public:
  /// `bodies` must outlive it. `target`: the instruction set; empty: IST_TARGET's, or the best.
  /// Throws kTargetMissing, and kTrianglesMissing if a named question needs triangles.
  Examiner(const Bodies& bodies, const Questions& questions, const std::string& target);

  [[nodiscard]] Findings at(const Eigen::Isometry3d& pose);

  [[nodiscard]] double distance_tolerance() const { return distance_tolerance_; }
  [[nodiscard]] double depth_tolerance() const { return depth_tolerance_; }

 private:
  void find_touch(const Eigen::Isometry3d& pose, Findings& found);
  void find_inside(const Eigen::Isometry3d& pose, Findings& found) const;
  void find_distance(const Eigen::Isometry3d& pose, Findings& found);
  void find_self_intersections(Findings& found) const;
  void find_contacts(const Eigen::Isometry3d& pose, Findings& found);
  void find_escape(const Eigen::Isometry3d& pose, Findings& found);
  void count_triangles(const Eigen::Isometry3d& pose, Findings& found);

  [[nodiscard]] const std::string& name_of(bool moving) const {
    return moving ? bodies_.moving_name : bodies_.fixed_name;
  }

  const Bodies& bodies_;
  Questions questions_;
  Budget budget_;
  double distance_tolerance_, depth_tolerance_;
  Query query_;
  std::optional<ContactManifold> manifold_;       // with voxels
  std::optional<InsideTest> inside_;              // with triangles
  Eigen::AlignedBox3d open_fixed_, open_moving_;  // of a body without a certain inside, else empty
  std::optional<DepthMeter> depth_;
};

}  // namespace ist::answers
