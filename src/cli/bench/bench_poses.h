#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

#include "cli/bench/contest.h"
#include "ist/tree/sphere_tree.h"

namespace ist::cli {

/// Returns the poses of the built-in jaws: closed, and just before contact.
[[nodiscard]] std::vector<BenchPose> poses_of_jaws();

/// Returns two poses of bodies that a straight way closes, by their triangles: most closed, and one
/// voxel before first contact. The way ends where the moving body is stored, or shortly behind
/// first contact. Throws CLI::ValidationError, which names --poses, for bodies that never meet on
/// it.
[[nodiscard]] std::vector<BenchPose> poses_on_way(const SphereTree& fixed,
                                                  const SphereTree& moving);

/// Returns of the poses the one with most leaf pairs, and the one with fewest. Throws
/// kInputInvalid, which names `file`, where no leaf pair overlaps at any, or as many at each.
[[nodiscard]] std::vector<BenchPose> poses_among(const std::filesystem::path& file,
                                                 const std::vector<Eigen::Isometry3d>& poses,
                                                 const SphereTree& fixed, const SphereTree& moving);

}  // namespace ist::cli
