#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <string>

namespace ist {

/// Returns a vector's numbers to the bit, in hexadecimal digits.
[[nodiscard]] inline std::string text_of(const Eigen::Vector3d& v) {
  return fmt::format("{:a} {:a} {:a}", v[0], v[1], v[2]);
}

}  // namespace ist
