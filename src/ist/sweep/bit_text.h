#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "ist/base/platform/bit_cast.h"

namespace ist {

/// Returns a number's bits in 16 hexadecimal digits. The text of a floating-point number would hold
/// the decimal mark of the program's locale.
[[nodiscard]] inline std::string bits_of(double number) {
  return fmt::format("{:016x}", bit_cast<std::uint64_t>(number));
}

/// Returns the bits of a vector's numbers.
[[nodiscard]] inline std::string bits_of(const Eigen::Vector3d& v) {
  return fmt::format("{} {} {}", bits_of(v[0]), bits_of(v[1]), bits_of(v[2]));
}

}  // namespace ist
