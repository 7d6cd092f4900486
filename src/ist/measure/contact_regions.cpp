#include "ist/measure/contact_regions.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "ist/base/ordered_vector.h"
#include "ist/mesh/components.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

// The triangles that touch, joined where they share an edge that does. Returns for each triangle
// the first one it hangs together with.
std::vector<std::uint32_t> joined(const RefinedSurface& surface, double contact) {
  const auto& triangles = surface.triangles();
  const auto touches = [&](std::uint32_t v) { return surface.vertices()[v].distance <= contact; };
  // An edge, by its vertices, and a triangle at it. If whole surfaces touch, sorting is faster than
  // a hash table.
  using Side = std::pair<std::uint64_t, std::uint32_t>;
  std::vector<Side> sides;
  for (std::uint32_t k = 0; k < triangles.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] =
          std::minmax(triangles[k].vertex[i], triangles[k].vertex[(i + 1) % 3]);
      if (!touches(low) && !touches(high)) continue;
      sides.emplace_back(std::uint64_t{low} << 32 | high, k);
    }
  }
  std::sort(sides.begin(), sides.end());
  DisjointSets sets(triangles.size());
  for (std::size_t i = 1; i < sides.size(); ++i) {
    if (sides[i].first == sides[i - 1].first) sets.join(sides[i - 1].second, sides[i].second);
  }
  std::vector<std::uint32_t> of(triangles.size());
  for (std::uint32_t k = 0; k < of.size(); ++k) of[k] = sets.find(k);
  return of;
}

// A region while its triangles are added up.
struct Sum {
  ContactRegion region;
  Vector moment = Vector::Zero();
  std::uint32_t nearest = 0;
};

void add(const RefinedSurface& surface, const RefinedTriangle& triangle,
         const OcclusionOptions& options, Sum& sum) {
  const LevelTriangle corners = surface.corners(triangle);
  const LevelCut touching = cut_at(corners, options.contact), inside = cut_at(corners, 0);
  ContactRegion& region = sum.region;
  region.area += touching.area;
  add_to(sum.moment, touching.moment);
  region.penetrating_area += inside.area;
  region.depth_integral += inside.below;
  // Of a foundation that reaches farther than the region, no more than there is of that.
  const auto pressed = [&](double depth) {
    if (depth <= options.contact) return cut_at(corners, depth).below;
    return touching.below + (depth - options.contact) * touching.area;
  };
  ContactTriangle& piece = region.triangles.emplace_back(
      ContactTriangle{triangle.of, touching.area, pressed(options.foundation),
                      pressed(options.foundation - options.change),
                      pressed(options.foundation + options.change), HUGE_VAL});
  for (const std::uint32_t v : triangle.vertex) {
    const RefinedSurface::Vertex& vertex = surface.vertices()[v];
    piece.least_distance = std::min(piece.least_distance, vertex.distance);
    if (vertex.distance >= region.least_distance) continue;
    region.least_distance = vertex.distance;
    region.closest = vertex.at;
    region.triangle = triangle.of;
    sum.nearest = vertex.nearest;
  }
}

// Joins the pieces of each triangle of the mesh, and adds up the region's shares.
void join_pieces(ContactRegion& region) {
  std::vector<ContactTriangle>& pieces = region.triangles;
  std::stable_sort(
      pieces.begin(), pieces.end(),
      [](const ContactTriangle& a, const ContactTriangle& b) { return a.triangle < b.triangle; });
  std::size_t count = 0;
  for (const ContactTriangle& piece : pieces) {
    region.share += piece.pressed;
    region.share_thinner += piece.pressed_thinner;
    region.share_thicker += piece.pressed_thicker;
    if (count == 0 || pieces[count - 1].triangle != piece.triangle) {
      pieces[count++] = piece;
      continue;
    }
    ContactTriangle& whole = pieces[count - 1];
    whole.area += piece.area;
    whole.pressed += piece.pressed;
    whole.pressed_thinner += piece.pressed_thinner;
    whole.pressed_thicker += piece.pressed_thicker;
    whole.least_distance = std::min(whole.least_distance, piece.least_distance);
  }
  pieces.resize(count);
}

}  // namespace

ContactRegions contact_regions(const RefinedSurface& surface, const OcclusionOptions& options) {
  const std::vector<std::uint32_t> of = joined(surface, options.contact);
  std::unordered_map<std::uint32_t, std::size_t> places;
  std::vector<Sum> sums;
  for (std::uint32_t k = 0; k < of.size(); ++k) {
    const RefinedTriangle& triangle = surface.triangles()[k];
    const auto touches = [&](std::uint32_t v) {
      return surface.vertices()[v].distance <= options.contact;
    };
    if (std::none_of(triangle.vertex.begin(), triangle.vertex.end(), touches)) continue;
    const auto [place, is_new] = places.try_emplace(of[k], sums.size());
    if (is_new) sums.emplace_back().region.least_distance = HUGE_VAL;
    add(surface, triangle, options, sums[place->second]);
  }
  std::erase_if(sums, [&](const Sum& sum) {
    return !(sum.region.area > 0) || sum.region.area < options.least_area;
  });
  std::stable_sort(sums.begin(), sums.end(),
                   [](const Sum& a, const Sum& b) { return a.region.area > b.region.area; });
  double all = 0, thinner = 0, thicker = 0;
  for (Sum& sum : sums) {
    join_pieces(sum.region);
    all += sum.region.share;
    thinner += sum.region.share_thinner;
    thicker += sum.region.share_thicker;
  }
  ContactRegions out;
  for (Sum& sum : sums) {
    ContactRegion& region = sum.region;
    region.centre = scaled(1 / region.area, sum.moment);
    region.share = all > 0 ? region.share / all : 0;
    region.share_thinner = thinner > 0 ? region.share_thinner / thinner : 0;
    region.share_thicker = thicker > 0 ? region.share_thicker / thicker : 0;
    out.regions.push_back(std::move(region));
    out.nearest.push_back(sum.nearest);
  }
  return out;
}

void pair_regions(ContactRegions& fixed, ContactRegions& moving) {
  // The first region of `others` that lies in the triangle nearest to region `k`.
  const auto faced = [](const ContactRegions& one, std::size_t k,
                        const ContactRegions& others) -> std::optional<std::uint32_t> {
    for (std::uint32_t other = 0; other < others.regions.size(); ++other) {
      const auto& triangles = others.regions[other].triangles;
      const auto at = std::lower_bound(triangles.begin(), triangles.end(), one.nearest[k],
                                       [](const ContactTriangle& each, std::uint32_t triangle) {
                                         return each.triangle < triangle;
                                       });
      if (at != triangles.end() && at->triangle == one.nearest[k]) return other;
    }
    return {};
  };
  const auto find_faced = [&](ContactRegions& surface, const ContactRegions& others) {
    for (std::size_t k = 0; k < surface.regions.size(); ++k) {
      surface.regions[k].faces = faced(surface, k, others);
    }
  };
  find_faced(fixed, moving);
  find_faced(moving, fixed);
  for (std::uint32_t k = 0; k < fixed.regions.size(); ++k) {
    const auto other = fixed.regions[k].faces;
    if (!other || moving.regions[*other].faces != k) continue;
    fixed.regions[k].partner = *other;
    moving.regions[*other].partner = k;
  }
}

}  // namespace ist
