#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ist {

enum class ToothKind { kIncisor, kCanine, kPremolar, kMolar };

/// One kind of tooth at its place in the row; mm.
struct ToothShape {
  ToothKind kind;
  double width;    ///< along the arch
  double depth;    ///< across it
  double height;   ///< of the crown, gum to tip
  double lateral;  ///< middle of the crown, outward of the arch
  double tip;      ///< highest control beyond the occlusal plane
  double edge;     ///< outward shift of the tip against the neck
  int stations;    ///< cross-sections that the tooth gets
};

/// A tooth of one patient: its shape, and how it differs from the next patient's.
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

/// The crown's part of a cross-section as spline controls, from the tongue's neck over the tip to
/// the cheek's neck.
inline constexpr std::size_t kCrownControls = 11;
using CrownSection = std::array<SectionPoint, kCrownControls>;

/// The seven teeth of one side, from the midline backwards. Sizes vary by a few percent with
/// `seed`; the row's length does not.
std::vector<Tooth> grow_row(std::span<const ToothShape> shapes, double row_length,
                            std::uint64_t seed);

/// The crowns at `place` in [-1, 1] across tooth `index` of the row: full in the middle, and at the
/// ends the low saddle that it shares with its neighbour.
CrownSection crown_section(std::span<const Tooth> row, std::size_t index, double place);

}  // namespace ist
