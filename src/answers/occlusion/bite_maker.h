#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>

#include "answers/bodies.h"
#include "answers/occlusion/bite.h"
#include "answers/occlusion/sides.h"
#include "ist/base/progress.h"

namespace ist::answers {

/// The questions about an occlusion. Lengths are in millimetres, if nothing else is said.
struct BiteQuestions {
  LengthUnit unit = LengthUnit::kUnknown;  ///< of the meshes; kUnknown: the trees', else mm assumed
  const Preset* preset = nullptr;
  double reach = 2;
  double scanner_band = 50;  ///< micrometres
  SideOptions sides;
  std::filesystem::path labels_fixed, labels_moving;
  std::optional<ToothNumbers> numbers;
  std::optional<Eigen::AlignedBox3d> region;  ///< fixed coordinates, mesh units; empty: all counts
  bool no_names = false;
};

/// The names and hashes of the files that bodies were read from.
struct BiteSources {
  MeshSource fixed, moving;
};

/// Measures an occlusion, and tells `progress` of it. `bodies` must outlive the bite. Throws
/// kTrianglesMissing, kInputInvalid for labels, and a Refusal for sides, for a unit that
/// contradicts the trees', and for a region without a triangle of one body.
[[nodiscard]] Bite make_bite(const Bodies& bodies, const BiteSources& sources,
                             const Eigen::Isometry3d& pose, const BiteQuestions& questions,
                             Progress& progress);

}  // namespace ist::answers
