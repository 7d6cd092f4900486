#pragma once

#include <string>
#include <vector>

#include "ist/mesh/mesh.h"

namespace ist::test {

/// Two bodies whose surfaces lie along each other, which is the most that there can be to find.
struct ConformalPair {
  std::string name;
  TriangleMesh fixed, moving;
  double gap;  ///< between the surfaces, to within 1 % of what was asked for
};

/// A sphere around a sphere of the same facets.
[[nodiscard]] ConformalPair shell_in_shell(int level, double radius, double gap);
/// A long cylinder in a pipe half as long, their facets side by side.
[[nodiscard]] ConformalPair peg_in_hole(int quarter, double radius, double gap);
/// Two square plates above each other, `size` wide and a quarter as thick: where that is a multiple
/// of the voxels' size, so are their faces.
[[nodiscard]] ConformalPair plates(double size, double gap);
/// A small sphere well within a sphere: roots that touch, and surfaces far apart.
[[nodiscard]] ConformalPair one_inside(int level, double radius);

/// All of them, one at a time of each kind: `radius` is half their size, and surfaces are `gap`
/// apart. About 20 * 4^level triangles a sphere.
[[nodiscard]] std::vector<ConformalPair> conformal_pairs(int level, double radius, double gap);

}  // namespace ist::test
