#include "ist/voxel/triangle_box.h"

#include <algorithm>
#include <cmath>

#include "ist/base/compensated.h"

namespace ist {
namespace {

// Returns a·d - b·c, right to the last bit but one; a plain difference would lose a sliver's
// normal.
double determinant(double a, double b, double c, double d) noexcept {
  CompensatedSum sum;
  sum.add_product(a, d);
  sum.add_product(-b, c);
  return sum.value();
}

}  // namespace

TriangleBox::TriangleBox(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                         const Eigen::Vector3d& c) noexcept
    : origin_(a) {
  for (int i = 0; i < 3; ++i) {
    min_[i] = std::min({a[i], b[i], c[i]});
    max_[i] = std::max({a[i], b[i], c[i]});
  }
  const Eigen::Vector3d corners[3] = {Eigen::Vector3d::Zero(), b - a, c - a};
  const Eigen::Vector3d sides[3] = {b - a, c - b, a - c};
  const Eigen::Vector3d &s = sides[0], &t = corners[2];
  normal_ = {determinant(s[1], s[2], t[1], t[2]), determinant(s[2], s[0], t[2], t[0]),
             determinant(s[0], s[1], t[0], t[1])};
  normal_reach_ = (std::abs(normal_[0]) + std::abs(normal_[1])) + std::abs(normal_[2]);
  for (int edge = 0; edge < 3; ++edge) {
    const Eigen::Vector3d& side = sides[edge];
    const auto axis = [&](int i, int j) {  // in the plane of coordinates i and j
      Axis result{-side[j], side[i], 0, 0, std::abs(side[i]) + std::abs(side[j])};
      double projections[3];
      for (int k = 0; k < 3; ++k) {
        projections[k] = result.u * corners[k][i] + result.v * corners[k][j];
      }
      result.low = std::min({projections[0], projections[1], projections[2]});
      result.high = std::max({projections[0], projections[1], projections[2]});
      return result;
    };
    edges_[edge] = {axis(1, 2), axis(2, 0), axis(0, 1)};
  }
}

}  // namespace ist
