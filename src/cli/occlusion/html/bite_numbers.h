#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "cli/occlusion/bite.h"

namespace ist::cli {

/// How a report writes the numbers of a bite for people.
class BiteNumbers {
 public:
  explicit BiteNumbers(const Bite& bite) : bite_(bite) {}

  /// A length in mesh units, as micrometres without their unit; a dash for NaN.
  [[nodiscard]] std::string micrometres(double units) const {
    if (std::isnan(units)) return "–";
    return fmt::format("{:.1f}", units / bite_.units_per_micrometre());
  }
  /// A length in mesh units, as micrometres, or millimetres from 10 mm up.
  [[nodiscard]] std::string length(double units) const {
    const double in_mm = units / bite_.units_per_mm;
    if (std::abs(in_mm) >= 10) return fmt::format("{:.3f} mm", in_mm);
    return fmt::format("{:.6g} µm", std::round(1e4 * in_mm) / 10);
  }
  [[nodiscard]] std::string interval(const DistanceInterval& of) const {
    return of.lower == of.upper ? length(of.lower) : length(of.lower) + " to " + length(of.upper);
  }
  /// An area in mesh units squared, as mm² without their unit.
  [[nodiscard]] std::string area(double square_units) const {
    return fmt::format("{:.4f}", square_units / (bite_.units_per_mm * bite_.units_per_mm));
  }
  /// Mesh units cubed, as mm³ without their unit.
  [[nodiscard]] std::string volume(double cubic_units) const {
    return fmt::format("{:.5f}", cubic_units / std::pow(bite_.units_per_mm, 3));
  }
  /// In mesh units.
  [[nodiscard]] static std::string place(const Eigen::Vector3d& at) {
    return fmt::format("({:.5g}, {:.5g}, {:.5g})", at.x(), at.y(), at.z());
  }
  /// A share in per cent without their sign, with those of a thinner and a thicker foundation.
  [[nodiscard]] static std::string share(double share, double thinner, double thicker) {
    return fmt::format("{:.2f} ({:.2f}; {:.2f})", share, thinner, thicker);
  }

 private:
  const Bite& bite_;
};

}  // namespace ist::cli
