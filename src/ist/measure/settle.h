#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ist/base/api.h"
#include "ist/base/pose.h"
#include "ist/base/progress.h"
#include "ist/query/query.h"

namespace ist {

/// The options of settle(). A length of 0 means its default. Defaults in millimetres follow the
/// unit of the meshes; a mesh of unknown unit counts as one in millimetres.
struct SettleOptions {
  /// The direction in which the load pushes the moving body, fixed axes; of any length but 0.
  Eigen::Vector3d closing = {0, 0, 1};
  /// The point of the moving body on which the load acts, moving mesh coordinates. By default the
  /// middle of the triangles that meet if the body goes 1 mm beyond its first contact along
  /// `closing`, weighted by their areas; the middle of the body's box if there is no contact.
  std::optional<Eigen::Vector3d> load_point = std::nullopt;
  /// Freedoms that the body does not have: translations along the fixed axes x, y and z of the load
  /// point, then turns about them.
  std::array<bool, 6> held = {};
  double largest_way = 0;   ///< of the load point along each fixed axis, mesh units; 2 mm
  double largest_turn = 0;  ///< each part of the rotation vector, rad; 3 degrees
  double reach = 0;         ///< the length of motions that the proof speaks of, mesh units; 50 µm
  int steps = 600;          ///< the most steps
  Proceed proceed = {};     ///< asked before each step
};

/// A place at which a settled body is held: pairs of triangles no farther apart than 10 µm that are
/// near each other and push in one direction.
struct SettleContact {
  Eigen::Vector3d point,  ///< on the fixed surface, fixed coordinates; the middle of the forces
      normal;             ///< unit vector to the moving body, fixed axes; the middle of the forces
  double force = 0;       ///< length of the sum of its forces, as a part of the load
  double gap = 0;         ///< the least distance of its triangles, mesh units
  TrianglePair triangles = {};  ///< the nearest pair
  std::uint32_t pairs = 0;      ///< pairs of triangles
};

/// Where a body settled, and the proof.
struct IST_API Settlement {
  /// What the pose is.
  enum class Status : std::uint8_t {
    kRests,        ///< free, balanced, and closing no farther than `remaining`
    kRestsLevel,   ///< the same, but nothing holds the body in the directions of `level`
    kLeftTheBox,   ///< the body still closes at a border of the box
    kStopped,      ///< the steps or the caller ended the search; the pose is free
    kUnknown,      ///< the search ended at a free pose, without a proof that it rests
    kInvalidPose,  ///< the given pose is no rigid motion
    kNoFreePose,   ///< the bodies intersect at the given pose, and no free pose was found near it
    kBusy,         ///< another thread is using the query
  };
  Status status = Status::kStopped;  ///< says which members count

  /// The pose: moving mesh coordinates to fixed mesh coordinates. It is free: no triangles meet,
  /// and if a body is closed, the other one is not inside it.
  [[nodiscard]] Eigen::Isometry3d pose() const noexcept;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< of the pose
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();   ///< of the pose
  bool free = false;  ///< whether the pose was proven free; false if the status tells no pose

  /// From the given pose: the way of the load point, fixed axes, mesh units; then the rotation
  /// vector about it, rad.
  Vector6 moved = Vector6::Zero();
  double closed = 0;  ///< the way of the load point along `closing`, mesh units

  /// The distance of the surfaces at the pose.
  DistanceInterval distance{0, std::numeric_limits<double>::infinity()};
  std::vector<SettleContact> contacts = {};  ///< the strongest first
  /// What the forces leave of the load, as a part of it; moments count by `radius`. Freedoms that
  /// are held count nothing.
  double residual = std::numeric_limits<double>::infinity();
  /// A motion of a size of at most `reach` closes no farther, to first order, mesh units. The size
  /// is the root of the sum of squares of the load point's way and of `radius` times the angle.
  double remaining = std::numeric_limits<double>::infinity();
  /// And what curved ways and surfaces may add, mesh units.
  double second_order = std::numeric_limits<double>::infinity();
  /// How far the load lies inside the contacts' hull, seen along `closing`, mesh units. Negative
  /// outside, and 0 or less if the contacts lie on a line.
  double margin = -std::numeric_limits<double>::infinity();
  /// Whether the body rocks: the margin is negative, or the contacts lie on a line.
  bool rocks = false;
  /// Directions in which no contact holds the body, or only one way without a force: way of the
  /// load point and rotation vector, of size 1.
  std::vector<Vector6> level = {};

