#include "import/placed_polygons.h"

#include <fmt/format.h>

#include <utility>

#include "ist/base/counted.h"
#include "ist/mesh/format/text_reader.h"
#include "ist/mesh/import/import_message.h"

namespace ist::import {
namespace {

Eigen::Vector3d moved_by(const Eigen::Affine3d& transform, const Eigen::Vector3d& v) {
  const Eigen::Matrix4d& m = transform.matrix();
  Eigen::Vector3d at;
  for (Eigen::Index i = 0; i < 3; ++i) {
    at[i] = ((m(i, 0) * v[0] + m(i, 1) * v[1]) + m(i, 2) * v[2]) + m(i, 3);
  }
  return at;
}

}  // namespace

void refuse(ErrorCode code, std::string_view place, std::string_view cause) {
  throw Refusal{code, std::string(place), std::string(cause)};
}

Eigen::Affine3d joined(const Eigen::Affine3d& second, const Eigen::Affine3d& first) {
  const Eigen::Matrix4d &a = second.matrix(), &b = first.matrix();
  Eigen::Affine3d product = Eigen::Affine3d::Identity();
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      const double sum = (a(i, 0) * b(0, j) + a(i, 1) * b(1, j)) + a(i, 2) * b(2, j);
      product.matrix()(i, j) = j < 3 ? sum : sum + a(i, 3);
    }
  }
  return product;
}

void PlacedPolygons::begin(std::size_t vertices, std::size_t corners,
                           const Eigen::Affine3d& transform, std::string place) {
  place_ = std::move(place);
  // One more, so that a placement of nothing counts as well.
  if (vertices + corners >= kMostPlaced - placed_)
    refuse(ErrorCode::kMeshTooLarge, place_,
           fmt::format("the scene places more than {} vertices and corners; export each mesh to a "
                       "file of its own",
                       kMostPlaced));
  placed_ += vertices + corners + 1;
  transform_ = transform;
  mirrors_ = transform.linear().determinant() < 0;
  first_ = coordinates_.size() / 3;
}

void PlacedPolygons::add_vertex(const Eigen::Vector3d& point) {
  for (const double coordinate : Eigen::Vector3d(moved_by(transform_, point) * factor)) {
    if (!is_coordinate(coordinate))
      refuse(ErrorCode::kMeshNotFinite, place_,
             fmt::format("vertex {} is not finite, or is placed beyond a float's range; repair the "
                         "mesh where it was made",
                         coordinates_.size() / 3 - first_));
    coordinates_.push_back(coordinate);
  }
}

void PlacedPolygons::add_polygon(std::span<const std::uint32_t> corners) {
  if (corners.size() < 3) return;
  const std::size_t vertices = coordinates_.size() / 3 - first_;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::uint32_t corner = corners[mirrors_ && i > 0 ? corners.size() - i : i];
    if (corner >= vertices)
      refuse(ErrorCode::kMeshBadIndex, place_,
             fmt::format("a face names vertex {}, but there are {}, counted from 0; export the "
                         "mesh again",
                         corner, vertices));
    corners_.push_back(static_cast<std::uint32_t>(first_) + corner);
  }
  sizes_.push_back(static_cast<std::uint32_t>(corners.size()));
}

void PlacedPolygons::require_polygons() const {
  if (!sizes_.empty()) return;
  if (coordinates_.empty())
    refuse(ErrorCode::kMeshEmpty, "", "the scene has no mesh; export the mesh again");
  refuse(ErrorCode::kMeshPointsOnly, "",
         fmt::format("the scene has {}, but no triangle; export the surface as polygons",
                     counted(coordinates_.size() / 3, "vertex", "vertices")));
}

}  // namespace ist::import
