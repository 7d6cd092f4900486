#include "ist/measure/balance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace ist {
namespace {

constexpr std::size_t kSize = std::tuple_size_v<BalanceVector>;
constexpr int kMostRounds = 300;
// A column that gains less, as a part of the load, gains nothing.
constexpr double kLeastPart = 1e-12;
// A column whose part across the others is shorter depends on them.
constexpr double kDependent = 1e-10;

double dot(const BalanceVector& a, const BalanceVector& b) {
  double sum = 0;
  for (std::size_t i = 0; i < kSize; ++i) sum += a[i] * b[i];
  return sum;
}

void add(BalanceVector& to, double by, const BalanceVector& v) {
  for (std::size_t i = 0; i < kSize; ++i) to[i] += by * v[i];
}

// Solves least squares in some columns. Empty if they depend on each other.
std::optional<std::vector<double>> least_squares(std::span<const BalanceVector> columns,
                                                 const std::vector<std::size_t>& chosen,
                                                 const BalanceVector& load) {
  const std::size_t count = chosen.size();
  double r[kSize][kSize] = {}, on[kSize] = {};
  BalanceVector q[kSize], rest = load;
  for (std::size_t k = 0; k < count; ++k) {
    q[k] = columns[chosen[k]];
    const double before = dot(q[k], q[k]);
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t i = 0; i < k; ++i) {
        const double part = dot(q[i], q[k]);
        r[i][k] += part;
        add(q[k], -part, q[i]);
      }
    }
    const double square = dot(q[k], q[k]);
    if (!(square > kDependent * kDependent * before)) return std::nullopt;
    r[k][k] = std::sqrt(square);
    for (double& number : q[k]) number /= r[k][k];
    on[k] = dot(q[k], rest);
    add(rest, -on[k], q[k]);
  }
  std::vector<double> solution(count);
  for (std::size_t k = count; k-- > 0;) {
    double sum = on[k];
    for (std::size_t i = k + 1; i < count; ++i) sum -= r[k][i] * solution[i];
    solution[k] = sum / r[k][k];
  }
  return solution;
}

}  // namespace

std::vector<BalanceForce> balance(std::span<const BalanceVector> columns,
                                  const BalanceVector& load) {
  BalanceVector wanted;
  for (std::size_t i = 0; i < kSize; ++i) wanted[i] = -load[i];
  std::vector<std::size_t> chosen;
  std::vector<double> forces;
  std::vector<bool> is_out(columns.size());  // chosen, or refused as dependent
  const double least = kLeastPart * std::sqrt(dot(load, load));
  for (int round = 0; round < kMostRounds; ++round) {
    BalanceVector rest = wanted;
    for (std::size_t k = 0; k < chosen.size(); ++k) add(rest, -forces[k], columns[chosen[k]]);
    std::size_t best = columns.size();
    double most = least;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (is_out[i]) continue;
      const double gain = dot(columns[i], rest);
      if (gain > most) {
        most = gain;
        best = i;
      }
    }
    if (best == columns.size() || chosen.size() == kSize) break;
    chosen.push_back(best);
    forces.push_back(0);
    is_out[best] = true;
    for (bool is_settled = false; !is_settled;) {
      const auto solution = least_squares(columns, chosen, wanted);
      if (!solution) {  // the last column depends on the others, and stays out
        chosen.pop_back();
        forces.pop_back();
        break;
      }
      // Goes to the solution as far as no force becomes negative.
      double part = 1;
      std::size_t ends = chosen.size();
      for (std::size_t k = 0; k < chosen.size(); ++k) {
        if ((*solution)[k] > 0) continue;
        const double limit = forces[k] > 0 ? forces[k] / (forces[k] - (*solution)[k]) : 0;
        if (limit < part || ends == chosen.size()) {
          part = limit;
          ends = k;
        }
      }
      is_settled = ends == chosen.size();
      for (std::size_t k = 0; k < chosen.size(); ++k) {
        forces[k] = is_settled ? (*solution)[k] : forces[k] + part * ((*solution)[k] - forces[k]);
      }
      if (is_settled) break;
      const std::size_t column = chosen[ends];
      chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(ends));
      forces.erase(forces.begin() + static_cast<std::ptrdiff_t>(ends));
      // Refused columns may serve again. The new one would come back at once.
      std::fill(is_out.begin(), is_out.end(), false);
      for (const std::size_t k : chosen) is_out[k] = true;
      is_out[best] = is_out[best] || column == best;
      if (chosen.empty()) break;
    }
  }
  std::vector<BalanceForce> result;
  for (std::size_t k = 0; k < chosen.size(); ++k) result.push_back({chosen[k], forces[k]});
  return result;
}

}  // namespace ist
