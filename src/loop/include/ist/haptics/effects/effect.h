#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "ist/base/api.h"
#include "ist/haptics/placement.h"

namespace ist {

/// A contact point of the tool: metres, scene axes.
struct ToolContact {
  Eigen::Vector3d arm;     ///< from the tool's origin to the point
  Eigen::Vector3d normal;  ///< of unit length, from the fixed body to the held one
  double depth;            ///< at least 0; 0 where contacts begin
  /// The point's part of the stiffness and the damping of its contact, 0 to 1: the point's area
  /// divided by the area of all points of its pair of bodies, or by SpringsSettings::full_area if
  /// that is more. Many points share one stiffness. So a broad contact is as stiff as a small one
  /// (McNeely et al. 1999, section 4.4).
  double stiffness_fraction;

  /// The displacement of the point for a small motion of the tool, metres.
  [[nodiscard]] Eigen::Vector3d moved(const Vector6& motion) const noexcept {
    return motion.head<3>() + motion.tail<3>().cross(arm);
  }
};

/// The contact points of one pair of bodies: a fixed one, and one that the hand holds.
struct ContactPair {
  std::size_t number;  ///< of the pair, the same in every tick
  std::size_t begin,   ///< of its points, in ToolContacts::points()
      end;             ///< behind the last of them
  /// The motion of the fixed body in this tick, about the tool's origin; zero while it rests.
  Vector6 drift = Vector6::Zero();
};

/// How fast ToolContacts::spring can change while every fixed body rests: the Lipschitz constants
/// of all leaf pairs, summed over all pairs of bodies. From one pose of the tool to another
///
///     |change of the force|  <= (force before + force after) · motion
///     |change of the torque| <= (torque before + torque after) · motion
///     motion = |displacement of the tool's origin| + lever · |angle in radians| + rounding
///
/// with the greater lever and rounding of the two poses. docs/guarantees.md, Rates of the contact
/// sums, derives them.
struct SpringRates {
  double force = 0,  ///< N of a contact with a stiffness of 1 N/m, per metre: no unit
      torque = 0,    ///< N m of such a contact, per metre: m
      lever = 0,     ///< no point that counts is farther from the tool's origin, m
      rounding = 0;  ///< of the kernels, as a motion, m
};

/// All contacts of the tool at one pose, pair by pair of bodies.
class ToolContacts {
 public:
  /// The most points of a pair.
  static constexpr std::size_t kMost = 32;

  /// Reserves room for the points of `pairs` pairs.
  explicit ToolContacts(std::size_t pairs = 1) {
    points_.reserve(pairs * kMost);
    pairs_.reserve(pairs);
  }

  /// The sum over all leaf pairs, none merged, of stiffness_fraction · depth · normal, and its
  /// torque: the wrench of a contact with a stiffness of 1 N/m.
  Vector6 spring = Vector6::Zero();
  /// How fast that can change.
  SpringRates rates;
  /// The number of leaf pairs, by weight.
  double count = 0;

  /// The points, in the order of add().
  [[nodiscard]] std::span<const ToolContact> points() const noexcept { return points_; }
  /// The points of a pair.
  [[nodiscard]] std::span<const ToolContact> points(const ContactPair& pair) const noexcept {
    return points().subspan(pair.begin, pair.end - pair.begin);
  }
  /// The pairs of this tick, with points or without, by ascending number.
  [[nodiscard]] std::span<ContactPair> pairs() noexcept { return pairs_; }
  /// The same, to read.
  [[nodiscard]] std::span<const ContactPair> pairs() const noexcept { return pairs_; }
  /// Leaves no contact.
  void clear() noexcept {
    spring.setZero();
    rates = {};
    count = 0;
    points_.clear();
    pairs_.clear();
  }
  /// Begins a pair. Allocates nothing up to the number of pairs that room was reserved for.
  void begin_pair(std::size_t number) noexcept {
    pairs_.push_back({number, points_.size(), points_.size()});
  }
  /// Adds a point to the last pair; the first one begins pair 0. Returns false, and adds none, if
  /// the pair has kMost points.
  bool add(const ToolContact& point) noexcept {
    if (pairs_.empty()) begin_pair(0);
    ContactPair& pair = pairs_.back();
    if (pair.end - pair.begin == kMost) return false;
    points_.push_back(point);
    ++pair.end;
    return true;
  }

 private:
  std::vector<ToolContact> points_;
  std::vector<ContactPair> pairs_;
};

/// The inputs of an effect. The union over all effects of a scene decides which trees are built and
/// which queries a tick makes.
struct EffectNeeds {
  bool normals = false;    ///< of contacts
  bool depth = false;      ///< of contacts
  bool velocity = false;   ///< of the tool, within a tick
  bool proximity = false;  ///< proximity voxels of the fixed bodies
  bool triangles = false;  ///< kept in the trees

