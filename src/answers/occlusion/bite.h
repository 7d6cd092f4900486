#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "answers/examiner.h"
#include "answers/occlusion/labels/tooth_labels.h"
#include "answers/occlusion/sides.h"
#include "ist/measure/occlusion.h"
#include "ist/mesh/mesh.h"

namespace ist::answers {

/// Limits of distance for the report of an occlusion, from a publication or a product. They are no
/// clinical recommendation.
struct Preset {
  std::string_view name;
  std::span<const double> micrometres;  ///< the limits, increasing; 0 is touch
  std::string_view source;              ///< the publication, and the kind of bites in it
};

/// Returns all presets, the default first.
[[nodiscard]] std::span<const Preset> presets();

/// A contact of two bodies. All outputs use the same number for it.
///
/// Regions that face each other, directly or through others, are one contact: so a region that
/// faces two regions of the other body makes one contact with both. A region that faces none, and
/// that none faces, is a contact on one body alone.
struct BiteContact {
  std::vector<std::uint32_t> fixed, moving;  ///< its regions, by their indices
  /// The mean of both bodies; of the one body if the contact is on one alone.
  double area = 0, penetrating_area = 0, depth_integral = 0;
  /// Likewise, 0 to 1. The shares of a body's regions add up to 1. So the shares of all contacts
  /// add up to 1 if all are on both bodies, and to more with contacts on one body alone.
  double share = 0, share_thinner = 0, share_thicker = 0;
  double least_distance = 0;                          ///< signed, of all its regions
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();   ///< of the area of all its regions
  Eigen::Vector3d closest = Eigen::Vector3d::Zero();  ///< the point of the least distance
  int fixed_tooth = 0,   ///< of its largest region on the fixed body (region_teeth_of()); 0: none
      moving_tooth = 0;  ///< and on the moving body

  [[nodiscard]] bool on_both() const { return !fixed.empty() && !moving.empty(); }
};

/// Returns the contacts in the order of their numbers, which begin at 1: those on both bodies, the
/// largest area first, then those on one body alone, the largest first.
[[nodiscard]] std::vector<BiteContact> contacts_of(std::span<const ContactRegion> fixed,
                                                   std::span<const ContactRegion> moving);

/// The part of one tooth in an occlusion.
struct Tooth {
  int number = 0;
  double area = 0;  ///< in contact, mesh units²
  double share = 0, share_thinner = 0,
         share_thicker = 0;  ///< of all regions of the surface, 0 to 1
  /// The least signed distance of its vertices, mesh units. In contact the vertices of split
  /// triangles count too. NaN beyond the reach.
  double least_distance = 0;
};

/// Returns the labelled teeth of a surface, ordered by their numbers. Precondition: a label for
/// each triangle.
[[nodiscard]] std::vector<Tooth> teeth_of(const SurfaceOcclusion& surface, const TriangleMesh& mesh,
                                          const ToothLabels& labels);

/// Returns for each region of a surface the tooth that holds the most of its area: the lowest
/// number of equal ones. 0 if that is no tooth. Precondition: a label for each triangle.
[[nodiscard]] std::vector<int> region_teeth_of(const SurfaceOcclusion& surface,
                                               const ToothLabels& labels);

/// One body of a bite.
struct BiteBody {
  std::string name;                 ///< the file's base name; "fixed" or "moving" with --no-names
  std::optional<std::string> hash;  ///< of the file: XXH3 of 64 bits, as 16 digits
  const TriangleMesh* mesh = nullptr;
  Eigen::Isometry3d to_fixed = Eigen::Isometry3d::Identity();
  bool closed = false;  ///< closed and wound consistently: depth is certain
  SurfaceOcclusion surface;
  std::vector<double> areas;          ///< for each limit of the preset, mesh units²
  std::optional<Balance> sides;       ///< by `Bite::sides`; empty without contacts
  std::optional<Balance> fore_aft;    ///< by `Bite::fore_aft`; empty without contacts
  std::vector<std::size_t> contacts;  ///< of each region, the number of its contact, from 1
  std::size_t on_both = 0;            ///< contacts with numbers up to this are on both bodies
  std::vector<Tooth> teeth;           ///< with labels
  std::vector<int> region_teeth;      ///< with labels: region_teeth_of()

  /// Returns the box round the body, fixed coordinates.
  [[nodiscard]] Eigen::AlignedBox3d box() const {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& v : mesh->vertices) box.extend(to_fixed * v);
    return box;
  }
  /// Returns the area outside the other body within limit `i` of the preset, mesh units².
  [[nodiscard]] double area_outside(std::size_t i) const {
    return std::max(0.0, areas[i] - surface.penetrating_area);
  }
};

/// The occlusion of two bodies, for all outputs of `ist occlusion`. Lengths are in mesh units, if
/// no name says micrometres.
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

}  // namespace ist::answers
