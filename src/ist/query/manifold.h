#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "ist/base/api.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

namespace detail {
struct Access;
class ContactReducer;
}  // namespace detail

/// A place where a hand feels the other body, in fixed mesh coordinates: the mean, by weight, of
/// the leaf pairs of one fixed leaf, or of a few leaves together. Lengths are in mesh units.
struct Contact {
  Eigen::Vector3d position;  ///< half way between the two surfaces
  Eigen::Vector3d normal;    ///< of unit length, from the fixed body to the moving one
  /// The overlap of the two leaves' surfaces along the normal, negative where they are apart; from
  /// the negative margin to s, with s the mean of the two voxel sizes. It is no measure of how deep
  /// the bodies are in each other.
  double depth;
  /// An area, mesh units²: it grows with the surface in contact, and falls to 0 where a contact
  /// ends.
  double weight;
};

/// A force and its torque about a named point.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< unit and axes as its maker says
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< that unit times a length

  /// Returns the wrench about another point, `by` away from the one before.
  [[nodiscard]] Wrench about(const Eigen::Vector3d& by) const noexcept {
    return {force, torque - by.cross(force)};
  }
};

/// The sums over all leaf pairs of one answer, none merged or left out, that act on the moving
/// body. A pair has a weight w (mesh units²), a unit normal n, a depth d and a position p (mesh
/// units); m is ManifoldOptions::margin, mesh units. The sums are Lipschitz in the pose, so that
/// forces made of them do not jump; docs/guarantees.md gives the rates. They are made in float and
/// fixed point, and do not depend on the order of pairs: the same bits with one worker or two.
struct ContactSums {
  double weight = 0;  ///< Σ w, mesh units²
  Wrench pressure;    ///< Σ w n, mesh units², and Σ p × w n, mesh units³
  Wrench spring;      ///< Σ w (d + m) n, mesh units³, and Σ p × w (d + m) n, mesh units⁴
  std::uint64_t pairs = 0;  ///< leaf pairs with a weight above 0
  /// The point that torques are about: the origin of the fixed tree's frame, fixed mesh
  /// coordinates.
  Eigen::Vector3d about = Eigen::Vector3d::Zero();
};

/// The Lipschitz constants of one leaf pair's terms in ContactSums: |change| <= rate · motion. A
/// sum changes by at most rate · motion · (pairs with a weight before + pairs with a weight after).
///
/// The motion from one pose to another, mesh units, is the distance that the origin of the moving
/// tree's frame moves + lever · |angle in radians| + 2⁻¹⁶ (bounding radius of the fixed tree +
/// lever), for rounding. The rates are derived in docs/guarantees.md, Rates of the contact sums.
struct ContactRates {
  double lever;   ///< radius round the moving frame's origin of every point that counts, mesh units
  double weight,  ///< of w, mesh units
      pressure_force,   ///< of w n, mesh units
      pressure_torque,  ///< of p × w n, mesh units²
      spring_force,     ///< of w (d + m) n, mesh units²
      spring_torque;    ///< of p × w (d + m) n, mesh units³
};

/// The most that an option of memory takes: kArgumentInvalid beyond it.
inline constexpr std::size_t kMostItems = std::size_t{1} << 26;

/// The options of a ContactManifold. Lengths are in mean voxel sizes of the two trees.
struct ManifoldOptions {
  /// The most contacts; 0: the sums alone, which take less time and memory.
  std::size_t points = 32;
  /// The most fixed leaves to keep apart, 80 bytes each. Beyond it, leaves are joined by their
  /// ancestors in the octree.
  std::size_t max_leaves = 1 << 15;
  /// The distance at which springs begin, from 0 to 2: pairs of leaves whose surfaces are farther
  /// apart along their normal weigh nothing. With 0 springs begin where surfaces meet, with 2 every
  /// leaf pair counts.
  ///
  /// The surface of a leaf is the middle of its slab, or without slabs the centre of its ball. So
  /// with 0 a wrench begins at a distance of 0, to within the error of a depth. With slabs and
  /// voxels of size s the error is 0.25 s where the radius of curvature is over 10 s, and at most s
  /// at sharp edges (docs/library.md).
  double margin = 0;
  /// From 0 to 1: leaf pairs count whose bounds are no farther apart. With 0, pairs appear and
  /// vanish as tight bounds cross; load-bearing contacts need every pair within this distance of
  /// the surface.
  double reach = 0;
};

/// All contacts of two bodies at one pose: sums that forces are made of, and a few points. Filled
/// by Query::contacts for the same trees and the same policy.
///
/// The constructor reserves all memory: 80 kB, and with points the leaves and the points. It shares
/// the content of both trees. One manifold belongs to one thread at a time.
class IST_API ContactManifold {
 public:
  /// Throws kVoxelsMissing, kPolicyMissing; kArgumentInvalid for an option out of range;
  /// std::bad_alloc.
  ContactManifold(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                  const ManifoldOptions& options = {});
  ~ContactManifold();
  /// The other may then only be assigned or destroyed.
  ContactManifold(ContactManifold&&) noexcept;
  ContactManifold& operator=(ContactManifold&&) noexcept;  ///< as the constructor

  /// The contacts of the last query: the deepest first, then the extreme ones along x, y and z,
  /// then the others. Empty where that query had a status other than kDone or was not complete.
  [[nodiscard]] std::span<const Contact> points() const noexcept;
  /// The sums of the last query.
  [[nodiscard]] const ContactSums& sums() const noexcept;
  /// The wrench that springs of one stiffness exert on the moving body: stiffness · sums().spring,
  /// about sums().about. With meshes in millimetres and a stiffness in N/mm³ the force is in N and
  /// the torque in N mm. Springs begin at ManifoldOptions::margin.
  [[nodiscard]] Wrench wrench(double stiffness) const noexcept;

  /// The rates at which the sums can change with the pose.
  [[nodiscard]] const ContactRates& rates() const noexcept;
  /// The bounds of the leaf pairs that it is made for.
  [[nodiscard]] SpherePolicy policy() const noexcept;
  /// Bytes reserved.
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  friend struct detail::Access;
  explicit ContactManifold(std::unique_ptr<detail::ContactReducer> reducer) noexcept;

  std::unique_ptr<detail::ContactReducer> reducer_;
};

}  // namespace ist
