#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "answers/bodies.h"
#include "ist/query/query.h"

namespace ist::answers {

/// How deep two bodies are in each other at one pose, and how much of them, mesh units.
struct Depth {
  /// The penetration depth. Empty if a body is open or holds no triangles.
  std::optional<DistanceInterval> certain{};
  bool complete = true;  ///< that interval is as narrow as the tolerance, or as rounding allows
  bool capped = false;   ///< the search ended after 4 million pieces of triangles
  /// The depth of the deepest vertex of either body; empty if it is not known: open bodies are not
  /// near each other, or may meet with no vertex behind the other surface.
  std::optional<double> at_vertices{};
  /// The area of a surface that lies inside the other body: the mean of both, mesh units²; empty
  /// with open bodies that are not near.
  std::optional<double> area{};
  /// A point that is as deep as the lower end of the interval, or that vertex; fixed coordinates.
  std::optional<Eigen::Vector3d> point{};
};

/// Measures how deep the bodies of a query are in each other.
class DepthMeter {
 public:
  /// `query` asks about `bodies`, and must outlive the meter.
  DepthMeter(Query& query, const Bodies& bodies, double tolerance);

  /// Returns the depth at a pose. `near` tells whether the surfaces intersect or lie within
  /// open_reach(). A budget counts points, and may make the interval wider.
  [[nodiscard]] Depth at(const Eigen::Isometry3d& pose, bool near, const Budget& budget) const;

  /// Returns the largest distance behind an open surface that counts as inside, mesh units.
  [[nodiscard]] double open_reach() const;

  /// Returns the reason why no depth is certain: a sentence without a full stop. It calls the depth
  /// a lower bound only if a vertex is inside. Precondition: `depth` has no certain interval.
  [[nodiscard]] std::string why_none(const Depth& depth) const;

 private:
  Query& query_;
  double tolerance_, extent_;
  std::string why_none_;  // a clause; empty if depth is certain
};

}  // namespace ist::answers
