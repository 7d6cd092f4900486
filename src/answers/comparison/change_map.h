#pragma once

#include <vector>

#include "answers/formats/poly_data.h"
#include "answers/occlusion/bite.h"
#include "answers/occlusion/map_scale.h"

namespace ist::answers {

/// The map of a change: of each vertex the signed distance after less before, mesh units. NaN if
/// either is not known.
struct ChangeMap {
  std::vector<double> fixed, moving;

  /// Returns the largest change either way; 0 if none is known.
  [[nodiscard]] double most() const;
};

/// Returns the map of the change between two bites of the same bodies.
[[nodiscard]] ChangeMap change_map(const Bite& before, const Bite& after);

/// Returns both surfaces at the second pose, with the point arrays "Before", "After" and "Change"
/// (float32, mesh units, NaN if it is not known).
[[nodiscard]] std::vector<NamedPolyData> change_arrays(const Bite& before, const Bite& after,
                                                       const ChangeMap& map);

/// Returns both surfaces at the second pose, with the point array "Change" and a colour for each
/// point.
[[nodiscard]] std::vector<NamedPolyData> change_surfaces(const Bite& after, const ChangeMap& map,
                                                         const MapScale& scale);

}  // namespace ist::answers