  Eigen::Vector3d load_point = Eigen::Vector3d::Zero();  ///< moving mesh coordinates
  double radius = 0;  ///< of gyration of the expected contacts about the load point, mesh units
  double reach = 0;   ///< as the options say, or its default
  bool load_guessed = false;  ///< the options had no load point
  bool unit_guessed = false;  ///< no mesh tells its unit: lengths are taken as millimetres
  bool opened = false;        ///< the given pose was not free, and the body was opened first
  int steps = 0;              ///< steps of the search
  double rotation_error = 0;  ///< of the given pose (rotation_error())
};
/// Returns the status' name, such as "left-the-box", for logs and tests.
[[nodiscard]] IST_API const char* to_string(Settlement::Status status) noexcept;

namespace detail {
struct SettleBodies;
}

/// Settles one pair of bodies from many poses.
class IST_API Settler {
 public:
  /// Refers to the query, whose trees have triangles. Throws kTrianglesMissing. Cost: 0.3 µs a
  /// triangle.
  explicit Settler(Query& query);
  /// For another thread: a query of the same trees. Shares what `like` found about the surfaces.
  Settler(Query& query, const Settler& like);
  ~Settler();

  /// As the function settle().
  [[nodiscard]] Settlement settle(const Eigen::Isometry3d& pose, const SettleOptions& options);

 private:
  Query& query_;
  std::shared_ptr<const detail::SettleBodies> bodies_;
};

/// Moves a body along a direction until it rests on the other one: to a local minimum of
/// -closing · load point over all free poses in a box round the given pose. There may be others:
/// one resting pose is never the only one.
///
/// @param query   of two trees with triangles; it forgets its earlier questions
/// @param pose    maps moving mesh coordinates to fixed mesh coordinates; if the bodies intersect
///                there, the moving body first opens by at most `largest_way`
/// @param options the load, the freedoms and the box
///
/// Each step solves a linear program: the features of the surfaces that are near each other stay
/// apart, to first order, and the load point goes as far as possible. Exact triangles decide
/// whether its end is free. The proof is made after the search, by its own code and by the query
/// alone.
///
/// The same bits on every instruction set. Allocates. Cost: some 0.2 s for jaws that close by 1 mm.
/// Throws kTrianglesMissing, and kArgumentInvalid for an option out of range. Source: R. Fletcher,
/// E. Sainz de la Maza, Nonlinear programming and nonsmooth optimization by successive linear
/// programming, Mathematical Programming 43, 1989.
[[nodiscard]] IST_API Settlement settle(Query& query, const Eigen::Isometry3d& pose,
                                        const SettleOptions& options);

/// Settles from many poses, on all cores: as settle() from each. Results stand in the order of the
/// poses, and do not depend on the number of threads. `options.proceed` is not asked.
///
/// @param query   of two trees with triangles
/// @param poses   as of settle()
/// @param options with a load point: else each pose has a load of its own
/// @param proceed asked every few poses; if it ends the call, the rest is kStopped
///
/// Throws as settle(). Each further thread makes a query of its own.
[[nodiscard]] IST_API std::vector<Settlement> settle_all(Query& query,
                                                         std::span<const Eigen::Isometry3d> poses,
                                                         const SettleOptions& options,
                                                         const Proceed& proceed = {});

/// Rests that are one: they close as far, and have the same contacts.
struct SettleGroup {
  std::size_t best;                  ///< the one with the least `remaining`, by its index
  std::vector<std::size_t> members;  ///< all of them, ascending
  double height;  ///< of the best one's load point along the closing direction, fixed coordinates
};

/// Groups the results that rest. Two are in one group if their load points are as far along the
/// closing direction, to within 10 µm, and their contacts with a force are at the same places of
/// the moving body, to within 0.5 mm. The group that closes farthest comes first.
///
/// @param settled of one pair of bodies, with one load
/// @param closing as the options had it
/// @param millimetre the length of 1 mm, mesh units
[[nodiscard]] IST_API std::vector<SettleGroup> group_settled(std::span<const Settlement> settled,
                                                             const Eigen::Vector3d& closing,
                                                             double millimetre);

}  // namespace ist
