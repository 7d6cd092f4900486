#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "answers/occlusion/bite.h"
#include "answers/occlusion/map_colours.h"
#include "cli/occlusion/bite_view.h"

namespace ist::cli {

/// A picture: its lines from the top, each of its pixels' red, green and blue (sRGB).
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// A point's place in a picture, pixels from the first one's outer corner, downwards.
[[nodiscard]] Eigen::Vector2d place_in(const BiteView& view, int width, int height,
                                       const Eigen::Vector3d& point);

/// Draws the distance map of one body: its triangles by a depth buffer, shaded, each pixel in the
/// colour of its band, with white lines in bands below the error assumed for scanning. Distances
/// are interpolated between the corners of a triangle. A triangle stays bare if a corner has no
/// distance, or if the distances of two corners differ by more than their distance from each other,
/// because then a sign is wrong. The points of contact regions that are closest to the other body
/// are dots: black, or white for contacts on one body alone.
///
/// Surfaces that face the eye have the very colours of the bands. Cost: some 0.1 s for 250,000
/// triangles at 900 × 700 pixels.
[[nodiscard]] Picture draw_map(const answers::BiteBody& body, const BiteView& view,
                               std::span<const answers::MapBand> bands, int width, int height);

/// Returns the picture as the bytes of a PNG file: 8 bits, RGB. Throws std::bad_alloc, or a
/// std::runtime_error with what libpng says.
[[nodiscard]] std::string png_of(const Picture& picture);

}  // namespace ist::cli
