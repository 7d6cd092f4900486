#include "ist/mesh/mesh_io.h"

#include <assimp/scene.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <limits>
#include <new>
#include <span>
#include <string_view>
#include <utility>

#include "ist/base/float_environment.h"
#include "ist/base/input_file.h"
#include "ist/mesh/format/mesh_format.h"
#include "ist/mesh/format/text_reader.h"
#include "ist/mesh/format/triangulate.h"
#include "ist/mesh/format/weld.h"

namespace ist {
namespace {

// Keeps assimp from any file that the content may name.
class NoFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

std::span<aiMesh* const> meshes_of(const aiScene& scene) {
  return {scene.mMeshes, scene.mNumMeshes};
}
std::span<const aiFace> faces_of(const aiMesh& mesh) { return {mesh.mFaces, mesh.mNumFaces}; }
std::span<const unsigned> corners_of(const aiFace& face) {
  return {face.mIndices, face.mNumIndices};
}

// Whether the scene holds what the checks found, and nothing that is not there is named.
bool holds(const aiScene& scene, std::size_t faces) {
  std::size_t found = 0;
  for (const aiMesh* mesh : meshes_of(scene)) {
    found += mesh->mNumFaces;
    for (const aiFace& face : faces_of(*mesh)) {
      if (face.mNumIndices < 3) return false;
      for (const unsigned corner : corners_of(face))
        if (corner >= mesh->mNumVertices) return false;
    }
  }
  return found == faces;
}

TriangleMesh weld_scene(const aiScene& scene) {
  std::size_t corner_count = 0, triangle_count = 0;
  for (const aiMesh* mesh : meshes_of(scene)) {
    for (const aiFace& face : faces_of(*mesh)) {
      corner_count += face.mNumIndices;
      triangle_count += face.mNumIndices - 2;
    }
  }
  Welder welder(corner_count);
  TriangleMesh welded;
  welded.triangles.reserve(triangle_count);
  std::vector<std::uint32_t> polygon;
  for (const aiMesh* mesh : meshes_of(scene)) {
    for (const aiFace& face : faces_of(*mesh)) {
      polygon.clear();
      for (const unsigned corner : corners_of(face)) {
        const aiVector3D& v = mesh->mVertices[corner];
        polygon.push_back(welder.index_of({v.x, v.y, v.z}));
      }
      triangulate(polygon, welder.vertices(), welded.triangles);
    }
  }
  welded.vertices = welder.vertices();
  return welded;
}

TriangleMesh parse(const CheckedContent& content, const std::string& file) {
  Assimp::Importer importer;
  importer.SetIOHandler(new NoFiles);  // the importer deletes it
  const aiScene* scene =
      importer.ReadFileFromMemory(content.bytes.data(), content.bytes.size(), 0, content.format);
  // It catches whatever is thrown, and keeps the text.
  if (scene == nullptr && importer.GetErrorString() == std::string_view(std::bad_alloc().what()))
    throw std::bad_alloc();
  if (scene == nullptr)
    fail_mesh(
        ErrorCode::kNotAMesh, file, "",
        fmt::format("assimp refuses it: {}; export the mesh again", importer.GetErrorString()));
  if (!holds(*scene, content.faces))
    fail_mesh(ErrorCode::kNotAMesh, file, "",
              fmt::format("assimp does not find the {} faces that are there; export the mesh again",
                          content.faces));
  return weld_scene(*scene);
}

void check_extent(const TriangleMesh& mesh, const std::string& file) {
  constexpr double kSmallest = 1e-12, kLargest = 1e15;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  const double extent = box.sizes().maxCoeff();
  if (!(extent >= kSmallest && extent <= kLargest))
    fail_mesh(ErrorCode::kMeshExtent, file, "",
              fmt::format("its largest extent is {:g}, outside [{:g}, {:g}]; scale the mesh",
                          extent, kSmallest, kLargest));
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& file) {
  const ScopedFloatEnvironment environment;  // numbers in text are rounded too
  TriangleMesh mesh = parse(check_content(InputFile(file).read_rest(), file), file.string());
  check_extent(mesh, file.string());
  return mesh;
}

}  // namespace ist
