#include "peers/exact_parts.h"

namespace ist::bench {

TriangleCorners moved(const Eigen::Isometry3d& rigid, const TriangleCorners& triangle) noexcept {
  const auto& m = rigid.matrix();
  TriangleCorners at;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d& v = triangle[k];
    for (Eigen::Index i = 0; i < 3; ++i) {
      at[k][i] = ((m(i, 0) * v[0] + m(i, 1) * v[1]) + m(i, 2) * v[2]) + m(i, 3);
    }
  }
  return at;
}

bool meet(const TriangleCorners& a, const TriangleCorners& b) noexcept {
  return triangles_meet(a, b);
}

}  // namespace ist::bench
