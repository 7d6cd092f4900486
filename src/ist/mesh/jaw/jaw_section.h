#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ist/mesh/jaw/jaw_arch.h"
#include "ist/mesh/jaw/jaw_tooth.h"

namespace ist {

/// Height of the occlusal plane, where the two rows of teeth meet; mm.
inline constexpr double kOcclusalPlane = 48;

/// Control values of a profile along the arch stand this far apart; mm.
inline constexpr double kProfileStep = 7;

/// A cross-section's place on one side of a jaw.
struct Station {
  double distance;    ///< along the arch, from the midline
  std::size_t tooth;  ///< in the row; the last one, too, for all that is behind it
  double place;       ///< across that tooth, -1 to 1
  double behind;      ///< 0 along the row, then up to 1 at the jaw's end
};

/// What one side of a jaw is made from.
struct JawSide {
  double mirror;            ///< +1 for x >= 0, -1 for the other side
  std::uint64_t bone_seed;  ///< shared by both sides, which meet in the middle
  std::vector<Tooth> row;
};

/// The midline, then the stations of each tooth, denser where it meets the next, then `behind`
/// stations to `length`, denser towards the end.
std::vector<Station> lay_out_stations(std::span<const Tooth> row, std::size_t behind,
                                      double length);

/// Spline controls of the cross-section at a station; the section begins with the crown of the
/// lower jaw, or the middle of the palate in the upper one.
std::vector<Eigen::Vector3d> lower_section(const Arch& arch, const JawSide& side,
                                           const Station& station);
std::vector<Eigen::Vector3d> upper_section(const Arch& arch, const JawSide& side,
                                           const Station& station);

/// The bone's small unevenness along the arch; in [-1, 1], another one for each `line`.
///
/// @param distance from the midline, negative on the other side; mm, within 120
double unevenness(std::uint64_t bone_seed, std::size_t line, double distance);

}  // namespace ist
