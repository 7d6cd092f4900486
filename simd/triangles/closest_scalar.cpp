#include "simd/triangles/closest.h"

namespace ist {

void closest_octet_scalar(const TriangleOctet& pairs, const PlainMove& move, OctetDistances& out) {
  for (std::size_t lane = 0; lane < TriangleOctet::kSize; ++lane) {
    ClosestTriangle fixed, moving;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        fixed[k][i] = pairs.fixed[k][i][lane];
        moving[k][i] = pairs.moving[k][i][lane];
      }
      moving[k] = move(moving[k]);
    }
    const ClosestFound found{ClosestSide(fixed), ClosestSide(moving)};
    out.square[lane] = found.square;
    out.parts[lane] = static_cast<double>(found.parts);
  }
}

}  // namespace ist
