#include "import/scene_reader.h"

#include <assimp/config.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <new>
#include <utility>

#include "import/gltf_check.h"
#include "import/scene_format.h"
#include "import/side_files.h"
#include "import/xml_check.h"
#include "ist/base/printable.h"

namespace ist::import {
namespace {

// Keeps the first message that tells of a lost part of the surface. assimp would go on.
class LossLog : public Assimp::LogStream {
 public:
  explicit LossLog(std::string& first) : first_(first) {}
  void write(const char* message) override {
    constexpr std::string_view kLosses[] = {"out-of-range indices",
                                            "were dropped",
                                            "Vertex index overflow",
                                            "Unable to find geometry",
                                            "reference to instanced node",
                                            "Unresolved reference format of node",
                                            "face index is out of range",
                                            "Failure evaluating face record",
                                            "unsupported primitive chunk",
                                            "unknown polygon type",
                                            "not currently implemented",
                                            "not currently supported",
                                            "Invalid vertex reference",
                                            "Unexpected EOF",
                                            "not all vertices",
                                            "Chunk overflow",
                                            "unrecognized geometry",
                                            "Unsupported RotationMode",
                                            "unexpected face count",
                                            "unexpected vertex count",
                                            "not supported primitive type",
                                            "unsupported `Hole`"};
    const std::string_view text = message;
    const auto says = [text](std::string_view part) { return text.find(part) != text.npos; };
    // An object of an FBX that it cannot read, apart from materials. It tries newer versions.
    const bool fbx = says("FBX-DOM") && !says("newer format version") && !says("shading mode");
    const bool lost = fbx || std::any_of(std::begin(kLosses), std::end(kLosses), says);
    // Before the message are its kind and its thread.
    const std::size_t begin = std::min(text.find(": "), text.size() - 2) + 2;
    if (lost && first_.empty()) first_ = text.substr(begin, text.find('\n', begin) - begin);
  }

 private:
  std::string& first_;
};

Eigen::Affine3d transform_of(const aiMatrix4x4& m, std::string_view place) {
  Eigen::Affine3d transform;
  transform.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4,
      m.d1, m.d2, m.d3, m.d4;
  if (transform.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    refuse(ErrorCode::kNotAMesh, place,
           "its matrix is not affine; apply it before you export the mesh");
  return transform;
}

void place_mesh(const aiMesh& mesh, const Eigen::Affine3d& transform, const std::string& place,
                PlacedPolygons& placed) {
  if (mesh.HasBones())
    refuse(ErrorCode::kNotAMesh, place, "a skin bends it; apply it before you export the mesh");
  if (mesh.mNumAnimMeshes > 0)
    refuse(ErrorCode::kNotAMesh, place,
           "morph targets move its vertices; apply them before you export the mesh");
  std::size_t corners = 0;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) corners += mesh.mFaces[i].mNumIndices;
  placed.begin(mesh.mNumVertices, corners, transform, place);
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D& point = mesh.mVertices[i];
    placed.add_vertex({point.x, point.y, point.z});
  }
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    placed.add_polygon({face.mIndices, face.mNumIndices});
  }
}

// Places the meshes of all nodes, parents before children, in the order of the file.
void place_nodes(const aiScene& scene, const Eigen::Affine3d& root, PlacedPolygons& placed) {
  std::vector<std::pair<const aiNode*, Eigen::Affine3d>> left = {{scene.mRootNode, root}};
  while (!left.empty()) {
    const auto [node, parent] = left.back();
    left.pop_back();
    std::string_view named = node->mName.C_Str();
    named.remove_prefix(named.rfind('/') + 1);  // an X3D is named by its path
    const std::string name = fmt::format("node '{}'", printable(named));
    const Eigen::Affine3d transform = joined(parent, transform_of(node->mTransformation, name));
    for (unsigned i = 0; i < node->mNumMeshes; ++i) {
      const unsigned mesh = node->mMeshes[i];
      const std::string place = fmt::format("{}, mesh {}", name, mesh);
      if (mesh >= scene.mNumMeshes)
        refuse(ErrorCode::kMeshBadIndex, place, "there is no such mesh; export the mesh again");
      place_mesh(*scene.mMeshes[mesh], transform, place, placed);
    }
    for (unsigned i = node->mNumChildren; i-- > 0;)
      left.emplace_back(node->mChildren[i], transform);
  }
}

}  // namespace

PlacedPolygons read_scene(const Input& input) {
  const std::string format = scene_format(input);
  if (format == "glb" || format == "gltf") check_gltf(input.content);
  check_xml(format, input.content);
  auto* files = new SideFiles(input, format);  // the importer deletes it
  Assimp::Importer importer;
  importer.SetIOHandler(files);
  // No mesh is made up for a file of bones alone.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  std::string loss;
  Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
  Assimp::DefaultLogger::get()->attachStream(new LossLog(loss),
                                             Assimp::Logger::Warn | Assimp::Logger::Err);
  const aiScene* scene = importer.ReadFile(files->main_file(), 0);
  Assimp::DefaultLogger::kill();
  if (!files->missing().empty() && (scene == nullptr || !loss.empty()))
    refuse(
        ErrorCode::kFileUnreadable, "",
        fmt::format("it names the file '{}', which is not in its folder or below: copy it there, "
                    "or export one file that holds all",
                    printable(files->missing(), 200)));
  if (!loss.empty())
    refuse(loss.find("range") != loss.npos || loss.find("ertex") != loss.npos
               ? ErrorCode::kMeshBadIndex
               : ErrorCode::kNotAMesh,
           "",
           fmt::format("a part of it cannot be read ({}); export the mesh again, or convert it to "
                       "STL, PLY or OBJ",
                       loss));
  if (scene == nullptr || scene->mRootNode == nullptr) {
    std::string cause = importer.GetErrorString();
    if (cause.find("bad_alloc") != cause.npos) throw std::bad_alloc();
    const std::string name = files->main_file();
    if (const std::size_t at = cause.find(name); at != cause.npos)
      cause.replace(at, name.size(), input.path.filename().string());
    refuse(ErrorCode::kNotAMesh, "",
           fmt::format("{}; export the mesh again, or convert it to STL, PLY or OBJ", cause));
  }
  PlacedPolygons placed;
  tell_unit(format, input, *scene, placed);
  place_nodes(*scene, root_turn(format), placed);
  placed.require_polygons();
  return placed;
}

}  // namespace ist::import
