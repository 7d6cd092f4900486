#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "ist/base/api.h"
#include "ist/haptics/placement.h"
#include "ist/query/results.h"

namespace ist {

namespace detail {
struct Access;
struct SimulationParts;
struct SimulationState;
}  // namespace detail

/// The spring and damper between the device and the tool.
struct CouplingSettings {
  double stiffness = 1000;        ///< K, N/m
  double damping = 0.5;           ///< B, N s/m
  double angular_stiffness = 1;   ///< N m/rad
  double angular_damping = 5e-4;  ///< N m s/rad
  double max_force = 5;           ///< of the spring, N
  double max_torque = 0.2;        ///< N m
};

/// The limits of the wrench on the hand. Always on.
struct SafetySettings {
  double max_force = 8;     ///< N
  double max_torque = 0.3;  ///< N m
  double force_slew = 500;  ///< N/s
  double torque_slew = 20;  ///< N m/s
  double soft_start = 0.5;  ///< ramp from no force to full force, at the start and after a fault, s
};

/// The budgets of a tick's queries, which run one after the other.
struct TickBudget {
  Budget contacts = {},  ///< of the contacts
      proximity = {},    ///< of the proximity points
      change = {};       ///< of the contacts of the bodies as a change leaves them
  /// The most steps of the tool; by default those of the scene. No effect with `springs`.
  int steps = std::numeric_limits<int>::max();
};

/// Whether a body was attached or released, or why not.
enum class ChangeStatus : std::uint8_t {
  kDone,
  kUnknownBody,   ///< there is no body of that number
  kFixedForGood,  ///< the body is not `attachable`, or it follows a script
  kAlreadyThere,  ///< a held body was to be attached, or a fixed one released
  kTouching,      ///< something touches the body, or a body that the hand holds
  kUnfinished,    ///< the budget ended a query before the answer was known
};
/// Returns the status' name, such as "touching".
[[nodiscard]] IST_API const char* to_string(ChangeStatus status) noexcept;

/// An attach or a release that a tick tried.
struct HandChange {
  double time;          ///< that it was planned for, from the first tick on, s
  std::size_t body;     ///< by its number
  bool attach;          ///< false: a release
  ChangeStatus status;  ///< other than kDone: nothing changed
};

/// A contact of the tool with a fixed body. SI, scene axes.
struct ContactPoint {
  Eigen::Vector3d position;  ///< on the fixed body, m
  Eigen::Vector3d normal;    ///< of unit length, from the fixed body to the held one
  Eigen::Vector3d force;     ///< on the tool, N
  double gap;                ///< between the bodies there, m
  TrianglePair triangles;    ///< by their indices in the meshes; `moving` is the held body's
  std::size_t fixed, held;   ///< the bodies, by their numbers
};

/// The result of a tick.
struct Tick {
  Placement device = {};             ///< as read; the last known pose if it could not be read
  Placement tool = {};               ///< after the tick
  Vector6 wrench = Vector6::Zero();  ///< on the hand, about the tool's origin
  bool fault = false;  ///< no device pose, or numbers that are not finite: the wrench is zero
  /// The budget ended the tick, or no motion was free: the tool is at its last free pose. With
  /// `springs`: the contacts were incomplete, and the tool is at its last complete pose.
  bool held = false;
  bool halved = false;  ///< the end of a step was not free, and the step was shortened
  int steps = 0;        ///< that the tool made; 0 with `springs`
  /// The most contacts that push the tool at once.
  static constexpr std::size_t kMostPoints = 6;
  /// The contacts that push the tool; empty with `springs`. Valid until the next tick.
  std::span<const ContactPoint> points = {};
  /// The results of the queries at the tool's pose before the tick, over all pairs of a fixed and a
  /// held body: counts are sums, the distance is the least, and all pairs must be complete. Mesh
  /// units. Empty if no effect needs the query.
  std::optional<QueryResult> contacts = {},  ///< of the contacts
      proximity = {};                        ///< of the proximity points
  double leaf_pairs = 0;  ///< with `springs`: load-bearing leaf pairs, by weight; else 0
  std::optional<HandChange> change = {};  ///< that the scene planned for this tick
};

/// An effect of a simulation and the time spent in it.
struct EffectTime {
  std::string_view name;          ///< as Effect::name() says
  std::chrono::nanoseconds time;  ///< in all ticks so far
};

/// Computes the wrench on the hand from the pose of the hand, tick by tick, without a clock. Equal
/// device poses and equal results of the queries give equal bits. Made by build_scene().
///
/// Each body is fixed or held; held bodies move as one with the tool. Contacts are those of every
/// pair of a fixed and a held body. Their wrenches are summed about the tool's origin. A body is
/// named by its number: the fixed ones of the scene, then the held ones.
///
/// With `contact` a tick moves the tool to the balance of coupling and effects in a few steps, each
/// of which ends free, and returns the coupling's wrench. If the budget ends, the tool stays at its
/// last free pose. docs/guarantees.md, The wall of the hand, has the method.
///
/// With `springs` a tick queries the contacts at the tool's pose, moves the tool to the balance by
/// at most one voxel, and returns the coupling's wrench. If the contacts are incomplete the tool
/// returns to its last complete pose and contacts, and its step limit halves.
///
/// Lack of time never lowers resistance. If the proximity points are incomplete the last complete
/// ones are used. Bodies that follow a script wait while the tool is held, and at a fault.
///
/// A tick allocates nothing, locks nothing and makes no system call. Cost: the queries, and 5 to 15
/// µs. A simulation is used by one thread at a time.
class IST_API Simulation {
 public:
  ~Simulation();
  Simulation(Simulation&&) noexcept;  ///< the other may then only be assigned or destroyed
  Simulation& operator=(Simulation&&) noexcept;  ///< as the constructor

