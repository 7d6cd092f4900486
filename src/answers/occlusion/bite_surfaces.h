#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "answers/formats/poly_data.h"
#include "answers/occlusion/bite.h"
#include "ist/base/files.h"

namespace ist::answers {

/// How both halves of an opened bite lie to each other, as a viewer sees them.
enum class BookLayout {
  kBeside,  ///< side by side, the front of both up
  kAbove,   ///< the fixed body above, its front up, the moving one below, its front down
};

/// The places of both bodies in an opened bite, and the view of it. Poses and unit vectors, fixed
/// coordinates.
struct OpenedBook {
  Eigen::Isometry3d fixed = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d moving = Eigen::Isometry3d::Identity();
  Eigen::Vector3d viewer = Eigen::Vector3d::UnitX();  ///< towards the eye
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();      ///< from the picture's bottom to its top
};

/// Opens a bite like a book: turns each body by a quarter about one axis, so that the sides that
/// faced each other face one viewer, and lays them apart with `gap` mesh units between. That axis
/// runs from front to back, or from side to side if they lie above each other.
[[nodiscard]] OpenedBook opened(const Bite& bite, double gap,
                                BookLayout layout = BookLayout::kBeside);

/// The bodies of a bite that a file holds.
enum class BiteSide { kBoth, kFixed, kMoving };

/// How the bodies of a file lie, and which of them are there.
struct BiteSelection {
  BiteSide side = BiteSide::kBoth;
  /// Opened like a book, with this gap between both, mesh units; empty: as they bite.
  std::optional<double> open{};
};

/// Returns the surfaces in fixed coordinates and, unless they are opened, their frame, each with
/// the point array "Signed" (float32: the signed distance, mesh units, NaN beyond the reach) and a
/// colour for each point.
[[nodiscard]] std::vector<NamedPolyData> bite_surfaces(const Bite& bite,
                                                       const BiteSelection& selection);

/// Returns the same with the point arrays "Signed", "Triangle" (int32: the nearest triangle of the
/// other body, -1 beyond the reach) and "SignKnown" (uint8), and without colours.
[[nodiscard]] std::vector<NamedPolyData> bite_arrays(const Bite& bite,
                                                     const BiteSelection& selection);

/// Writes the coloured surfaces to a .glb, in metres and with smooth normals. Throws
/// kFileUnwritable.
void write_bite_glb(const Bite& bite, const BiteSelection& selection, OutputFile& file);

}  // namespace ist::answers
