#pragma once

#include <cstdint>
#include <deque>
#include <nlohmann/json.hpp>
#include <utility>
#include <variant>
#include <vector>

namespace ist::viewer {

/// Numbers that the page takes as a typed array.
using Array = std::variant<std::vector<float>, std::vector<double>, std::vector<std::uint32_t>,
                           std::vector<std::uint8_t>>;

/// An answer for the page: JSON, and the arrays that it names.
class Reply {
 public:
  nlohmann::ordered_json json = nlohmann::ordered_json::object();

  /// Keeps the numbers, and returns what stands for them in the JSON: {"array": [KIND, ADDRESS,
  /// COUNT]}, where the kind is the name of a JavaScript type. The memory lasts as long as this.
  template <class Number>
  [[nodiscard]] nlohmann::ordered_json array(std::vector<Number> numbers) {
    const auto& kept = std::get<std::vector<Number>>(arrays_.emplace_back(std::move(numbers)));
    return {
        {"array", {kind(kept.data()), reinterpret_cast<std::uintptr_t>(kept.data()), kept.size()}}};
  }

 private:
  static constexpr const char* kind(const float*) { return "Float32Array"; }
  static constexpr const char* kind(const double*) { return "Float64Array"; }
  static constexpr const char* kind(const std::uint32_t*) { return "Uint32Array"; }
  static constexpr const char* kind(const std::uint8_t*) { return "Uint8Array"; }

  std::deque<Array> arrays_;
};

}  // namespace ist::viewer
