#pragma once

#include <chrono>

#include "ist/haptics/effects/effect.h"
#include "ist/query/query.h"

namespace ist {

/// Maps between the mesh coordinates of a fixed and a held body and the scene.
struct BodyFrames {
  double unit;                  ///< metres in a mesh unit, of both bodies
  Placement fixed;              ///< from the fixed mesh, in metres, to the scene
  Eigen::Vector3d tool_origin;  ///< the tool's origin in held mesh coordinates, mesh units
  Eigen::Matrix3d held_turn = Eigen::Matrix3d::Identity();  ///< from held mesh axes to tool axes

  /// Maps held mesh coordinates to fixed mesh coordinates, mesh units.
  [[nodiscard]] Eigen::Isometry3d query_pose(const Placement& tool) const noexcept;
  /// Maps a point in fixed mesh coordinates to the scene.
  [[nodiscard]] Eigen::Vector3d to_scene(const Eigen::Vector3d& point) const noexcept;
};

/// Options of a ToolContactQuery. Lengths are in voxels; see ManifoldOptions.
struct ToolContactOptions {
  SpherePolicy policy = SpherePolicy::kTable;
  double margin = 0.25;               ///< contacts begin at this distance
  double full_area = 10;              ///< of a contact with the whole stiffness, in leaf pairs
  double reach = 0.375;               ///< the greatest distance of the bounds of a leaf pair
  int workers = 1;                    ///< 2: a second thread helps the search
  std::size_t front_pairs = 1 << 16;  ///< the most leaf pairs kept from tick to tick
  std::chrono::nanoseconds period = std::chrono::milliseconds(1);  ///< from one query to the next
};

/// Finds the contacts between a fixed and a held body in scene terms. Holds references to both
/// trees. Memory: a Query and a ContactManifold.
class ToolContactQuery {
 public:
  /// Throws as Query and ContactManifold do.
  ToolContactQuery(const SphereTree& fixed, const SphereTree& held, const BodyFrames& frames,
                   const ToolContactOptions& options);

  /// Finds the contacts at a pose of the tool, and adds them to `contacts` as the pair `number`.
  /// Leaves `contacts` unchanged unless the result is complete. If the bodies are apart, the
  /// distance of the result is a clearance, as far as it is known.
  [[nodiscard]] QueryResult find(const Placement& tool, const Budget& budget,
                                 ToolContacts& contacts, std::size_t number = 0) noexcept;
  /// Moves the bodies.
  void place(const BodyFrames& frames) noexcept { frames_ = frames; }
  [[nodiscard]] std::size_t bytes() const noexcept { return query_.bytes() + manifold_.bytes(); }
  /// Returns the bytes that a query of these trees reserves: what bytes() is of it. Throws as Query
  /// and ContactManifold do, for an option out of range.
  [[nodiscard]] static std::size_t bytes_for(const SphereTree& fixed, const SphereTree& held,
                                             const ToolContactOptions& options);

 private:
  void add_to(ToolContacts& contacts, const Placement& tool) const noexcept;
  void add_rates(SpringRates& rates, double fraction) const noexcept;

  BodyFrames frames_;
  double area_;                  // of a whole leaf pair, mesh units squared
  double full_area_;             // of a contact with the whole stiffness, mesh units squared
  double size_;                  // the mean of the two voxel sizes, mesh units
  double fixed_radius_;          // bounds the fixed body round its frame's origin, mesh units
  Eigen::Vector3d held_origin_;  // of the held tree's frame, held mesh coordinates
  Query query_;
  double margin_;  // mesh units
  ContactManifold manifold_;
};

}  // namespace ist