  /// Whether the bodies must be voxelised and searched.
  [[nodiscard]] bool contacts() const noexcept { return normals || depth || triangles; }
  /// Joins the needs of another effect.
  EffectNeeds& operator|=(const EffectNeeds& other) noexcept {
    normals |= other.normals;
    depth |= other.depth;
    velocity |= other.velocity;
    proximity |= other.proximity;
    triangles |= other.triangles;
    return *this;
  }
};

/// The input of effects at a tick, before the tool moves: SI, scene axes.
struct EffectInput {
  const Placement& tool;         ///< the pose of the contacts
  const ToolContacts& contacts;  ///< empty if no effect needs contacts
  /// Points near the fixed bodies, without a depth; empty if no effect needs proximity.
  const ToolContacts& proximity;
  double dt;  ///< the nominal length of the tick, s
};

/// The sum of all effects on the tool after a motion from EffectInput::tool.
struct IST_API Response {
  Vector6 wrench = Vector6::Zero();  ///< about the tool's origin
  /// -d wrench / d motion, or a symmetric, positive semidefinite matrix near it.
  Matrix6 stiffness = Matrix6::Zero();

  /// Adds a force at a point, N, and -d force / d point, N/m.
  void add(const Eigen::Vector3d& arm, const Eigen::Vector3d& force,
           const Eigen::Matrix3d& change) noexcept;
};

/// A force on the tool. Each tick solves for the tool's motion by a few Newton steps, which call
/// respond() for the motion so far; advance() is called once for the final motion. Effects of a
/// caller's own are added by build_scene(). No function but the destructor may allocate, lock or
/// throw. The effects of the library are deterministic: they use + - * / and square roots only.
class IST_API Effect {
 public:
  virtual ~Effect() = default;
  /// The effect's table in a scene. The text must live as long as the effect.
  [[nodiscard]] virtual std::string_view name() const noexcept = 0;
  /// The inputs that respond() reads, the same in every call.
  [[nodiscard]] virtual EffectNeeds needs() const noexcept = 0;

  /// Adds the effect's wrench and stiffness after `motion`.
  virtual void respond(const EffectInput& input, const Vector6& motion,
                       Response& response) const noexcept = 0;
  /// Moves the state of an effect that has one: the tool has moved by `motion`.
  virtual void advance(const EffectInput&, const Vector6& /*motion*/) noexcept {}
  /// Forgets all earlier ticks.
  virtual void reset() noexcept {}
};

/// `contact`: the tool never intersects a fixed body. Lengths are in the scene's unit. A length of
/// 0 means its default, a fraction of the diagonal of the largest body's box.
struct ContactSettings {
  double skin = 0;   ///< gap that a contact keeps; by default 1/32,000 of the diagonal
  double trust = 0;  ///< longest way of the held surface in a step near a fixed body; by default
                     ///< 1/8,000 of the diagonal
  int steps = 3;     ///< of a tick, at most; 1 to 10
};

/// `friction`: surfaces in contact stick, then slide. It is a part of `contact`.
struct FrictionSettings {
  double coefficient = 0.3;  ///< a contact slides at this ratio of tangential to normal force
};

/// `springs`: springs at pairs of voxels push the surfaces apart. They give way under load. Beyond
/// breaking_force() the tool passes through.
struct SpringsSettings {
  double stiffness = 40000;  ///< of a whole contact, N/m, whatever the voxel size
  double margin = 0;         ///< springs begin at this distance, m; at most half a voxel
  /// A contact of this area or more has its whole stiffness, m². A smaller contact has a part of
  /// the stiffness in proportion to its area. 0 means (d / 260)², with the diagonal d of the tool's
  /// box: 0.4 mm² for a human jaw.
  double full_area = 0;
  bool allow_breaking = false;  ///< a wall may break at less force than the coupling exerts
};

/// Returns the greatest force that the wall of `springs` bears, N: stiffness * half a voxel, since
/// pairs of voxels are about half a voxel deep in the mean before the tool passes through.
/// Measured: a ball passes at 0.86 to 0.95 of it, the flat face of a block at 1.2 to 1.6.
/// @param voxel_size the mean of the two bodies' voxel sizes, m
[[nodiscard]] constexpr double breaking_force(const SpringsSettings& settings,
                                              double voxel_size) noexcept {
  return settings.stiffness * 0.5 * voxel_size;
}

/// `damping`: surfaces in contact lose energy as they approach.
struct DampingSettings {
  double damping = 10;  ///< of a whole contact, N s/m
};

/// `proximity`: the tool is slowed before the surfaces meet.
struct ProximitySettings {
  double distance = 0;  ///< from the fixed surface, m: two proximity voxels
  double damping = 2;   ///< of one whole leaf pair, N s/m; all pairs have at most 10 times as much
};

/// `gravity`: the weight of the held body.
struct GravitySettings {
  double mass = 0;                                   ///< kg
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of mass, in the tool's frame, m
  Eigen::Vector3d acceleration = {0, 0, -9.81};      ///< m/s², scene axes
};

/// `snap`: the tool is drawn to a stored pose.
struct SnapSettings {
  Placement pose = {};             ///< of the tool
  double stiffness = 200;          ///< N/m
  double angular_stiffness = 0.2;  ///< N m/rad
  double radius = 0;               ///< of attraction, m
  double angle = 0.2;              ///< of attraction: 2 tan(turn/2), as in motion_between
};

}  // namespace ist
