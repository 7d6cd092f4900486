#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "simd/dispatch.h"

namespace ist::test {

/// The names of all_kernels(), for tests with a target as their parameter.
[[nodiscard]] inline std::vector<std::string> all_targets() {
  std::vector<std::string> names;
  for (const Kernels& kernels : all_kernels()) names.emplace_back(kernels.target);
  return names;
}

/// Those that have a scalar twin.
[[nodiscard]] inline std::vector<std::string> vector_targets() {
  std::vector<std::string> names = all_targets();
  names.pop_back();
  return names;
}

[[nodiscard]] inline std::string name_of(const ::testing::TestParamInfo<std::string>& target) {
  return target.param;
}

}  // namespace ist::test
