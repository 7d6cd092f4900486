#include "support/bodies.h"

#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>

#include "ist/mesh/mesh.h"
#include "ist/models/models.h"

namespace ist::bench {
namespace {

bool has_real_pair() { return std::filesystem::exists(data_file("human_maxilla.stl")); }

using Trees = std::pair<SphereTree, SphereTree>;

// Those of a voxel size, made by whoever asks first.
const Trees& trees_of(std::map<double, std::unique_ptr<Trees>>& made, BuildOptions options) {
  auto& pair = made[options.voxel_size];
  if (pair == nullptr) {
    pair =
        std::make_unique<Trees>(build_tree(upper_jaw(), options), build_tree(lower_jaw(), options));
  }
  return *pair;
}

BuildOptions options_of(double voxel_size, SpherePolicy spheres) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  options.spheres = spheres;
  options.keep_triangles = false;
  return options;
}

}  // namespace

std::filesystem::path data_file(const char* name) {
  const char* named = std::getenv("IST_DATA_DIR");
  return std::filesystem::path(named != nullptr ? named : IST_SOURCE_DIR "/../shared/data") / name;
}

std::filesystem::path scene_file(const char* name) {
  return std::filesystem::path(IST_SOURCE_DIR "/tests/data/scenes") / name;
}

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
  return build_tree(mesh, options_of(voxel_size, spheres));
}

const Trees& trees(double voxel_size) {
  static std::map<double, std::unique_ptr<Trees>> made;
  return trees_of(made, options_of(voxel_size, SpherePolicy::kSlab));
}

const Trees& triangle_trees(double voxel_size) {
  static std::map<double, std::unique_ptr<Trees>> made;
  BuildOptions options = options_of(voxel_size, SpherePolicy::kSlab);
  options.keep_triangles = true;
  return trees_of(made, options);
}

}  // namespace ist::bench
