#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "answers/occlusion/bite.h"

namespace ist::answers {

/// Says how shares of contacts are read, if some are on one body alone. A sentence without a stop.
inline constexpr const char* kSharesOnOneBody =
    "on each body the shares add up to 100 %; a contact on both bodies has the mean of its two "
    "shares, a contact on one body alone has the share on that body, so all together can exceed "
    "100 %";

/// How a report and a terminal write the numbers of a bite. Scans err by some 50 µm, so no digit
/// says less than 1 µm, 0.01 mm², 0.001 mm³ or 0.1 %.
class BiteNumbers {
 public:
  explicit BiteNumbers(const Bite& bite) : BiteNumbers(bite.units_per_mm) {}
  explicit BiteNumbers(double units_per_mm) : units_per_mm_(units_per_mm) {}

  /// A length in mesh units, as micrometres without their unit; a dash for NaN.
  [[nodiscard]] std::string micrometres(double units) const {
    return std::isnan(units) ? "–" : whole(std::round(units / units_per_micrometre()));
  }
  /// A length in mesh units, as micrometres, or millimetres from 10 mm up.
  [[nodiscard]] std::string length(double units) const {
    return in_words(units / units_per_micrometre(), [](double x) { return std::round(x); });
  }
  /// Rounded outwards.
  [[nodiscard]] std::string interval(const DistanceInterval& of) const {
    if (of.lower == of.upper) return length(of.lower);
    const double unit = units_per_micrometre();
    return in_words(of.lower / unit, [](double x) { return std::floor(x); }) + " to " +
           in_words(of.upper / unit, [](double x) { return std::ceil(x); });
  }
  /// A length in mesh units, as millimetres: four digits at most, none finer than 0.001 mm.
  [[nodiscard]] std::string millimetres(double units) const {
    return in_millimetres(units / units_per_mm_);
  }
  /// An interval as millimetres: one number if both ends read alike, else rounded outwards.
  [[nodiscard]] std::string millimetres(const DistanceInterval& of) const {
    const double lower = of.lower / units_per_mm_, upper = of.upper / units_per_mm_;
    if (lower <= 0 && upper > 0 && upper < 1e-3) {
      return upper < 1e-4 ? "less than 0.0001 mm" : "less than 0.001 mm";
    }
    constexpr double kRounding = 1e-9;  // of a quotient that is a whole number
    const double digit = digit_of(upper);
    const auto at = [digit](double steps) {
      return fmt::format("{:.{}f}", steps * digit, decimals(digit));
    };
    if (std::round(lower / digit) == std::round(upper / digit)) return in_millimetres(upper);
    return trimmed(at(std::floor(lower / digit + kRounding))) + " to " +
           trimmed(at(std::ceil(upper / digit - kRounding))) + " mm";
  }
  /// The same of a length in millimetres.
  [[nodiscard]] static std::string in_millimetres(double mm) {
    if (mm > 0 && mm < 5e-4) return mm < 1e-4 ? "less than 0.0001 mm" : "less than 0.001 mm";
    return trimmed(fmt::format("{:.{}f}", mm == 0 ? 0.0 : mm, decimals(digit_of(mm)))) + " mm";
  }
  /// An area in mesh units squared, as mm² without their unit.
  [[nodiscard]] std::string area(double square_units) const {
    const double area = square_units / (units_per_mm_ * units_per_mm_);
    return fmt::format("{:.{}f}", area, area < 10 ? 2 : 1);
  }
  /// Mesh units cubed, as mm³ without their unit.
  [[nodiscard]] std::string volume(double cubic_units) const {
    const double volume = cubic_units / std::pow(units_per_mm_, 3);
    return fmt::format("{:.{}f}", volume, volume < 1 ? 3 : 2);
  }
  /// A coordinate in mesh units, to 0.01 mm.
  [[nodiscard]] std::string coordinate(double units) const {
    const double hundredths = std::round(100 * units / units_per_mm_);
    return fmt::format("{:g}", hundredths == 0 ? 0.0 : hundredths / 100 * units_per_mm_);
  }
  [[nodiscard]] std::string place(const Eigen::Vector3d& at) const {
    return fmt::format("({}, {}, {})", coordinate(at.x()), coordinate(at.y()), coordinate(at.z()));
  }
  [[nodiscard]] static std::string percent(double percent) {
    return fmt::format("{:.1f}", percent);
  }
  /// A share in per cent without their sign, and in brackets for a thinner and a thicker
  /// foundation.
  [[nodiscard]] static std::string share(double share, double thinner, double thicker) {
    return fmt::format("{:.1f} ({:.1f}; {:.1f})", share, thinner, thicker);
  }

 private:
  // The last digit that is written of a length, millimetres: four digits count.
  static double digit_of(double mm) {
    const double size = std::abs(mm);
    return size < 10 ? 1e-3 : size < 100 ? 1e-2 : size < 1000 ? 0.1 : 1;
  }
  static int decimals(double digit) { return static_cast<int>(std::round(-std::log10(digit))); }
  // Drops zeros after the decimal point.
  static std::string trimmed(std::string number) {
    if (number.find('.') == number.npos) return number;
    number.erase(number.find_last_not_of('0') + 1);
    if (number.back() == '.') number.pop_back();
    return number;
  }
  // -0 is written as 0.
  static std::string whole(double number) {
    return fmt::format("{:.0f}", number == 0 ? 0.0 : number);
  }
  template <class Round>
  static std::string in_words(double micrometres, Round round) {
    if (std::abs(micrometres) < 1e4) return whole(round(micrometres)) + " µm";
    return fmt::format("{:g} mm", round(micrometres / 10) / 100);
  }

  [[nodiscard]] double units_per_micrometre() const { return 1e-3 * units_per_mm_; }

  double units_per_mm_;
};

}  // namespace ist::answers
