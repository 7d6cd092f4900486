#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/bodies.h"
#include "cli/occlusion/bite_maker.h"

namespace ist::cli {

/// Returns a body as the page's data holds it: its role, name and tree file, in base64.
[[nodiscard]] nlohmann::ordered_json body_block(const char* role, const std::string& name,
                                                const SphereTree& tree);

/// Returns the data of a page that shows one body or two: `moving` may be null.
[[nodiscard]] nlohmann::ordered_json bodies_block(const SphereTree& fixed,
                                                  const std::string& fixed_name,
                                                  const SphereTree* moving,
                                                  const std::string& moving_name,
                                                  const Eigen::Isometry3d& pose);

/// Returns the data of a page that shows an occlusion: the page measures it again, to the same
/// bits.
[[nodiscard]] nlohmann::ordered_json bite_block(const Bodies& bodies, const Bite& bite,
                                                const BiteQuestions& questions);

/// Whether the page can ask all that was asked: it knows no sides, midlines and labels.
[[nodiscard]] bool page_shows(const BiteQuestions& questions);

/// Returns 16 numbers, column by column.
[[nodiscard]] nlohmann::ordered_json matrix_block(const Eigen::Isometry3d& pose);

}  // namespace ist::cli
