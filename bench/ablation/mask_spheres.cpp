#include "ablation/mask_spheres.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <span>

#include "ist/tree/enclosing_ball.h"
#include "ist/tree/implicit_ball.h"
#include "ist/tree/lookup_table_search.h"

namespace ist::bench {
namespace {

constexpr double kSixth = 1.0 / 6;

Ball in_half_edges(const TableBall& ball, std::size_t code) {
  return {{kSixth * ball.x, kSixth * ball.y, kSixth * ball.z}, kTableRadii[code]};
}

}  // namespace

// By the code in the table's word, as a search takes it.
Ball looked_up(std::uint8_t mask) {
  return in_half_edges(kLookupTable[mask], kTableWords[mask] >> 9);
}

Ball enclosed(std::uint8_t mask) {
  std::array<Eigen::Vector3d, 27> corners;
  std::size_t count = 0;
  const std::uint32_t taken = lookup_table_detail::corners_of(mask);
  for (int i = 0; i < 27; ++i) {
    if ((taken >> i & 1) == 0) continue;
    const auto [x, y, z] = lookup_table_detail::corner(i);
    corners[count++] = {kSixth * x, kSixth * y, kSixth * z};
  }
  return enclosing_ball(std::span(corners).first(count), 1e-9);
}

Ball searched(std::uint8_t mask) {
  const TableBall ball = lookup_table_detail::smallest_ball(mask);
  return in_half_edges(ball, radius_code(ball));
}

std::vector<std::uint8_t> some_masks(const LinearOctree& octree, std::size_t count) {
  const std::span<const std::uint8_t> all = octree.masks(1);
  std::vector<std::uint8_t> masks;
  const std::size_t step = std::max<std::size_t>(1, all.size() / count);
  for (std::size_t i = 0; i < all.size() && masks.size() < count; i += step) {
    masks.push_back(all[i]);
  }
  for (const std::uint8_t mask : masks) {
    const Ball expected = looked_up(mask);
    for (const SphereOfMask make : {enclosed, searched}) {
      const Ball ball = make(mask);
      const double apart =
          std::max((ball.centre - expected.centre).norm(), std::abs(ball.radius - expected.radius));
      if (apart <= 1e-6) continue;
      std::cerr << "ablation: the sphere of mask " << int{mask} << " differs by " << apart
                << " half edges from that of the table\n";
      std::exit(1);
    }
  }
  return masks;
}

}  // namespace ist::bench
