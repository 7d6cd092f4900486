#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/formats/poly_data.h"
#include "cli/occlusion/bite.h"

namespace ist::cli {

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

}  // namespace ist::cli
