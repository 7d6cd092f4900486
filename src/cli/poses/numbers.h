#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

namespace ist::cli {

/// Returns the finite numbers of a text, parted by spaces, line ends or commas; nothing where a
/// word is no finite number. The decimal sign is the point, whatever the locale.
[[nodiscard]] std::optional<std::vector<double>> numbers_of(std::string_view text);

/// Returns the point or the direction of such a text; nothing where it does not hold three numbers.
[[nodiscard]] std::optional<Eigen::Vector3d> vector_of(std::string_view text);

}  // namespace ist::cli
