#include "cli/occlusion/bite_surfaces.h"

#include <algorithm>
#include <utility>

#include "cli/occlusion/map_colours.h"
#include "cli/occlusion/open_book.h"

namespace ist::cli {
namespace {

using Bodies2 = std::vector<const BiteBody*>;

Bodies2 bodies_of(const Bite& bite, BiteSide side) {
  if (side == BiteSide::kFixed) return {&bite.fixed};
  if (side == BiteSide::kMoving) return {&bite.moving};
  return {&bite.fixed, &bite.moving};
}

PolyData placed(const BiteBody& body, const Eigen::Isometry3d& placing) {
  PolyData data = poly_data(*body.mesh);
  const Eigen::Isometry3d place = placing * body.to_fixed;
  for (Eigen::Vector3d& point : data.points) point = place * point;
  std::vector<float> distances;
  for (const SurfaceDistance& one : body.surface.vertices) {
    distances.push_back(static_cast<float>(one.distance));
  }
  data.point_arrays.push_back({"Signed", std::move(distances)});
  return data;
}

std::vector<NamedPolyData> surfaces(const Bite& bite, const BiteSelection& selection) {
  const OpenedBook book = selection.open ? opened(bite, *selection.open) : OpenedBook{};
  std::vector<NamedPolyData> out;
  for (const BiteBody* body : bodies_of(bite, selection.side)) {
    PolyData data = placed(*body, body == &bite.fixed ? book.fixed : book.moving);
    if (!selection.open) data.frame = bite.frame;
    data.texts = {{"Unit", bite.unit_words()}, {"Caveat", kCaveat}};
    out.push_back({body->name, std::move(data)});
  }
  return out;
}

}  // namespace

std::vector<NamedPolyData> bite_surfaces(const Bite& bite, const BiteSelection& selection) {
  const std::vector<MapBand> bands = map_bands(bite);
  std::vector<NamedPolyData> out = surfaces(bite, selection);
  const Bodies2 bodies = bodies_of(bite, selection.side);
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (const SurfaceDistance& one : bodies[i]->surface.vertices) {
      out[i].data.colours.push_back(map_colour(one.distance, bands));
    }
  }
  return out;
}

std::vector<NamedPolyData> bite_arrays(const Bite& bite, const BiteSelection& selection) {
  std::vector<NamedPolyData> out = surfaces(bite, selection);
  const Bodies2 bodies = bodies_of(bite, selection.side);
  for (std::size_t i = 0; i < out.size(); ++i) {
    std::vector<std::int32_t> triangles;
    std::vector<std::uint8_t> known;
    for (const SurfaceDistance& one : bodies[i]->surface.vertices) {
      const bool beyond = one.triangle == SurfaceDistance::kNoTriangle;
      triangles.push_back(beyond ? -1 : static_cast<std::int32_t>(one.triangle));
      known.push_back(one.is_signed ? 1 : 0);
    }
    out[i].data.point_arrays.push_back({"Triangle", std::move(triangles)});
    out[i].data.point_arrays.push_back({"SignKnown", std::move(known)});
  }
  return out;
}

}  // namespace ist::cli
