#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <memory>

#include "ist/base/api.h"
#include "ist/base/progress.h"
#include "ist/query/query.h"

namespace ist {

struct Penetration;
struct PenetrationOptions;

/// How deep two bodies are in each other: the largest distance of a point of either surface, where
/// it lies inside the other body, from the other surface. A body wholly inside another counts.
struct Penetration {
  /// Whether there is an answer, or why not.
  enum class Status : std::uint8_t {
    kDone,             ///< the interval holds the depth
    kInvalidPose,      ///< the pose is no rigid motion
    kFixedNotClosed,   ///< the fixed body has no certain inside: SphereTree::orientation()
    kMovingNotClosed,  ///< the moving body has no certain inside
    kBusy,             ///< another thread is using the query
  };

  Status status = Status::kDone;  ///< other than kDone: the interval is [0, infinity]
  bool complete = false;          ///< the interval is no wider than the tolerance, or `narrowest`
  bool capped = false;            ///< the search ended after 4 million pieces of triangles
  double lower = 0,               ///< the depth is no less, mesh units; 0: the bodies may be apart
      upper = std::numeric_limits<double>::infinity();  ///< and no more; 0: they do not intersect
  /// A point of a surface that is `lower` deep, to within rounding; fixed coordinates. Zero where
  /// no point was found inside.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  /// The direction from there to the other surface's nearest point, of unit length, fixed axes: the
  /// shortest way out. Zero where no point was found inside.
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  bool of_moving = false;      ///< whose surface the point lies on
  std::uint32_t triangle = 0;  ///< the one of that surface that holds the point
  /// The width below which no tolerance can be reached here: rounding.
  double narrowest = 0;
  /// Whether the surface of a body intersects itself: SphereTree::self_intersections(). Inside is
  /// certain all the same. The depth is the distance from the nearest triangle, which may lie
  /// inside the body.
  bool fixed_self_intersecting = false,  ///< the fixed body's surface
      moving_self_intersecting = false;  ///< the moving body's
  /// Points of which the distance was measured. Tests of outer balls do not count.
  std::uint64_t points = 0;
  /// How far the rotation of the given pose was from orthonormal (rotation_error).
  double rotation_error = 0;
};
/// Returns the status' name, such as "fixed-not-closed", for logs and tests.
[[nodiscard]] IST_API const char* to_string(Penetration::Status status) noexcept;

namespace detail {
struct DepthMemory;
}  // namespace detail

/// What one penetration() leaves to the next one at a pose nearby: bounds of the depths of all
/// parts of both surfaces. They grow by the motion, and only parts that may be too deep are looked
/// at again. Belongs to one thread at a time. Of use only if both bodies have outer balls
/// (prepare_depth()).
class IST_API DepthTracker {
 public:
  /// Tracks nothing yet.
  DepthTracker();
  ~DepthTracker();
  /// Leaves the other one as if it had forgotten all.
  DepthTracker(DepthTracker&&) noexcept;
  /// Leaves the other one as if it had forgotten all.
  DepthTracker& operator=(DepthTracker&&) noexcept;
  /// Forgets all earlier questions, and frees the memory.
  void forget() noexcept;

 private:
  friend Penetration penetration(Query& query, const Eigen::Isometry3d& pose, double tolerance,
                                 const PenetrationOptions& options);
  std::unique_ptr<detail::DepthMemory> memory_;
};

/// The options of penetration().
struct PenetrationOptions {
  /// An earlier answer of the same bodies, for a search that begins where its point is now. The
  /// interval is true whatever this says.
  const Penetration* last = nullptr;
  /// Takes the bounds that an earlier question left, and keeps those of this one. Asked about other
  /// bodies, it begins anew. The interval is true whatever it holds. With a tracker `upper` may be
  /// more than 0, at most the tolerance, for bodies that are apart: nothing looks whether they
  /// touch.
  DepthTracker* tracker = nullptr;
  Budget budget = {};    ///< `tests` counts points; the interval is wider where it ends the search
  Proceed proceed = {};  ///< asked every 1,024 points; the interval is wider where it ends it
};

/// Bounds the depth of two bodies by an interval no wider than `tolerance`, or `narrowest`: by
/// branch and bound over the clusters of both surfaces. Both bodies must be closed. A point is
/// inside a body if its winding number is not 0.
///
/// If both bodies have outer balls (prepare_depth()), these bound nodes and triangles: cost 0.2 to
/// 0.4 ms for jaws in occlusion to 0.01 mm, and 0.02 to 0.06 ms with a tracker at 10 µm a question.
/// Otherwise the bound of a node is its centre's signed distance and its radius: 5 to 10 ms, hardly
/// less from the last answer. Pieces of triangles are also bounded by the distance of their corners
/// from a triangle that is near: a distance from one triangle is a convex function. Allocates; with
/// a tracker, only while its lists grow. The first time for a tree, 1.2 µs a triangle more.
/// Without a budget the search ends in one of two ways. Either the interval is complete, or the
/// search kept 4 million pieces of triangles (2^22): then `capped` is true. Surfaces that lie on
/// each other may need so many, and points whose side is unknown. The answer depends on the bodies
/// and their outer balls, the pose, the tolerance, `last` and the tracker, and on no other earlier
/// question.
/// Throws kTrianglesMissing, and kArgumentInvalid for a tolerance that is negative or NaN.
[[nodiscard]] IST_API Penetration penetration(Query& query, const Eigen::Isometry3d& pose,
                                              double tolerance,
                                              const PenetrationOptions& options = {});

/// The most memory that outer balls take unless a program says more, bytes.
constexpr std::uint64_t kMostBallBytes = std::uint64_t{1} << 30;

/// Makes the outer balls of a body, by which penetration() is 20 to 40 times and distance_map()
/// 1.4 to 1.7 times as fast. Copies of the tree share them. A tree that has them stays as it is.
/// Answers are as true as without them, and have other ends; points may be other points.
///
/// @param tree       the body, with triangles
/// @param max_memory bytes of the balls. With less than the body needs, the call throws, and
///                   questions are answered as before.
/// @param progress   written meanwhile, if not null; Progress::stop() ends the call
///
/// Memory: at most 28 bytes a triangle, or 1 MiB if that is more. Cost: 9 to 18 µs a triangle,
/// shared by all cores. Any thread may call it, but none within a tick. The same balls for any
/// number of threads. Throws kTrianglesMissing, kMemoryLimit and kCancelled.
IST_API void prepare_depth(const SphereTree& tree, std::uint64_t max_memory = kMostBallBytes,
                           Progress* progress = nullptr);

/// Prepares both bodies if that takes less time than it saves in so many depths: from 100 depths
/// on, and one for each 800 triangles. Bodies stay as they are if one is open, has no triangles, or
/// so many that its balls may need more than kMostBallBytes. Throws kCancelled. Returns whether
/// both bodies have outer balls.
IST_API bool prepare_depth_for(std::uint64_t depths, const SphereTree& fixed,
                               const SphereTree& moving, Progress* progress = nullptr);

/// Returns whether a tree has outer balls.
[[nodiscard]] IST_API bool is_prepared_for_depth(const SphereTree& tree) noexcept;

}  // namespace ist
