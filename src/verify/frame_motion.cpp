#include "verify/frame_motion.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

namespace ist {
namespace {

using Number = long double;
using Matrix = Eigen::Matrix<Number, 3, 3>;
using Vector = Eigen::Matrix<Number, 3, 1>;

// The origin of a tree's frame in mesh coordinates: the root cube's centre.
Vector origin_of(const Lattice& lattice) {
  const Number half = std::ldexp(Number{lattice.voxel_size}, lattice.depth - 1);
  return {lattice.corner[0] + half, lattice.corner[1] + half, lattice.corner[2] + half};
}

}  // namespace

Rigidity rigidity_of(const Eigen::Isometry3d& pose) {
  constexpr Number kMostError = 1e-3, kMostScale = 1e-5;
  constexpr Number kRounding = 1e-14;       // of entries in double
  constexpr Number kScaleRounding = 1e-11;  // of minors in double
  const Eigen::Matrix4d& m = pose.matrix();
  if (!m.allFinite() || m.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) return Rigidity::kNone;
  const Matrix rotation = pose.linear().cast<Number>();
  const Number off = (rotation.transpose() * rotation - Matrix::Identity()).cwiseAbs().maxCoeff();
  if (!(off <= kMostError + kRounding) || rotation.determinant() < 0) return Rigidity::kNone;
  const Vector stretches = Eigen::JacobiSVD<Matrix>(rotation).singularValues();  // descending
  const Number scale = std::max(stretches[2] - 1, 1 - stretches[0]);
  if (scale > kMostScale + kScaleRounding) return Rigidity::kNone;
  const bool is_rigid = off < kMostError - kRounding && scale < kMostScale - kScaleRounding;
  return is_rigid ? Rigidity::kRigid : Rigidity::kEither;
}

FrameMotion frame_motion(const Eigen::Isometry3d& pose, const Lattice& fixed,
                         const Lattice& moving) {
  const Eigen::JacobiSVD<Matrix> parts(pose.linear().cast<Number>(),
                                       Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix rotation = parts.matrixU() * parts.matrixV().transpose();
  const Vector from = origin_of(moving), to = origin_of(fixed),
               by = pose.translation().cast<Number>();
  const Vector translation = (by - to) + rotation * from;
  constexpr Number kLargest = std::numeric_limits<double>::max();
  FrameMotion found{Eigen::Isometry3d::Identity(), 0};
  found.motion.linear() = rotation.cast<double>();
  for (Eigen::Index i = 0; i < 3; ++i) {
    found.motion.translation()[i] =
        static_cast<double>(std::clamp(translation[i], -kLargest, kLargest));
  }
  // A query's rotation, in double, is off the nearest one by less than 2⁻⁴⁸, which moves the moving
  // frame's origin. The sums here round numbers that are no greater than these lengths.
  found.error =
      static_cast<double>(0x1p-48L * from.norm() + 8 * std::numeric_limits<Number>::epsilon() *
                                                       (from.norm() + to.norm() + by.norm()));
  return found;
}

}  // namespace ist
