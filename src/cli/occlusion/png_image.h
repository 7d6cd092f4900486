#pragma once

#include <string>

#include "cli/occlusion/map_picture.h"

namespace ist::cli {

/// Returns the picture as the bytes of a PNG file: 8 bits, RGB. Throws std::bad_alloc, or a
/// std::runtime_error with what libpng says.
[[nodiscard]] std::string png_of(const Picture& picture);

}  // namespace ist::cli
