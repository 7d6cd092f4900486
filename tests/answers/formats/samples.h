#pragma once

#include <vector>

#include "answers/formats/poly_data.h"

namespace ist::test {

/// Two bodies of triangles as `ist occlusion` has them: colours, normals, and the point arrays
/// "Signed" (float32, some NaN) and "Triangle" (int32, to both ends of its range); a cell array
/// "Area". Coordinates are no floats. The first body's name has to be escaped.
[[nodiscard]] std::vector<answers::NamedPolyData> sample_bodies();

/// A cube of six quads, without arrays.
[[nodiscard]] answers::PolyData sample_quads();

/// Five points with arrays "radius", "normal" (three components), "pair" (two of int32) and "kind"
/// (uint8), which are the cells of a cell array "weight".
[[nodiscard]] answers::PolyData sample_points();

}  // namespace ist::test
