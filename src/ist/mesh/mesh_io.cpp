#include <assimp/scene.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <bit>
#include <limits>
#include <new>
#include <span>
#include <string_view>
#include <unordered_map>

#include "ist/base/assert.h"
#include "ist/base/files.h"
#include "ist/base/float_environment.h"
#include "ist/mesh/format/mesh_format.h"
#include "ist/mesh/format/text_reader.h"
#include "ist/mesh/format/triangulate.h"
#include "ist/mesh/mesh.h"

namespace ist {
namespace {

// Denies assimp every file that the content may name.
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

// Whether the scene has the faces that the checks found, and each corner refers to an existing
// vertex.
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

struct PointHash {
  std::size_t operator()(const std::array<float, 3>& point) const noexcept {
    std::uint64_t hash = 0;
    for (const float coordinate : point) {
      hash = (hash ^ std::bit_cast<std::uint32_t>(coordinate)) * 0x9E3779B97F4A7C15u;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

// Welds points into vertices: points with exactly the same three floats become one vertex; -0
// equals 0. Vertices are in the order of first appearance.
TriangleMesh weld_scene(const aiScene& scene) {
  std::size_t triangle_count = 0;
  for (const aiMesh* mesh : meshes_of(scene))
    for (const aiFace& face : faces_of(*mesh)) triangle_count += face.mNumIndices - 2;
  TriangleMesh welded;
  welded.triangles.reserve(triangle_count);
  std::unordered_map<std::array<float, 3>, std::uint32_t, PointHash> known;
  known.reserve(triangle_count / 2);  // the vertices of a closed surface
  const auto index_of = [&](const aiVector3D& v) {
    IST_ASSERT(known.size() < std::numeric_limits<std::uint32_t>::max());
    const std::array<float, 3> point = {v.x + 0.0f, v.y + 0.0f, v.z + 0.0f};  // turns -0 into 0
    const auto next = static_cast<std::uint32_t>(known.size());
    const auto [vertex, is_new] = known.try_emplace(point, next);
    if (is_new) welded.vertices.emplace_back(point[0], point[1], point[2]);
    return vertex->second;
  };
  std::vector<std::uint32_t> polygon;
  for (const aiMesh* mesh : meshes_of(scene)) {
    for (const aiFace& face : faces_of(*mesh)) {
      polygon.clear();
      for (const unsigned corner : corners_of(face))
        polygon.push_back(index_of(mesh->mVertices[corner]));
      triangulate(polygon, welded.vertices, welded.triangles);
    }
  }
  return welded;
}

TriangleMesh parse(const CheckedContent& content, const std::string& file) {
  Assimp::Importer importer;
  importer.SetIOHandler(new NoFiles);  // the importer deletes it
  const aiScene* scene =
      importer.ReadFileFromMemory(content.bytes.data(), content.bytes.size(), 0, content.format);
  // The importer catches every exception and keeps only its text.
  if (scene == nullptr && importer.GetErrorString() == std::string_view(std::bad_alloc().what()))
    throw std::bad_alloc();
  if (scene == nullptr)
    fail_mesh(ErrorCode::kNotAMesh, file, "",
              fmt::format("assimp rejects the file: {}; export the mesh again",
                          importer.GetErrorString()));
  if (!holds(*scene, content.faces))
    fail_mesh(ErrorCode::kNotAMesh, file, "",
              fmt::format("assimp does not find the file's {} faces; export the mesh again",
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
              fmt::format("the largest extent is {:g} units, outside [{:g}, {:g}]; scale the mesh",
                          extent, kSmallest, kLargest));
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& file) {
  const ScopedFloatEnvironment environment;  // parsing numbers rounds as well
  TriangleMesh mesh = parse(check_content(InputFile(file).read_rest(), file), file.string());
  check_extent(mesh, file.string());
  return mesh;
}

}  // namespace ist