  /// Makes one tick.
  /// @param device the pose of the hand; empty if it is not known, which is a fault
  /// @param budget limits of the tick's queries
  [[nodiscard]] Tick tick(const std::optional<Placement>& device,
                          const TickBudget& budget = {}) noexcept;
  /// Sets the wrench to zero; it returns through the soft start. Effects forget earlier ticks.
  void fault() noexcept;

  /// Takes a fixed body into the hand, where it is. Refused while anything touches it or a body in
  /// the hand. Between ticks; cost: two queries of each pair that is concerned.
  /// @param body   by its number
  /// @param budget limits these queries
  [[nodiscard]] ChangeStatus attach(std::size_t body, const TickBudget& budget = {}) noexcept;
  /// Leaves a held body where it is, as a fixed one, whatever touches it. The hand may be empty
  /// then. Between ticks; cost as of attach().
  /// @param body   by its number
  /// @param budget limits the queries
  [[nodiscard]] ChangeStatus release(std::size_t body, const TickBudget& budget = {}) noexcept;

  /// The changes that the scene planned and ticks have tried so far.
  [[nodiscard]] std::span<const HandChange> changes() const noexcept;

  /// The number of bodies.
  [[nodiscard]] std::size_t bodies() const noexcept;
  /// The name of a body, from 0 on; empty beyond the last.
  [[nodiscard]] std::string_view body_name(std::size_t body) const noexcept;
  /// Whether the hand holds a body.
  [[nodiscard]] bool is_held(std::size_t body) const noexcept;
  /// Maps the mesh of a body, in metres, to the scene, after the last tick. The identity beyond the
  /// last body.
  [[nodiscard]] Placement body_pose(std::size_t body) const noexcept;

  /// The length of a tick, s.
  [[nodiscard]] double dt() const noexcept;
  /// The pose of the tool after the last tick.
  [[nodiscard]] const Placement& tool_pose() const noexcept;
  /// The effects in the order of their calls.
  [[nodiscard]] std::span<const EffectTime> effects() const noexcept;
  /// Bytes reserved by the queries.
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  friend struct detail::Access;
  explicit Simulation(detail::SimulationParts parts);

  std::unique_ptr<detail::SimulationState> state_;
};

}  // namespace ist
