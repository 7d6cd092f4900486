#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ist/base/api.h"
#include "ist/base/progress.h"
#include "ist/haptics/devices/device.h"
#include "ist/haptics/simulation.h"
#include "ist/scene/build_note.h"
#include "ist/scene/scene.h"
#include "ist/scene/scene_trees.h"
#include "ist/tree/tree_builder.h"

namespace ist {

/// A scene made ready to run: what its effects need, and nothing else.
struct BuiltScene {
  SceneTrees trees;
  std::unique_ptr<Simulation> simulation;  ///< refers to the trees
  std::unique_ptr<Device> device;
  double step_limit;                  ///< no point of the tool's surface goes farther in a tick, m
  std::vector<BuildNote> notes;       ///< one for each thing, in the order of building
  std::vector<std::string> warnings;  ///< in sentences for people
};

/// Reads or makes the bodies, builds what the effects need, and puts the tool where it is free.
///
/// The tool starts where the device does, at the beginning of its plan; where bodies touch there,
/// or one is inside the other, it is moved along Scene::open until they do not. Nothing of that is
/// asked where no effect needs contacts.
///
/// Throws what reading a mesh or a tree throws, and kInputInvalid, by the scene's file and line and
/// with a remedy, for what only shows now: what a body's file does not have, voxels that are too
/// small, a start that is not free.
/// @param max_memory bytes, for each tree
[[nodiscard]] IST_API BuiltScene build_scene(const Scene& scene, Progress* progress = nullptr,
                                             std::uint64_t max_memory = BuildOptions{}.max_memory);

}  // namespace ist
