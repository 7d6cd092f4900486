#pragma once

#define XXH_INLINE_ALL  // so that the header is all that a platform needs of it
#include <xxhash.h>

#include <Eigen/Core>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

namespace ist::test {

/// The XXH3-64 of numbers, by their bits: -0 is not 0. Members are added one by one, for between
/// them a compiler may leave room. Sizes and counts are added in 64 bits.
class Hasher {
 public:
  template <std::integral Number>
  Hasher& add(Number number) {
    return append(static_cast<std::uint64_t>(number));
  }
  Hasher& add(double number) { return append(number); }
  Hasher& add(const Eigen::Vector3d& vector) {
    return append(vector[0]).append(vector[1]).append(vector[2]);
  }
  Hasher& add(std::string_view text) {
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    return *this;
  }

  [[nodiscard]] std::uint64_t value() const { return XXH3_64bits(bytes_.data(), bytes_.size()); }

 private:
  template <class Number>
  Hasher& append(Number number) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    bytes_.insert(bytes_.end(), bytes, bytes + sizeof bytes);
    return *this;
  }

  std::vector<char> bytes_;
};

}  // namespace ist::test
