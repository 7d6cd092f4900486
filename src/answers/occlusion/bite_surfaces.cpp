#include "answers/occlusion/bite_surfaces.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "answers/formats/glb_writer.h"
#include "answers/occlusion/bite_direction.h"
#include "answers/occlusion/bite_hints.h"
#include "answers/occlusion/map_colours.h"

namespace ist::answers {
namespace {

using Vector = Eigen::Vector3d;

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
};

// Returns the range of a placed body along a direction.
Range range_of(const BiteBody& body, const Eigen::Isometry3d& place, const Vector& along) {
  const Eigen::Isometry3d whole = place * body.to_fixed;
  Range range;
  for (const Vector& vertex : body.mesh->vertices) {
    const double at = along.dot(whole * vertex);
    range = {std::min(range.low, at), std::max(range.high, at)};
  }
  return range;
}

Eigen::Isometry3d quarter(const Vector& axis, double sense) {
  Eigen::Matrix3d cross;
  cross << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  turn.linear() = sense * cross + axis * axis.transpose();
  return turn;
}

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
    const std::vector<std::string> remarks = remarks_of(bite);
    if (!remarks.empty()) {
      data.texts.push_back({"Remarks", fmt::format("{}", fmt::join(remarks, "; "))});
    }
    out.push_back({body->name, std::move(data)});
  }
  return out;
}

}  // namespace

OpenedBook opened(const Bite& bite, double gap, BookLayout layout) {
  const BiteDirections directions = directions_of(bite);
  const Vector &towards = directions.towards, &front = directions.front;
  const bool beside = layout == BookLayout::kBeside;
  const Vector hinge = beside ? Vector(-front) : towards.cross(front);
  // Both faces look at the viewer: the fixed body's looked `towards`, the moving body's against it.
  const Vector viewer = hinge.cross(towards);
  OpenedBook book{quarter(hinge, +1), quarter(hinge, -1), viewer,
                  beside ? front : Vector(-towards)};
  const auto shift = [&](const BiteBody& body, Eigen::Isometry3d& place, double aside) {
    place.pretranslate(aside * towards - range_of(body, place, viewer).middle() * viewer);
  };
  shift(bite.fixed, book.fixed, -0.5 * gap - range_of(bite.fixed, book.fixed, towards).high);
  shift(bite.moving, book.moving, 0.5 * gap - range_of(bite.moving, book.moving, towards).low);
  return book;
}

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

void write_bite_glb(const Bite& bite, const BiteSelection& selection, OutputFile& file) {
  std::vector<NamedPolyData> bodies = bite_surfaces(bite, selection);
  for (NamedPolyData& body : bodies) {
    body.data.normals = vertex_normals(body.data);
    body.data.point_arrays.clear();
  }
  write_glb(bodies, 1e-3 / bite.units_per_mm, file);
}

}  // namespace ist::answers
