#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>

#include "ist/query/query.h"
#include "query/query_cases.h"
#include "support/shapes.h"

namespace ist::test {

/// Two bodies that touch in many places, with bounds for every policy.
struct Scene {
  std::string name;
  SphereTree fixed, moving;
  Eigen::Isometry3d pose;
};

/// A few of them, to be gone through.
using Scenes = std::initializer_list<std::reference_wrapper<const Scene>>;

// All are made once, by whoever asks first: each test is a process of its own.

/// Two jaws that are closed.
[[nodiscard]] const Scene& jaws();

/// A ball and a block of like voxels; a fine ball and a coarse block, and the other way round,
/// where leaves come at different depths.
[[nodiscard]] std::span<const Scene> solids();

/// A ball almost on itself: little to make, and more pairs than are needed to share the work.
[[nodiscard]] const Scene& shells();

[[nodiscard]] QueryOptions options_of(SpherePolicy policy, const std::string& target = "",
                                      int workers = 1);

/// A pose that brings a vertex of each mesh together, and then `gap` apart in any direction.
[[nodiscard]] Eigen::Isometry3d near_touch(const TriangleMesh& a, const TriangleMesh& b,
                                           const Eigen::Matrix3d& rotation, double gap,
                                           Random& random);

}  // namespace ist::test
