#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ist/base/error.h"
#include "ist/mesh/mesh.h"

namespace ist::import {

/// A file to import: its content, and its path, which gives errors their name and side files their
/// folder.
struct Input {
  std::string content;
  std::filesystem::path path;
};

/// The error of an input, without its name: the library adds it.
struct Refusal {
  ErrorCode code;
  std::string place, cause;
};

/// Throws a Refusal.
[[noreturn]] void refuse(ErrorCode code, std::string_view place, std::string_view cause);

/// Returns the transform that moves by `first` and then by `second`. The sums have one order on
/// every platform.
[[nodiscard]] Eigen::Affine3d joined(const Eigen::Affine3d& second, const Eigen::Affine3d& first);

/// The placed meshes of a scene as one list of polygons. A few bytes of a file can place a mesh
/// many times, so the list has a limit (kMostPlaced).
class PlacedPolygons {
 public:
  LengthUnit unit = LengthUnit::kUnknown;
  double factor = 1;  ///< from the file's unit to `unit`

  /// Begins a mesh of so many vertices and corners. Its polygons name the vertices from 0 on.
  /// A transform that mirrors turns polygons round, so that the outer side stays outside.
  /// Errors: kMeshTooLarge, with `place`, which errors of the mesh name too.
  void begin(std::size_t vertices, std::size_t corners, const Eigen::Affine3d& transform,
             std::string place);
  /// Adds a vertex. Errors: kMeshNotFinite, also beyond the range of a float.
  void add_vertex(const Eigen::Vector3d& point);
  /// Adds a polygon; one of fewer than three corners is a point or a line, and is left out.
  /// Errors: kMeshBadIndex.
  void add_polygon(std::span<const std::uint32_t> corners);
  /// Throws kMeshEmpty or kMeshPointsOnly without a polygon.
  void require_polygons() const;

  [[nodiscard]] const std::vector<double>& coordinates() const { return coordinates_; }
  [[nodiscard]] const std::vector<std::uint32_t>& sizes() const { return sizes_; }
  [[nodiscard]] const std::vector<std::uint32_t>& corners() const { return corners_; }

 private:
  std::vector<double> coordinates_;             // three of each vertex
  std::vector<std::uint32_t> sizes_, corners_;  // of each polygon its number of corners
  Eigen::Affine3d transform_ = Eigen::Affine3d::Identity();
  bool mirrors_ = false;
  std::size_t first_ = 0, placed_ = 0;
  std::string place_;
};

}  // namespace ist::import
