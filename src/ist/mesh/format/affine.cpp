#include "ist/mesh/format/affine.h"

namespace ist {

Eigen::Vector3d moved_by(const Eigen::Affine3d& transform, const Eigen::Vector3d& v) noexcept {
  const Eigen::Matrix4d& m = transform.matrix();
  Eigen::Vector3d at;
  for (Eigen::Index i = 0; i < 3; ++i) {
    at[i] = ((m(i, 0) * v[0] + m(i, 1) * v[1]) + m(i, 2) * v[2]) + m(i, 3);
  }
  return at;
}

Eigen::Affine3d joined(const Eigen::Affine3d& second, const Eigen::Affine3d& first) noexcept {
  const Eigen::Matrix4d &a = second.matrix(), &b = first.matrix();
  Eigen::Affine3d product = Eigen::Affine3d::Identity();
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      const double sum = (a(i, 0) * b(0, j) + a(i, 1) * b(1, j)) + a(i, 2) * b(2, j);
      product.matrix()(i, j) = j < 3 ? sum : sum + a(i, 3);
    }
  }
  return product;
}

}  // namespace ist
