#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "cli/bodies.h"
#include "ist/measure/penetration.h"
#include "ist/query/query.h"

namespace ist::cli {

/// The penetration depth at one pose, mesh units.
struct Depth {
  double lower, upper;
  double at_vertices;                  ///< of the vertices of both bodies alone
  std::optional<double> of_contact{};  ///< of the deepest contact point: along its mean normal
};

/// Measures penetration depths of a pair of bodies, which must outlive it.
class DepthMeter {
 public:
  /// Throws a Failure that names the body which has no triangles, or is not closed.
  DepthMeter(const Bodies& bodies, double tolerance);

  [[nodiscard]] Depth ask(const Eigen::Isometry3d& pose);

 private:
  Query query_;
  ContactManifold manifold_;
  double tolerance_;
};

}  // namespace ist::cli
