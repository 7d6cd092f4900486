#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace ist::answers {

/// A user named something that cannot be. The text begins with the name of the option or the file.
struct Refusal : std::runtime_error {
  /// The text is "OPTION: WHY".
  Refusal(const std::string& option, const std::string& why)
      : std::runtime_error(option + ": " + why) {}
};

/// Throws a Refusal if `wrong`. Its text is formatted only then.
void refuse_if(bool wrong, const std::string& option, const std::string& why);
template <typename... Args>
void refuse_if(bool wrong, const std::string& option, fmt::format_string<const Args&...> why,
               const Args&... args) {
  if (wrong) throw Refusal(option, fmt::format(why, args...));
}

/// Returns the finite numbers of a text. Spaces, line ends, commas and semicolons part them, and
/// the decimal sign is the point in every locale. Returns nothing if a word is not
/// a finite number.
[[nodiscard]] std::optional<std::vector<double>> numbers_of(std::string_view text);

/// Returns the point or the direction of a text, or nothing if it does not hold three numbers.
[[nodiscard]] std::optional<Eigen::Vector3d> vector_of(std::string_view text);

}  // namespace ist::answers
