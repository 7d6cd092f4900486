#include "answers/formats/level_geometry.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ist/tree/saved_spheres.h"
#include "ist/tree/tree_parts.h"

namespace ist::answers {
namespace {

// A corner of the lattice as one number: 20 bits an axis, x lowest.
std::uint64_t corner_code(const Cell& corner) {
  return corner[0] | std::uint64_t{corner[1]} << 20 | std::uint64_t{corner[2]} << 40;
}

Cell corner_of(std::uint64_t code) {
  const auto index = [code](int shift) {
    return static_cast<std::uint32_t>(code >> shift & 0xFFFFF);
  };
  return {index(0), index(20), index(40)};
}

// Returns the corners of one face of a cell, counter-clockwise as seen from outside.
std::array<std::uint64_t, 4> face_corners(const Cell& cell, std::size_t axis, std::uint32_t side) {
  constexpr std::array<std::array<std::uint32_t, 2>, 4> kAround{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  std::array<std::uint64_t, 4> corners{};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& step = kAround[side == 1 ? i : 3 - i];
    Cell corner = cell;
    corner[axis] += side;
    corner[(axis + 1) % 3] += step[0];
    corner[(axis + 2) % 3] += step[1];
    corners[i] = corner_code(corner);
  }
  return corners;
}

// Returns the corners of all faces that no neighbour hides, four a face.
std::vector<std::uint64_t> open_faces(std::span<const std::uint64_t> cells, std::uint32_t end,
                                      Progress& progress) {
  std::vector<std::uint64_t> faces;
  progress.begin_stage("finding the faces that are seen", cells.size());
  for (const std::uint64_t code : cells) {
    const Cell cell = morton_decode(code);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const std::uint32_t side : {0u, 1u}) {
        Cell neighbour = cell;
        neighbour[axis] += side == 1 ? 1u : ~0u;
        if (neighbour[axis] < end &&
            std::binary_search(cells.begin(), cells.end(), morton_encode(neighbour))) {
          continue;
        }
        const auto corners = face_corners(cell, axis, side);
        faces.insert(faces.end(), corners.begin(), corners.end());
      }
    }
    progress.add(1);
  }
  return faces;
}

}  // namespace

PolyData level_cubes(const SphereTree& tree, int level, Progress* progress) {
  Progress unseen;
  Progress& shown = progress != nullptr ? *progress : unseen;
  const Lattice& lattice = voxels_of(tree).lattice;
  const std::vector<std::uint64_t> cells = voxels_of(tree).octree.codes(level);
  const std::vector<std::uint64_t> faces = open_faces(cells, 1u << (tree.depth() - level), shown);
  shown.begin_stage("sorting corners", 0);
  std::vector<std::uint64_t> corners = faces;
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());

  PolyData cubes;
  cubes.corners = 4;
  cubes.points.reserve(corners.size());
  for (const std::uint64_t code : corners) {
    Eigen::Vector3d point = tree.origin();
    for (std::size_t i = 0; i < 3; ++i) {
      const double voxels = static_cast<double>(std::uint64_t{corner_of(code)[i]} << level);
      point[static_cast<Eigen::Index>(i)] += tree.voxel_size() * (voxels - lattice.root_centre());
    }
    cubes.points.push_back(point);
  }
  cubes.polygons.reserve(faces.size());
  shown.begin_stage("joining corners", faces.size());
  for (const std::uint64_t code : faces) {
    const auto found = std::lower_bound(corners.begin(), corners.end(), code);
    cubes.polygons.push_back(static_cast<std::uint32_t>(found - corners.begin()));
    shown.add(1);
  }
  return cubes;
}

PolyData level_centres(const SphereTree& tree, SpherePolicy policy, int level) {
  PolyData centres;
  std::vector<float> radii;
  for (const Ball& ball : level_spheres(tree, policy, level)) {
    centres.points.emplace_back(tree.origin() + ball.centre);
    radii.push_back(static_cast<float>(ball.radius));
  }
  centres.point_arrays.push_back({"radius", std::move(radii)});
  return centres;
}

}  // namespace ist::answers
