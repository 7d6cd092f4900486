#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <utility>
#include <vector>

#include "ist/mesh/mesh.h"
#include "peers/libraries.h"

namespace ist::bench {
namespace {

// Blocks in the order of z, y, x, and so the voxels in each.
std::uint64_t key_of(const Eigen::Vector3d& point, double voxel_size) {
  std::uint64_t blocks = 0, voxels = 0;
  for (Eigen::Index i = 2; i >= 0; --i) {
    const auto at = static_cast<std::uint64_t>(
        static_cast<std::int64_t>(std::floor(point[i] / voxel_size)) + (1 << 20));
    blocks = blocks << 18 | at >> 3;
    voxels = voxels << 3 | (at & 7);
  }
  return blocks << 9 | voxels;
}

// Points on a mesh, no farther apart than `voxel_size`: of those in the same voxel of a lattice
// through the origin one is kept. They go block by block, 8 voxels an edge, so that neighbours
// follow each other. Precondition: fewer than 2^20 voxels to either side of the origin.
std::vector<Eigen::Vector3d> surface_points(const TriangleMesh& mesh, double voxel_size) {
  std::vector<std::pair<std::uint64_t, Eigen::Vector3d>> points;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    const double longest = std::max({(q - p).norm(), (r - q).norm(), (p - r).norm()});
    const int n = std::max(1, static_cast<int>(std::ceil(longest / voxel_size)));
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= n - i; ++j) {
        const Eigen::Vector3d point = p + (i * (q - p) + j * (r - p)) / n;
        points.emplace_back(key_of(point, voxel_size), point);
      }
    }
  }
  const auto key = [](const auto& point) { return point.first; };
  std::ranges::stable_sort(points, {}, key);
  const auto rest = std::ranges::unique(points, {}, key);
  std::vector<Eigen::Vector3d> kept;
  kept.reserve(static_cast<std::size_t>(rest.begin() - points.begin()));
  for (auto i = points.begin(); i != rest.begin(); ++i) kept.push_back(i->second);
  return kept;
}

using openvdb::FloatGrid;
constexpr float kBandVoxels = 3;
// From anywhere in a voxel to its centre, in voxels: by so much may a distance differ from the one
// there.
constexpr double kHalfDiagonal = 0.8660254037844387;

FloatGrid::Ptr grid_of(const TriangleMesh& mesh) {
  if (!check_mesh(mesh).closed) {
    std::cerr << "openvdb: the fixed mesh is open, and a level set has an inside\n";
    std::exit(1);
  }
  openvdb::initialize();
  std::vector<openvdb::Vec3s> points;
  points.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& v : mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
  std::vector<openvdb::Vec3I> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) triangles.emplace_back(a, b, c);
  return openvdb::tools::meshToLevelSet<FloatGrid>(
      *openvdb::math::Transform::createLinearTransform(voxel_size()), points, triangles,
      kBandVoxels);
}

class OpenvdbPeer final : public Peer {
 public:
  OpenvdbPeer(const char* name, FloatGrid::Ptr grid, std::vector<Eigen::Vector3d> points)
      : Peer(name, Guarantee::kSampled), grid_(std::move(grid)), points_(std::move(points)) {}

  [[nodiscard]] bool answers(Question question) const override {
    return question == Question::kMeets || question == Question::kDistance;
  }
  bool meets(const Eigen::Isometry3d& pose) override { return least(pose, 0, 0) <= 0; }
  DistanceInterval distance(const Eigen::Isometry3d& pose) override {
    const double found = least(pose, -band_, band_);
    if (found >= band_) return {band_ - half_diagonal_, std::numeric_limits<double>::infinity()};
    return {std::max(found, 0.0), std::max(found, 0.0)};
  }

 private:
  // The least signed distance at any point, if it is at most `most`, or else something greater;
  // the first that is at most `enough`.
  [[nodiscard]] double least(const Eigen::Isometry3d& pose, double enough, double most) const {
    const Eigen::Matrix3d rotation = pose.linear() / voxel_size();
    const Eigen::Vector3d translation = pose.translation() / voxel_size();
    const auto values = grid_->getConstAccessor();
    double best = most == 0 ? std::numeric_limits<double>::min() : most;
    for (const Eigen::Vector3d& point : points_) {
      const Eigen::Vector3d at = rotation * point + translation;
      const openvdb::Vec3R index(at.x(), at.y(), at.z());
      const openvdb::Coord voxel = openvdb::Coord::round(index);
      if (!box_.isInside(voxel)) continue;
      const float near = values.getValue(voxel);
      if (near >= grid_->background() || near - half_diagonal_ >= best) continue;
      const double value = openvdb::tools::BoxSampler::sample(values, index);
      if (value >= best) continue;
      best = value;
      if (best <= enough) break;
    }
    return best;
  }

  const FloatGrid::Ptr grid_;
  const std::vector<Eigen::Vector3d> points_;
  const openvdb::CoordBBox box_ = grid_->evalActiveVoxelBoundingBox();
  const double band_ = kBandVoxels * voxel_size(), half_diagonal_ = kHalfDiagonal * voxel_size();
};

Peers make_peers(const TriangleMesh& fixed, const TriangleMesh& moving) {
  const FloatGrid::Ptr grid = grid_of(fixed);
  Peers peers;
  peers.push_back(
      std::make_unique<OpenvdbPeer>("openvdb", grid, surface_points(moving, voxel_size())));
  peers.push_back(std::make_unique<OpenvdbPeer>("openvdb_vertices", grid, moving.vertices));
  return peers;
}

}  // namespace

Library openvdb_library() { return {"openvdb", OPENVDB_LIBRARY_VERSION_STRING, make_peers}; }

}  // namespace ist::bench
