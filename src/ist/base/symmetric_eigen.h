#pragma once

#include <Eigen/Core>

namespace ist {

/// The eigenvalues of a symmetric matrix, ascending, and a unit eigenvector for each: the columns
/// of an orthogonal matrix.
struct SymmetricEigen {
  Eigen::Vector3d values;
  Eigen::Matrix3d vectors;
};

/// Returns the eigenvalues and eigenvectors of a finite matrix, of which the upper triangle is
/// read. Right to a few roundings of the largest eigenvalue. Deterministic; + - × ÷ √ only. Cost:
/// 0.3 µs.
///
/// Source: C. G. J. Jacobi, Über ein leichtes Verfahren, die in der Theorie der Säcularstörungen
/// vorkommenden Gleichungen numerisch aufzulösen, Crelle's Journal 30, 1846.
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::Matrix3d& matrix) noexcept;

}  // namespace ist
