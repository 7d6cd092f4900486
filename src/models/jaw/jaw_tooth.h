#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ist {

enum class ToothKind { kIncisor, kCanine, kPremolar, kMolar };

/// The shape of one tooth of the row; mm.
struct ToothShape {
  ToothKind kind;
  double width;    ///< along the arch
  double depth;    ///< across the arch
  double height;   ///< of the crown, gum to tip
  double lateral;  ///< middle of the crown, outward of the arch
  double tip;      ///< highest control beyond the occlusal plane
  double edge;     ///< outward shift of the tip against the neck
  int stations;    ///< number of cross-sections
};

/// A tooth of one patient: the shape and its individual deviations.
struct Tooth {
  ToothShape shape;
  double begin, end;  ///< distances along the arch; the next tooth begins where this one ends
  double turn;        ///< about its own axis: outward shift from its middle to its far end
  double wear;        ///< 0 for sharp cusps, 1 for flat ones
};

/// A point of a cross-section, relative to the arch and the occlusal plane; mm.
struct SectionPoint {
  double outward;
  double rise;  ///< towards the other jaw
};

/// The crown's spline controls in a cross-section, from the tongue's neck over the tip to the
/// cheek's neck.
inline constexpr std::size_t kCrownControls = 11;
using CrownSection = std::array<SectionPoint, kCrownControls>;

/// Returns the seven teeth of one side, from the midline backwards. Sizes vary by a few percent
/// with `seed`; the row's length does not.
std::vector<Tooth> grow_row(std::span<const ToothShape> shapes, double row_length,
                            std::uint64_t seed);

/// Returns the crown at `place` in [-1, 1] across tooth `index` of the row: full in the middle, and
/// at the ends the low saddle that the tooth shares with its neighbour.
CrownSection crown_section(std::span<const Tooth> row, std::size_t index, double place);

}  // namespace ist
