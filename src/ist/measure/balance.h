#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace ist {

/// A vector of the problem below: a wrench in six numbers, and a cost.
using BalanceVector = std::array<double, 7>;

/// A force that helps to balance a load.
struct BalanceForce {
  std::size_t column;
  double force;  ///< above 0
};

/// Finds forces f >= 0 with the least |load + Σ f column|. At most seven of them are above 0. The
/// same bits on every platform. Cost: some 10 rounds of 10 ns a column.
///
/// Source: C. L. Lawson, R. J. Hanson, Solving Least Squares Problems, Prentice-Hall 1974, ch. 23.
[[nodiscard]] std::vector<BalanceForce> balance(std::span<const BalanceVector> columns,
                                                const BalanceVector& load);

}  // namespace ist
