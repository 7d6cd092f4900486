#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "answers/occlusion/bite.h"
#include "cli/occlusion/map_picture.h"
#include "ist/query/query.h"

namespace ist::test {

/// A bite, and the bodies that it refers to.
struct MadeBite {
  SphereTree fixed, moving;
  answers::Bite bite;
};

/// Measures the bite of two bodies as the command does: areas at the limits of the preset, touch,
/// distance and depth, and balances about the planes x = 0 and y = 0, whose sides have the names of
/// axes. A reach of 2, names "fixed.stl" and "moving.stl".
[[nodiscard]] std::unique_ptr<MadeBite> bite_of(
    const TriangleMesh& fixed, const TriangleMesh& moving,
    const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity(),
    std::string_view preset = "scan");

/// The preset of that name.
[[nodiscard]] const answers::Preset& preset_of(std::string_view name);

/// A flat plate about the z axis, of squares of two triangles, normals along z.
[[nodiscard]] TriangleMesh plate(double half, double edge);

/// A sphere of radius 4 over such a plate, whose lowest point is at (x, y, height): the plate is
/// fixed.
[[nodiscard]] std::unique_ptr<MadeBite> sphere_over_plate(const Eigen::Vector3d& lowest,
                                                          std::string_view preset = "scan");

/// Reads a PNG by libpng's decoder. Throws std::runtime_error for other bytes.
[[nodiscard]] cli::Picture decoded(const std::string& png);

/// The pixel at a place, whose y runs down.
[[nodiscard]] answers::Colour pixel_at(const cli::Picture& picture, int x, int y);

}  // namespace ist::test
