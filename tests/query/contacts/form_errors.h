#pragma once

#include "ist/tree/sphere_tree.h"
#include "query/contacts/closed_forms.h"

namespace ist::test {

/// Of contact points: depths in voxels, normals in degrees, where both surfaces are smooth.
struct FormErrors {
  std::size_t points = 0;          ///< in all
  std::size_t smooth = 0;          ///< those where both surfaces are smooth
  bool finite = true;              ///< whether all of them are numbers
  double depth = 0, depths = 0;    ///< the largest, and the sum of all
  double normal = 0, normals = 0;  ///< the largest, and the sum of all
  double deepest = -2;             ///< of any point

  void add(const FormErrors& other);
  [[nodiscard]] double mean_depth() const { return depths / static_cast<double>(smooth); }
  [[nodiscard]] double mean_normal() const { return normals / static_cast<double>(smooth); }
};

[[nodiscard]] SphereTree tree_of_solid(const Solid& solid, double voxel_size);

/// Of the bodies when they overlap by `depth` voxels, reduced to at most `most` points. What is
/// true is what both surfaces are at the point; a depth is defined from -2s to s.
[[nodiscard]] FormErrors form_errors(const ClosedForm& form, const SphereTree& fixed,
                                     const SphereTree& moving, SpherePolicy policy, double depth,
                                     std::size_t most = 1 << 14);

}  // namespace ist::test
