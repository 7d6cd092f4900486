#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "models/jaw/jaw_tooth.h"

namespace ist {

/// A point of the dental arch and its outward normal.
struct ArchFrame {
  Eigen::Vector2d point;    ///< x, y; mm
  Eigen::Vector2d outward;  ///< unit normal, towards the cheek
};

/// The dental arch, a curve in the occlusal plane along which both jaws lie: a horseshoe from
/// between the first incisors back to the condyle. Only the side x >= 0 is stored; the other is its
/// mirror image.
class Arch {
 public:
  Arch();
  /// Returns the frame at `distance` along the curve from the midline, mm; clamped to the curve's
  /// length, just over 100.
  [[nodiscard]] ArchFrame at(double distance) const;

 private:
  std::vector<double> lengths_;  // arc lengths at equal steps of the parameter
};

/// The height of the occlusal plane, where the two rows of teeth meet; mm.
inline constexpr double kOcclusalPlane = 48;

/// The spacing of a profile's control values along the arch; mm.
inline constexpr double kProfileStep = 7;

/// The position of a cross-section on one side of a jaw.
struct Station {
  double distance;    ///< along the arch, from the midline
  std::size_t tooth;  ///< index in the row; the last tooth behind the row
  double place;       ///< across that tooth, -1 to 1
  double behind;      ///< 0 along the row, then up to 1 at the jaw's end
};

/// The parameters of one side of a jaw.
struct JawSide {
  double mirror;            ///< +1 for x >= 0, -1 for the other side
  std::uint64_t bone_seed;  ///< shared by both sides, which meet in the middle
  std::vector<Tooth> row;
};

/// Returns the stations of one side: the midline, the stations of each tooth, denser towards the
/// next tooth, then `behind` stations up to `length`, denser towards the end.
std::vector<Station> lay_out_stations(std::span<const Tooth> row, std::size_t behind,
                                      double length);

/// Returns the spline controls of the cross-section at a station. The section begins with the crown
/// in the lower jaw, with the middle of the palate in the upper one.
std::vector<Eigen::Vector3d> lower_section(const Arch& arch, const JawSide& side,
                                           const Station& station);
std::vector<Eigen::Vector3d> upper_section(const Arch& arch, const JawSide& side,
                                           const Station& station);

/// Returns the bone's small unevenness along the arch, in [-1, 1]; each `line` has its own.
///
/// @param distance from the midline, negative on the other side; mm, within 120
double unevenness(std::uint64_t bone_seed, std::size_t line, double distance);

}  // namespace ist
