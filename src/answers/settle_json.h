#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ist/measure/settle.h"

namespace ist::answers {

/// Returns a settled pose as JSON. docs/settle.md lists its keys. Numbers without an answer are
/// null.
[[nodiscard]] nlohmann::ordered_json json_of(const Settlement& settled);

}  // namespace ist::answers
