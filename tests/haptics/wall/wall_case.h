#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ist/haptics/effects/effect.h"
#include "ist/haptics/simulation.h"
#include "ist/mesh/mesh.h"
#include "ist/query/query.h"
#include "loop/haptics/devices/plan.h"

namespace ist::test {

/// A pose: the turn, then the position in mm.
[[nodiscard]] Placement at_mm(double x, double y, double z,
                              const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity());
/// A turn about an axis, degrees.
[[nodiscard]] Eigen::Matrix3d turn_about(const Eigen::Vector3d& axis, double degrees);

/// A closed box whose sides are cut in `cells` times `cells` squares.
[[nodiscard]] TriangleMesh fine_box(const Eigen::Vector3d& min, const Eigen::Vector3d& max,
                                    int cells);
/// A prism along x, |x| <= `half`. The outline is of (y, z), counterclockwise, and its first point
/// sees all others.
[[nodiscard]] TriangleMesh prism(const std::vector<Eigen::Vector2d>& outline, double half);

/// A plate whose upper side is z = 0, and a cube round the origin with edges of 10 mm.
[[nodiscard]] TriangleMesh wall_plate();
[[nodiscard]] TriangleMesh wall_cube();

/// A fixed body in mm.
struct WallFixed {
  TriangleMesh mesh;
  std::optional<Plan> script = std::nullopt;
};

struct WallCaseOptions {
  double friction = 0;
  double max_force = 5;  ///< of the coupling, N
  int workers = 1;
  std::string target = {};  ///< as QueryOptions
};

/// A simulation with a wall at 1 kHz. The skin is 5 µm, the trust 20 µm, and a tick has three
/// steps. The coupling has 1000 N/m and 1 N m/rad without damping. The tool's pose is the pose of
/// the held mesh.
///
/// Each tick checks the tool by the exact triangles, and the wrench by the coupling.
class WallCase {
 public:
  static constexpr double kSkin = 5e-6, kTrust = 20e-6, kStiffness = 1000;
  static constexpr int kSteps = 3;

  /// Both bodies of a pair are in mm.
  WallCase(std::vector<WallFixed> fixed, const TriangleMesh& held, const Placement& start,
           const WallCaseOptions& options = {}, std::unique_ptr<Effect> effect = nullptr);
  WallCase(const TriangleMesh& fixed, const TriangleMesh& held, const Placement& start,
           const WallCaseOptions& options = {})
      : WallCase(std::vector<WallFixed>{{fixed}}, held, start, options) {}

  /// Makes a tick. Expects that no triangles meet, that the wrench is the coupling's, and that it
  /// changes no more than the wall allows.
  Tick tick(const std::optional<Placement>& device, const TickBudget& budget = {});
  /// Makes ticks at one pose of the device. Returns the last one.
  Tick hold(const Placement& device, int ticks);
  /// Moves the device from its last pose to `to` in a straight line. Returns the last tick.
  Tick go(const Placement& to, int ticks);
  /// Moves the device at a speed of its origin, mm/s.
  Tick go_at(const Placement& to, double speed);

  /// The tool's position, mm.
  [[nodiscard]] Eigen::Vector3d tool() const { return 1e3 * sim_->tool_pose().translation; }
  [[nodiscard]] const Placement& pose() const { return sim_->tool_pose(); }
  /// Where the mesh of a fixed body is, m.
  [[nodiscard]] Placement fixed_pose(std::size_t body) const { return sim_->body_pose(body); }
  /// The least distance of the tool from all fixed bodies, mm, to within 1e-8.
  [[nodiscard]] double gap();
  /// The query that judges the tool against a fixed body, and the tool's pose in it.
  [[nodiscard]] Query& judge(std::size_t body) { return *judges_[body]; }
  [[nodiscard]] Eigen::Isometry3d judged(std::size_t body, const Placement& tool) const;
  /// The ticks that were held or halved.
  [[nodiscard]] int held() const { return held_; }
  [[nodiscard]] int halved() const { return halved_; }
  /// A hash over all bits of the tool's poses.
  [[nodiscard]] std::uint64_t path() const { return path_; }

 private:
  // After a tick with the device and the tool at poses before it.
  void expect_bounds(const Tick& tick, const Placement& device, const Placement& tool);

  WallCaseOptions options_;
  std::vector<std::unique_ptr<Query>> judges_;
  std::optional<Simulation> sim_;
  Placement device_;
  Vector6 wrench_ = Vector6::Zero();
  int held_ = 0, halved_ = 0;
  std::uint64_t path_ = 0xcbf29ce484222325;
  bool is_new_ = false;  // there was a fault: the wrench starts anew
};

/// Expects that the wrench on the hand is the sum of the contacts' forces.
void expect_balance(const Tick& tick);

}  // namespace ist::test
