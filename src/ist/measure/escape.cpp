#include "ist/measure/escape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/pose.h"
#include "ist/base/rigid_move.h"
#include "ist/base/throw_error.h"
#include "ist/measure/escape_lines.h"
#include "ist/measure/escape_steps.h"
#include "ist/measure/free_test.h"
#include "ist/measure/penetration.h"
#include "ist/measure/require.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;
using Pose = Eigen::Isometry3d;
using EscapeStatus = Escape::Status;

// The default tolerance, as a part of the moving body's bounding radius.
constexpr double kToleranceOfRadius = 1e-4;
// Lines are looked for so many times as far as the shortest one.
constexpr double kLinesAsFar = 1.5;
// So many lines are shortened.
constexpr std::size_t kLinesShortened = 3;

Pose pose_of(const Eigen::Matrix3d& rotation, const Vector& translation) {
  Pose pose = Pose::Identity();
  pose.linear() = rotation;
  pose.translation() = translation;
  return pose;
}

// The rounding of a point of the moving body at a pose.
double rounding_at(const SphereTree& moving, const Pose& pose) {
  return 0x1p-48 * (moving.bounding_radius() + moving.origin().cwiseAbs().maxCoeff() +
                    pose.translation().cwiseAbs().maxCoeff());
}

// Bounds the way of each point of a body from one pose to another. The way is the length of an
// affine function of the point. So a vertex goes farthest.
double length_of(const SphereTree& moving, const Pose& from, const Pose& to) {
  const TriangleMesh& mesh = parts_of(moving).triangles->mesh;
  const RigidMove first(from), last(to);
  double most = 0;  // a square
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      const Vector& point = mesh.vertices[v];
      most = std::max(most, square_in_order(difference(last(point), first(point))));
    }
  }
  return std::sqrt(most) * (1 + 0x1p-48) + rounding_at(moving, from) + rounding_at(moving, to);
}

// The motion from one pose to another, in fixed coordinates. A translation is exactly one.
Pose motion_between(const Pose& from, const Pose& to) {
  Pose motion = Pose::Identity();
  if (from.linear() == to.linear()) {
    motion.translation() = difference(to.translation(), from.translation());
    return motion;
  }
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      motion.linear()(i, j) =
          dot_in_order(to.linear().row(i).transpose(), from.linear().row(j).transpose());
    }
  }
  motion.translation() = difference(to.translation(), RigidMove(motion).turned(from.translation()));
  return motion;
}

// The search from one pose.
class EscapeSearch {
 public:
  EscapeSearch(Query& query, const Pose& pose, const EscapeOptions& options, double tolerance)
      : query_(query),
        pose_(pose),
        free_(query, options.proceed),
        longest_(options.longest),
        tolerance_(tolerance) {}

