#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "ist/tree/bounds.h"
#include "ist/tree/linear_octree.h"

namespace ist::bench {

/// The smallest ball round the children's cubes of a mask, in half edges of the node's cube from
/// its centre.
using SphereOfMask = Ball (*)(std::uint8_t mask);

/// From the table that the compiler made.
[[nodiscard]] Ball looked_up(std::uint8_t mask);
/// By enclosing_ball() of the cubes' corners, to 1e-9 of the radius.
[[nodiscard]] Ball enclosed(std::uint8_t mask);
/// As the compiler makes the table: the best of 125 centres, in whole numbers.
[[nodiscard]] Ball searched(std::uint8_t mask);

inline constexpr std::pair<const char*, SphereOfMask> kWaysToMakeSpheres[] = {
    {"1-lookup", looked_up}, {"2-enclosing_ball", enclosed}, {"3-search", searched}};

/// Masks of nodes just above the leaves, at most `count`, spread evenly over the tree. Ends the
/// program where for any of them the ways to make a sphere differ by more than 1e-6 half edges.
[[nodiscard]] std::vector<std::uint8_t> some_masks(const LinearOctree& octree, std::size_t count);

}  // namespace ist::bench
