#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "cli/answers/examiner.h"
#include "cli/occlusion/balance.h"
#include "cli/occlusion/bite_contacts.h"
#include "cli/occlusion/preset.h"
#include "cli/occlusion/teeth.h"
#include "ist/measure/occlusion.h"
#include "ist/mesh/mesh.h"

namespace ist::cli {

/// One body of a bite.
struct BiteBody {
  std::string name;                 ///< the file's base name; "fixed" or "moving" with --no-names
  std::optional<std::string> hash;  ///< of the file: XXH3 of 64 bits, as 16 digits
  const TriangleMesh* mesh = nullptr;
  Eigen::Isometry3d to_fixed = Eigen::Isometry3d::Identity();
  bool closed = false;  ///< closed and wound consistently: depth is certain
  SurfaceOcclusion surface;
  std::vector<double> areas;          ///< of each limit of the preset: where d is at most that
  std::optional<Balance> sides;       ///< by `Bite::sides`; empty where nothing touches
  std::optional<Balance> fore_aft;    ///< by `Bite::fore_aft`; empty where nothing touches
  std::vector<std::size_t> contacts;  ///< of each region, the number of its contact, from 1
  std::size_t on_both = 0;            ///< contacts with numbers up to this are on both bodies
  std::vector<Tooth> teeth;           ///< with labels

  /// Returns the box round the body, fixed coordinates.
  [[nodiscard]] Eigen::AlignedBox3d box() const {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& v : mesh->vertices) box.extend(to_fixed * v);
    return box;
  }
  /// Returns the area that lies outside the other body, and no farther than limit `i` of the
  /// preset.
  [[nodiscard]] double area_outside(std::size_t i) const {
    return std::max(0.0, areas[i] - surface.penetrating_area);
  }
};

/// The occlusion of two bodies, as all outputs of `ist occlusion` tell it. Lengths are in mesh
/// units, unless a name says micrometres.
struct Bite {
  BiteBody fixed, moving;
  std::string made_by;  ///< the program's name, version and commit
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  std::string unit;  ///< "mm", "m", "inch" or "µm"
  bool unit_assumed = false;
  double units_per_mm = 1;
  PatientFrame frame = PatientFrame::kUnknown;  ///< that the files name
  double reach = 2;
  const Preset* preset = nullptr;
  double scanner_band = 50;  ///< ± micrometres that scanning is assumed to err by
  double contact = 0.1, foundation = 0.1, change = 0.05;
  Findings findings;  ///< touch, distance, depth
  Division sides, fore_aft;
  std::optional<ToothNumbers> numbers;
  std::vector<BiteContact> contacts;  ///< by their numbers: the first has the number 1
  /// Only triangles with their centroid in this box count; fixed coordinates.
  std::optional<Eigen::AlignedBox3d> region;
  std::optional<std::string> warning;  ///< why the numbers mean nothing
  std::optional<std::string> hint;     ///< contacts that may not belong to the arch
  std::vector<std::string> checks;     ///< sentences for people: overlap, unit, sides, open bodies

  /// Returns the unit as outputs tell it: "mm", or "mm (assumed)".
  [[nodiscard]] std::string unit_words() const { return unit_assumed ? unit + " (assumed)" : unit; }
  [[nodiscard]] double units_per_micrometre() const { return 1e-3 * units_per_mm; }
  /// Returns the depth of the deepest vertex if it is known, mesh units. 0 is not known of open
  /// surfaces that may meet: none of their vertices lies behind the other surface.
  [[nodiscard]] std::optional<double> known_depth(double at_vertices) const {
    const bool known = findings.depth.certain || at_vertices > 0 || findings.touch == Answer::kNo;
    return known ? std::optional(at_vertices) : std::nullopt;
  }
  /// Fills in `contacts` of the bite and of both bodies, from their regions.
  void number_contacts();
};

/// The text that stands in every report and help of an occlusion.
inline constexpr const char* kCaveat =
    "Research software, not a medical device, not for diagnosis or treatment decisions. These are "
    "distances between the two meshes as given, in the pose given. They hold none of the errors of "
    "scanning, segmentation or registration; ± 50 µm is an assumption, not a measurement of these "
    "scans. Geometric shares are not forces. Published agreement of such maps with marks in the "
    "mouth is low (κ 0.07–0.29).";

}  // namespace ist::cli
