#include <assimp/config.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "import/format_checks.h"
#include "import/readers.h"
#include "import/scene_format.h"
#include "import/side_files.h"
#include "ist/base/printable.h"
#include "ist/mesh/format/text_reader.h"
#include "ist/mesh/import/import_message.h"

namespace ist::import {
namespace {

// Words of messages that speak of something other than the surface.
constexpr std::string_view kHarmless[] = {
    "anim",           "keyframe",      "key time",     "camera",
    "light",          "material",      "texture",      "texcoord",
    "image",          "embedded",      "video",        "effect",
    "<bind>",         "color",         "emissive",     "specular",
    "diffuse",        "ambient",       "shading",      "shader",
    "source surface", "normal",        "tangent",      "uv",
    "input type",     "vmad",          "vmap",         "clip",
    "layer",          "mapping",       "access type",  "empty geometry",
    "empty line",     "null geometry", "mesh with no", "newer format",
    "no hierarchy",   "same contents", "envl",         "span chunk"};

// Keeps the first warning or error that may tell of a lost part of the surface: each without a
// harmless word. assimp would go on.
class LossLog : public Assimp::LogStream {
 public:
  explicit LossLog(std::string& first) : first_(first) {}
  void write(const char* message) override {
    std::string_view text = message;
    // Before the message are its kind and its thread.
    text.remove_prefix(std::min(text.find(": "), text.size() - 2) + 2);
    text = text.substr(0, text.find('\n'));
    // Names in the file come after a quote, a second colon or these words.
    constexpr std::string_view kBeforeName = "instanced node ";
    const std::size_t colon = text.find(": ");
    std::string said(
        text.substr(0, std::min({text.find_first_of("\"'"), text.find(kBeforeName),
                                 text.find(": ", colon == text.npos ? colon : colon + 1)})));
    std::transform(said.begin(), said.end(), said.begin(), [](char c) {
      return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    const bool lost =
        std::none_of(std::begin(kHarmless), std::end(kHarmless),
                     [&](std::string_view part) { return said.find(part) != said.npos; });
    if (lost && first_.empty()) first_ = text;
  }

 private:
  std::string& first_;
};

// assimp passes over the surfaces of an AC3D beyond the stated number.
void check_ac(std::string_view content) {
  TextReader reader(content, "");
  double stated = 0, surfaces = 0;
  while (reader.next_line()) {
    const std::string_view word = reader.word();
    if (word == "SURF") ++surfaces;
    if (word == "numsurf") stated += number_of(reader.word(), Precision::kDouble).value_or(0);
  }
  if (surfaces > stated)
    refuse(
        ErrorCode::kNotAMesh, "",
        fmt::format("it has {} surfaces, but states {}; export the mesh again", surfaces, stated));
}

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

// Places the meshes of all nodes, parents before children, in the order of the file. A node may be
// named like the main file, which every error names.
void place_nodes(const aiScene& scene, const Eigen::Affine3d& root, const std::string& main_file,
                 PlacedPolygons& placed) {
  std::vector<std::pair<const aiNode*, Eigen::Affine3d>> left = {{scene.mRootNode, root}};
  while (!left.empty()) {
    const auto [node, parent] = left.back();
    left.pop_back();
    const std::string_view named = node->mName.C_Str();
    const std::string name =
        named == main_file ? "the scene" : fmt::format("node '{}'", printable(named));
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

// Throws the error of a scene that assimp read not at all, or not whole.
[[noreturn]] void refuse_scene(bool whole, std::string cause, const std::string& main_file) {
  if (cause.find("bad_alloc") != cause.npos) throw std::bad_alloc();
  if (const std::size_t at = cause.find(main_file); at != cause.npos)
    cause.replace(at, main_file.size(), "the file");
  cause.resize(cause.find_last_not_of(" .;\r\n") + 1);
  const bool index = cause.find("range") != cause.npos || cause.find("ertex") != cause.npos;
  refuse(index ? ErrorCode::kMeshBadIndex : ErrorCode::kNotAMesh, "",
         fmt::format("{} cannot be read ({}); export the mesh again, or {}",
                     whole ? "it" : "a part of it", cause, kConvert));
}

}  // namespace

PlacedPolygons read_scene(Input input, std::string_view format) {
  if (format == "glb" || format == "gltf") check_gltf(input.content);
  if (format == "ac") check_ac(input.content);
  const StatedUnit of_xml = check_xml(format, input.content);
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
  const bool unread = scene == nullptr || scene->mRootNode == nullptr;
  if (!files->missing().empty() && (unread || !loss.empty()))
    refuse(ErrorCode::kFileUnreadable, "",
           fmt::format("it names the file '{}', which is not in its folder or below: copy it "
                       "there, or export one file that holds all",
                       printable(files->missing(), 200)));
  if (unread || !loss.empty())
    refuse_scene(unread, loss.empty() ? importer.GetErrorString() : loss, files->main_file());
  PlacedPolygons placed;
  const StatedUnit stated =
      of_xml.unit == LengthUnit::kUnknown ? unit_of_scene(format, *scene) : of_xml;
  placed.unit = stated.unit;
  placed.factor = stated.factor;
  place_nodes(*scene, root_turn(format), files->main_file(), placed);
  placed.require_polygons();
  return placed;
}

}  // namespace ist::import
