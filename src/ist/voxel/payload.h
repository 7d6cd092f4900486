#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "ist/voxel/lattice.h"
#include "ist/voxel/morton.h"

namespace ist {

/// The geometry that a leaf's bounds must hold, in lattice units.
struct Payload {
  std::vector<Eigen::Vector3d> points;  ///< their convex hull holds the geometry; at least one
  Eigen::Vector3d area;                 ///< sum of the pieces' vector areas, up to a factor
  /// A bound of the points' errors, half of it reserved for the arithmetic of bounds.
  double pad;
  bool is_flat = false;  ///< the points lie in one plane at a right angle to `area`
};

/// Takes the geometry of voxels while they are written.
class PayloadVisitor {
 public:
  virtual ~PayloadVisitor() = default;
  /// Called once, before all visits. `parents` is the number of nodes above the voxels.
  virtual void begin(const Lattice& lattice, std::size_t parents) = 0;
  /// Called once for each voxel. Threads share the voxels, but one thread visits all voxels of a
  /// parent.
  ///
  /// @param parent index of the node above the voxel, in Morton order
  /// @param slot   number of the parent's voxels before this one
  virtual void visit(std::size_t parent, int slot, const Cell& cell, const Payload& payload) = 0;
};

}  // namespace ist
