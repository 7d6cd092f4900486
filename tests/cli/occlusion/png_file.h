#pragma once

#include <string>

#include "cli/occlusion/map_picture.h"

namespace ist::test {

/// Reads a PNG by libpng's decoder. Throws std::runtime_error for other bytes.
[[nodiscard]] cli::Picture decoded(const std::string& png);

/// The pixel at a place, whose y runs down.
[[nodiscard]] answers::Colour pixel_at(const cli::Picture& picture, int x, int y);

}  // namespace ist::test
