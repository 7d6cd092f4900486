#pragma once

#include <nlohmann/json_fwd.hpp>

#include "cli/occlusion/bite.h"

namespace ist::cli {

/// Returns a bite as one object, schema 1: all but the distances of single vertices. What is not
/// known is null. docs/occlusion.md lists the keys.
[[nodiscard]] nlohmann::ordered_json json_of(const Bite& bite);

}  // namespace ist::cli
