#pragma once

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "ist/tree/sphere_tree.h"

namespace ist::viewer {

/// The two bodies' names in the page.
enum class Role { kFixed, kMoving };

/// The members of a question from the page. A reader throws kArgumentInvalid, with the member's
/// name, if the member is missing or of another kind.
class Asked {
 public:
  /// Reads JSON. Throws kArgumentInvalid if it is no object.
  explicit Asked(const std::string& text);

  [[nodiscard]] double number(const char* name) const;
  [[nodiscard]] std::uint64_t count(const char* name) const;
  [[nodiscard]] std::string text(const char* name) const;
  /// The text, or "" if the member is missing.
  [[nodiscard]] std::string text_or_none(const char* name) const;
  /// The number, or nothing if it is null or missing.
  [[nodiscard]] std::optional<double> number_or_none(const char* name) const;
  /// 16 numbers, column by column. Throws kPoseInvalid if they are no rigid motion.
  [[nodiscard]] Eigen::Isometry3d pose(const char* name) const;
  [[nodiscard]] Role role() const;
  /// The policy of that name, or nothing if the member is missing.
  [[nodiscard]] std::optional<SpherePolicy> policy() const;
  /// The unit, or kUnknown if the member is missing.
  [[nodiscard]] LengthUnit unit() const;
  /// The frame to turn a mesh into, or kUnknown if the member is missing.
  [[nodiscard]] PatientFrame to_frame() const;

 private:
  [[nodiscard]] const nlohmann::json* find(const char* name) const;
  [[noreturn]] static void refuse(const char* name, const char* wanted);

  nlohmann::json members_;
};

}  // namespace ist::viewer
