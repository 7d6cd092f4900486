#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>

#include "ist/base/api.h"
#include "ist/base/progress.h"
#include "ist/query/query.h"

namespace ist {

/// The shortest rigid motion found that frees two bodies. Free means: no triangles meet, and if a
/// body is closed, the other one is not inside it. The length of a motion is the distance from a
/// point's first to its last place, of the point of the moving body that goes farthest. The way in
/// between does not count, and may lead through the other body.
struct IST_API Escape {
  /// Whether there is a motion, or why not.
  enum class Status : std::uint8_t {
    kFound,        ///< the motion frees the bodies
    kNotNeeded,    ///< the bodies are free at the given pose: the motion is the identity
    kNotFound,     ///< no motion was found that is no longer than `longest`
    kUnknown,      ///< the caller ended the search before a motion was found
    kInvalidPose,  ///< the given pose is no rigid motion
    kBusy,         ///< another thread is using the query
  };
  Status status = Status::kUnknown;  ///< says which members count

  /// The motion: it maps a place at the given pose to the place at pose(), fixed coordinates, to
  /// within rounding. The identity without a motion.
  [[nodiscard]] Eigen::Isometry3d motion() const noexcept;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< of the motion
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();   ///< of the motion

  /// The pose after the motion, moving mesh coordinates to fixed mesh coordinates: the bodies are
  /// free there. The given pose without a motion.
  [[nodiscard]] Eigen::Isometry3d pose() const noexcept;
  Eigen::Matrix3d pose_rotation = Eigen::Matrix3d::Identity();  ///< of pose()
  Eigen::Vector3d pose_translation = Eigen::Vector3d::Zero();   ///< of pose()

  /// No motion that frees the bodies is shorter, mesh units: the lower end of the penetration
  /// depth. 0 if a body is not closed.
  double lower = 0;
  /// The motion is no longer, mesh units; infinity without a motion.
  double upper = std::numeric_limits<double>::infinity();
  std::uint64_t verdicts = 0;  ///< poses at which exact triangles were asked
  double rotation_error = 0;   ///< of the given pose (rotation_error())
};
/// Returns the status' name, such as "not-needed", for logs and tests.
[[nodiscard]] IST_API const char* to_string(Escape::Status status) noexcept;

/// The options of escape().
struct EscapeOptions {
  /// A line to a free pose ends so near its first contact, mesh units; 0: a 10,000th of the moving
  /// body's bounding radius.
  double tolerance = 0;
  /// Longer motions are not looked for, mesh units.
  double longest = std::numeric_limits<double>::infinity();
  Proceed proceed = {};  ///< asked before each verdict; the best motion so far is the answer
};

/// Finds a short motion that frees two bodies. Translations come first: along the way out of the
/// deepest point, the normals of triangles that meet, and the axes. Exact triangles decide where
/// each line becomes free. Then steps shorten the best three: the surfaces' features stay apart, to
/// first order, and the point that goes farthest goes less far. These steps turn the body too.
///
/// The motion is a local minimum at best: a shorter one may exist, but none shorter than `lower`.
/// `query` forgets its earlier questions. The same bits on every instruction set. Allocates. Cost:
/// 0.03 to 1 s for jaws. Throws kTrianglesMissing, and kArgumentInvalid for a tolerance or a
/// longest way that is negative or NaN.
[[nodiscard]] IST_API Escape escape(Query& query, const Eigen::Isometry3d& pose,
                                    const EscapeOptions& options = {});

}  // namespace ist
