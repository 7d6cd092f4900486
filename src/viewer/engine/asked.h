#pragma once

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "ist/tree/sphere_tree.h"

namespace ist::viewer {

/// The two bodies' names in the page.
enum class Role { kFixed, kMoving };

/// A question's members, as the page sends them. A member that is missing, or of another kind than
/// its reader returns, throws kArgumentInvalid, naming it.
class Asked {
 public:
  /// Reads JSON. Throws kArgumentInvalid where it is no object.
  explicit Asked(const std::string& text);

  [[nodiscard]] double number(const char* name) const;
  [[nodiscard]] std::uint64_t count(const char* name) const;
  [[nodiscard]] std::string text(const char* name) const;
  /// The text, or "" where the member is missing.
  [[nodiscard]] std::string text_or_none(const char* name) const;
  /// The number, or nothing where it is null or missing.
  [[nodiscard]] std::optional<double> number_or_none(const char* name) const;
  /// 16 numbers, column by column. Throws kPoseInvalid for one that is no rigid motion.
  [[nodiscard]] Eigen::Isometry3d pose(const char* name) const;
  [[nodiscard]] Role role() const;
  /// The policy of that name; nothing where the member is missing.
  [[nodiscard]] std::optional<SpherePolicy> policy() const;
  /// The unit; kUnknown where the member is missing.
  [[nodiscard]] LengthUnit unit() const;

 private:
  [[nodiscard]] const nlohmann::json* find(const char* name) const;
  [[noreturn]] static void refuse(const char* name, const char* wanted);

  nlohmann::json members_;
};

}  // namespace ist::viewer