  Escape run() {
    keep(pose_);
    if (free_.at(pose_)) return end(EscapeStatus::kNotNeeded, 0);
    if (free_.is_ended()) return end_early();
    const Penetration depth = penetration(query_, pose_, tolerance_);
    if (depth.status == Penetration::Status::kBusy) free_.end_busy();
    found_.lower = depth.status == Penetration::Status::kDone ? depth.lower : 0;
    if (!(found_.lower <= longest_)) return end(EscapeStatus::kNotFound, kNone);
    find_lines(depth.of_moving ? depth.direction : scaled(-1, depth.direction));
    shorten_lines();
    if (best_ < kNone && best_ <= longest_) return end(EscapeStatus::kFound, best_);
    keep(pose_);
    return free_.is_ended() ? end_early() : end(EscapeStatus::kNotFound, kNone);
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  struct Line {
    double way;
    Vector direction;
  };

  void keep(const Pose& pose) {
    found_.pose_rotation = pose.linear();
    found_.pose_translation = pose.translation();
    const Pose motion = motion_between(pose_, pose);
    found_.rotation = motion.linear();
    found_.translation = motion.translation();
  }
  Escape end(EscapeStatus status, double upper) {
    found_.status = status;
    found_.upper = upper;
    found_.verdicts = free_.verdicts();
    if (status != EscapeStatus::kFound) {
      found_.rotation.setIdentity();
      found_.translation.setZero();
    }
    return found_;
  }
  Escape end_early() {
    return end(free_.is_busy() ? EscapeStatus::kBusy : EscapeStatus::kUnknown, kNone);
  }

  // Keeps a pose that is free if it is the nearest.
  void offer(const Pose& pose) {
    const double length = length_of(query_.moving(), pose_, pose);
    if (!(length < best_)) return;
    best_ = length;
    keep(pose);
  }

  void find_lines(const Vector& deepest) {
    EscapeLines lines(free_, query_, pose_, found_.lower, tolerance_);
    double shortest = longest_;
    for (const Vector& direction : escape_directions(query_, pose_, deepest)) {
      const double most = lines_.empty() ? longest_ : std::min(kLinesAsFar * shortest, longest_);
      const std::optional<double> way = lines.way(direction, most);
      if (free_.is_ended() && !way) return;
      if (!way) continue;
      lines_.push_back({*way, direction});
      shortest = std::min(shortest, *way);
      Pose moved = pose_;
      moved.translation() = sum(pose_.translation(), scaled(*way, direction));
      offer(moved);
    }
  }

  void shorten_lines() {
    std::stable_sort(lines_.begin(), lines_.end(),
                     [](const Line& a, const Line& b) { return a.way < b.way; });
    if (lines_.size() > kLinesShortened) lines_.resize(kLinesShortened);
    if (lines_.empty() || best_ <= found_.lower + tolerance_ || free_.is_ended()) return;
    EscapeSteps steps(query_, free_, pose_, tolerance_);
    for (const Line& line : lines_) {
      Vector6 motion = Vector6::Zero();
      for (Eigen::Index i = 0; i < 3; ++i) motion[i] = line.way * line.direction[i];
      // The frame rounds the line's end.
      if (!free_.at(steps.pose_after(motion))) continue;
      for (const bool turns : {false, true}) {
        steps.shorten(motion, turns);
        offer(steps.pose_after(motion));
      }
      if (best_ <= found_.lower + tolerance_ || free_.is_ended()) return;
    }
  }

  Query& query_;
  const Pose& pose_;
  FreeTest free_;
  double longest_, tolerance_;
  std::vector<Line> lines_;
  double best_ = kNone;
  Escape found_;
};

}  // namespace

const char* to_string(EscapeStatus status) noexcept {
  constexpr std::array kNames = {"found",   "not-needed",   "not-found",
                                 "unknown", "invalid-pose", "busy"};
  const auto at = static_cast<std::size_t>(status);
  return at < kNames.size() ? kNames[at] : "unknown";
}

Pose Escape::motion() const noexcept { return pose_of(rotation, translation); }
Pose Escape::pose() const noexcept { return pose_of(pose_rotation, pose_translation); }

Escape escape(Query& query, const Pose& pose, const EscapeOptions& options) {
  const ScopedFloatEnvironment environment;
  require_triangles(query.fixed(), "fixed");
  require_triangles(query.moving(), "moving");
  require_tolerance(options.tolerance);
  if (!(options.longest >= 0)) {
    throw_error(ErrorCode::kArgumentInvalid, "longest: {} is no length: give one of at least 0",
                options.longest);
  }
  Escape found;
  const std::optional<Pose> rigid = project_to_rigid(pose);
  if (!rigid) {
    found.status = EscapeStatus::kInvalidPose;
  } else {
    query.forget();
    const double wanted = options.tolerance > 0
                              ? options.tolerance
                              : kToleranceOfRadius * query.moving().bounding_radius();
    const double rounding =
        rounding_at(query.moving(), *rigid) + rounding_at(query.fixed(), Pose::Identity());
    found = EscapeSearch(query, *rigid, options, std::max(wanted, 0x1p8 * rounding)).run();
  }
  found.rotation_error = rotation_error(pose);
  return found;
}

}  // namespace ist
