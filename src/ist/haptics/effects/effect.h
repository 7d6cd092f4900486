#pragma once

#include <string_view>

#include "ist/base/api.h"
#include "ist/haptics/placement.h"
#include "ist/haptics/touch_set.h"

namespace ist {

/// What an effect must know. The union over the effects of a scene decides what is built and asked.
struct EffectNeeds {
  bool normals = false;    ///< of contacts
  bool depth = false;      ///< of contacts
  bool velocity = false;   ///< of the tool, within a tick
  bool proximity = false;  ///< proximity voxels of the fixed body
  bool triangles = false;  ///< kept in the trees

  /// Whether bodies must be voxelised and searched at all.
  [[nodiscard]] bool contacts() const noexcept { return normals || depth || triangles; }
  EffectNeeds& operator|=(const EffectNeeds& other) noexcept {
    normals |= other.normals;
    depth |= other.depth;
    velocity |= other.velocity;
    proximity |= other.proximity;
    triangles |= other.triangles;
    return *this;
  }
};

/// What effects know at a tick, before the tool moves: SI, axes of the scene.
struct EffectInput {
  const Placement& tool;      ///< where the contacts below were found
  const TouchSet& contacts;   ///< empty where no effect needs them
  const TouchSet& proximity;  ///< likewise: places near the fixed body; overlaps mean nothing there
  double dt;                  ///< the tick's nominal length, s
};

/// What all effects together do to the tool for a motion from EffectInput::tool.
struct IST_API Response {
  Vector6 wrench = Vector6::Zero();  ///< about the tool's origin
  /// -d wrench / d motion, or a symmetric, positive semidefinite matrix near it.
  Matrix6 stiffness = Matrix6::Zero();

  /// A force at a place, and how it changes as the place moves: `stiffness` is N/m.
  void add(const Eigen::Vector3d& arm, const Eigen::Vector3d& force,
           const Eigen::Matrix3d& change) noexcept;
};

/// One thing that a hand may feel. Effects are named in a scene; what is not named is not there.
///
/// The tool's motion of a tick is found by a few Newton steps, each of which asks every effect what
/// it does for the motion so far; then each is told the motion that was made. Neither allocates,
/// locks or throws. All are deterministic and use + - * / and square roots only.
class IST_API Effect {
 public:
  virtual ~Effect() = default;
  /// As the scene names it.
  [[nodiscard]] virtual std::string_view name() const noexcept = 0;
  [[nodiscard]] virtual EffectNeeds needs() const noexcept = 0;

  /// Adds what it does after `motion`.
  virtual void respond(const EffectInput& input, const Vector6& motion,
                       Response& response) const noexcept = 0;
  /// The tool goes by `motion`: for effects that remember.
  virtual void advance(const EffectInput&, const Vector6& /*motion*/) noexcept {}
  /// Forgets all ticks before.
  virtual void reset() noexcept {}
};

}  // namespace ist
