#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <nlohmann/json_fwd.hpp>
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
  Reply();
  ~Reply();
  Reply(Reply&&) noexcept;
  Reply& operator=(Reply&&) noexcept;

  /// The answer: an empty object at first.
  [[nodiscard]] nlohmann::ordered_json& json() { return *json_; }

  /// Keeps the numbers and returns their entry in the JSON: {"array": [KIND, ADDRESS, COUNT]}. The
  /// kind is the name of a JavaScript type. The memory lasts as long as this object.
  template <class Number>
  [[nodiscard]] nlohmann::ordered_json array(std::vector<Number> numbers) {
    const auto& kept = std::get<std::vector<Number>>(arrays_.emplace_back(std::move(numbers)));
    return array(kind(kept.data()), kept.data(), kept.size());
  }

 private:
  [[nodiscard]] static nlohmann::ordered_json array(const char* kind, const void* address,
                                                    std::size_t count);
  static constexpr const char* kind(const float*) { return "Float32Array"; }
  static constexpr const char* kind(const double*) { return "Float64Array"; }
  static constexpr const char* kind(const std::uint32_t*) { return "Uint32Array"; }
  static constexpr const char* kind(const std::uint8_t*) { return "Uint8Array"; }

  std::unique_ptr<nlohmann::ordered_json> json_;
  std::deque<Array> arrays_;
};

}  // namespace ist::viewer
