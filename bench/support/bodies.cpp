#include "support/bodies.h"

#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>

#include "ist/mesh/jaw_model.h"
#include "ist/mesh/mesh_io.h"

namespace ist::bench {
namespace {

std::filesystem::path data_file(const char* name) {
  const char* named = std::getenv("IST_DATA_DIR");
  return std::filesystem::path(named != nullptr ? named : IST_SOURCE_DIR "/../shared/data") / name;
}

bool has_real_pair() { return std::filesystem::exists(data_file("human_maxilla.stl")); }

}  // namespace

const char* pair_name() { return has_real_pair() ? "human" : "built-in"; }

const TriangleMesh& upper_jaw() {
  static const TriangleMesh mesh =
      has_real_pair() ? read_mesh(data_file("human_maxilla.stl")) : make_jaw(Jaw::kUpper, 1);
  return mesh;
}

const TriangleMesh& lower_jaw() {
  static const TriangleMesh mesh =
      has_real_pair() ? read_mesh(data_file("human_mandible.stl")) : make_jaw(Jaw::kLower, 1);
  return mesh;
}

SphereTree build(const TriangleMesh& mesh, double voxel_size, SpherePolicy spheres) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  options.spheres = spheres;
  return build_tree(mesh, options);
}

const std::pair<SphereTree, SphereTree>& trees(double voxel_size) {
  static std::map<double, std::unique_ptr<std::pair<SphereTree, SphereTree>>> made;
  auto& pair = made[voxel_size];
  if (pair == nullptr) {
    pair = std::make_unique<std::pair<SphereTree, SphereTree>>(
        build(upper_jaw(), voxel_size, SpherePolicy::kSlab),
        build(lower_jaw(), voxel_size, SpherePolicy::kSlab));
  }
  return *pair;
}

Eigen::Isometry3d closing(double dz) {
  constexpr double kTurn = 0.0003;  // small enough for two terms of the series
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.matrix()(0, 0) = pose.matrix()(1, 1) = 1 - kTurn * kTurn / 2;
  pose.matrix()(1, 0) = kTurn - kTurn * kTurn * kTurn / 6;
  pose.matrix()(0, 1) = -pose.matrix()(1, 0);
  pose.translation()[2] = dz;
  return pose;
}

}  // namespace ist::bench
