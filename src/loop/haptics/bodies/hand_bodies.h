#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "ist/haptics/placement.h"
#include "loop/haptics/bodies/tool_contact_query.h"
#include "loop/haptics/devices/plan.h"

namespace ist {

/// A body of a simulation at its place in the scene.
struct BodyPart {
  std::string name;
  Placement place;          ///< from the mesh, in metres, to the scene
  Eigen::Vector3d centre;   ///< a point in the middle of the body, mesh units
  double radius;            ///< bound on the distance of its surface from there, m
  bool held = false;        ///< in the hand at the start
  bool attachable = false;  ///< the hand may take it and release it
  /// Where a fixed body is at which time; empty: it rests at its place.
  std::optional<Plan> script = std::nullopt;
};

/// The bodies of a simulation: which of them the hand holds, and where each is. Held bodies move as
/// one with the tool. Its frame is that of the first held body: the mesh's axes, and its centre.
class HandBodies {
 public:
  /// Nothing fixed, and a tool that is a point.
  HandBodies() = default;
  /// @param unit metres in a mesh unit
  /// @param home the tool's pose at which the held parts are at their places
  HandBodies(double unit, const Placement& home, std::vector<BodyPart> parts);

  [[nodiscard]] std::size_t size() const noexcept { return bodies_.size(); }
  /// Metres in a mesh unit.
  [[nodiscard]] double unit() const noexcept { return unit_; }
  [[nodiscard]] const std::string& name(std::size_t body) const noexcept {
    return bodies_[body].name;
  }
  [[nodiscard]] bool is_held(std::size_t body) const noexcept { return bodies_[body].held; }
  [[nodiscard]] bool is_attachable(std::size_t body) const noexcept {
    return bodies_[body].attachable;
  }
  /// Whether the one body is fixed and the other held, so that they may push each other.
  [[nodiscard]] bool may_touch(std::size_t fixed, std::size_t held) const noexcept {
    return !bodies_[fixed].held && bodies_[held].held;
  }
  /// The frames of a fixed and a held body.
  [[nodiscard]] BodyFrames frames(std::size_t fixed, std::size_t held) const noexcept {
    return {unit_, bodies_[fixed].place, bodies_[held].origin, bodies_[held].turn};
  }
  /// Maps a body's mesh, in metres, to the scene.
  [[nodiscard]] Placement place(std::size_t body, const Placement& tool) const noexcept;
  /// The ball round a fixed body, in the scene, m.
  struct Ball {
    Eigen::Vector3d centre;
    double radius;
  };
  [[nodiscard]] Ball ball(std::size_t fixed) const noexcept;
  /// The least distance that the surfaces of two bodies can have by their balls, m; negative where
  /// the balls overlap.
  [[nodiscard]] double gap(std::size_t fixed, std::size_t held,
                           const Placement& tool) const noexcept;
  /// Bounds the distance of every held surface from the tool's origin, m.
  [[nodiscard]] double held_radius() const noexcept;

  /// Puts a fixed body into the hand, where it is.
  void attach(std::size_t body, const Placement& tool) noexcept;
  /// Leaves a held body where it is, as a fixed one.
  void release(std::size_t body, const Placement& tool) noexcept;
  /// Takes the last attach() or release() of the body back.
  void undo(std::size_t body) noexcept { bodies_[body].held = !bodies_[body].held; }

  [[nodiscard]] bool has_scripts() const noexcept { return has_scripts_; }
  /// Puts bodies with a script where they are at `time`, and looks ahead to `time` + `step`, s.
  void set_time(double time, double step) noexcept;
  /// The motion of a fixed body during that step, about the tool's origin.
  [[nodiscard]] Vector6 drift(std::size_t fixed, const Placement& tool) const noexcept;

 private:
  struct Body {
    std::string name;
    Placement place,  // of a fixed body; of a held one its last place as a fixed one
        next;         // after the step
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  // of a held body: from mesh to tool axes
    Eigen::Vector3d origin;  // of a held body: the tool's origin in mesh coordinates, mesh units
    Eigen::Vector3d centre;
    double radius;
    bool held, attachable;
    std::optional<Plan> script;
  };

  void take(Body& body, const Placement& tool) const noexcept;
  [[nodiscard]] Eigen::Vector3d arm(const Body& held) const noexcept;

  double unit_ = 1;
  std::vector<Body> bodies_;
  bool has_scripts_ = false;
};

}  // namespace ist
