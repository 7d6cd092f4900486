#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "ist/haptics/placement.h"
#include "ist/mesh/mesh.h"
#include "ist/query/inside.h"
#include "ist/query/query.h"

namespace ist {

/// Tests whether held bodies are free of fixed ones, and finds the nearest free place along an
/// axis.
class FreeStart {
 public:
  /// Adds a pair of bodies. All arguments but the last two must outlive the object. If a mesh is
  /// null, a body inside the other one counts as free.
  /// @param pose maps held mesh coordinates to fixed mesh coordinates
  /// @param axis the axis of open_distance(), a unit vector in fixed mesh coordinates
  void add(const SphereTree& fixed, const SphereTree& held, const TriangleMesh* fixed_mesh,
           const TriangleMesh* held_mesh, const Eigen::Isometry3d& pose,
           const Eigen::Vector3d& axis);

  enum class Way { kIntersecting, kInside };
  /// A pair that is not free, by the order of add(), and how.
  struct Flaw {
    std::size_t pair;
    Way way;
  };
  /// Returns the first pair that is not free after a motion of the held bodies along the axis, mesh
  /// units; empty if all are.
  [[nodiscard]] std::optional<Flaw> flaw(double distance = 0) noexcept;

  /// Finds the distance by which the held bodies must move along the axis to be free, mesh units:
  /// the first multiple of a voxel at which all are free and one voxel more. Empty where none is
  /// within the bodies' extents. Cost: 20 to 300 µs a voxel and pair.
  [[nodiscard]] std::optional<double> open_distance() noexcept;

 private:
  struct CheckedPair {
    Query query;
    std::optional<InsideTest> inside;
    Placement pose;  // maps held to fixed mesh coordinates, mesh units
    Eigen::Vector3d axis;
  };

  std::vector<CheckedPair> pairs_;
  double voxel_ = 0, farthest_ = 0;
};

}  // namespace ist
