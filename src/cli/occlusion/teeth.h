#pragma once

#include <vector>

#include "cli/occlusion/labels/tooth_labels.h"
#include "ist/measure/occlusion.h"
#include "ist/mesh/mesh.h"

namespace ist::cli {

/// The part of one tooth in an occlusion.
struct Tooth {
  int number = 0;
  double area = 0;  ///< in contact, mesh units²
  double share = 0, share_thinner = 0,
         share_thicker = 0;  ///< of all regions of the surface, 0 to 1
  /// Signed, mesh units: of its vertices, and in contact of those of split triangles too; NaN
  /// beyond the reach.
  double least_distance = 0;
};

/// Returns the teeth of a surface by their numbers: all that are labelled. Precondition: a label
/// for each triangle.
[[nodiscard]] std::vector<Tooth> teeth_of(const SurfaceOcclusion& surface, const TriangleMesh& mesh,
                                          const ToothLabels& labels);

}  // namespace ist::cli
