#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ist/mesh/format/affine.h"
#include "ist/mesh/format/gltf_file.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/format/placed_meshes.h"

namespace ist {
namespace {

using Json = nlohmann::json;

// The numbers by which glTF names types and kinds of primitives.
constexpr std::uint64_t kUnsignedByte = 5121, kUnsignedShort = 5123, kUnsignedInt = 5125,
                        kFloat = 5126;
constexpr std::uint64_t kTriangles = 4, kStrip = 5, kFan = 6;

class GltfReader {
 public:
  GltfReader(std::string_view content, std::string_view file)
      : file_(content, file), placed_(file) {}

  // Places the meshes of the scene's nodes, parents before children, in the order of the file.
  TriangleMesh read() {
    if (GltfFile::find(file_.root(), "scenes") == nullptr)
      file_.fail(ErrorCode::kMeshEmpty, "", "the glTF has no scene; export the mesh again");
    const std::uint64_t scene = file_.index_or(file_.root(), "scene", 0, "scene");
    struct Node {
      std::uint64_t number;
      Eigen::Affine3d parent;
    };
    std::vector<Node> left;  // the next one last
    const auto push = [&](const Json& holder, const char* key, const Eigen::Affine3d& parent) {
      const Json* nodes = GltfFile::find(holder, key);
      if (nodes == nullptr || !nodes->is_array()) return;
      for (std::size_t i = nodes->size(); i-- > 0;)
        left.push_back({file_.whole((*nodes)[i], key), parent});
    };
    push(file_.element("scenes", scene), "nodes", Eigen::Affine3d::Identity());
    std::vector<bool> visited;
    while (!left.empty()) {
      const Node node = left.back();
      left.pop_back();
      const std::string place = fmt::format("node {}", node.number);
      const Json& described = file_.element("nodes", node.number);
      if (visited.size() <= node.number) visited.resize(node.number + 1);
      if (visited[node.number])
        file_.fail(ErrorCode::kNotAMesh, place,
                   "it is the child of several nodes, or of itself; export the mesh again");
      visited[node.number] = true;
      const Eigen::Affine3d transform = joined(node.parent, transform_of(described, place));
      if (GltfFile::find(described, "mesh") != nullptr) place_mesh(described, transform, place);
      push(described, "children", transform);
    }
    return placed_.finish();
  }

 private:
  Eigen::Affine3d transform_of(const Json& node, const std::string& place) const {
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    if (GltfFile::find(node, "matrix") != nullptr) {
      const auto matrix = file_.numbers(node, "matrix", std::vector<double>(16), place);
      result.matrix() = Eigen::Map<const Eigen::Matrix4d>(matrix.data());
      if (result.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1))
        file_.fail(ErrorCode::kNotAMesh, place,
                   "its matrix is not affine; apply it before you export the mesh");
      return result;
    }
    const auto shift = file_.numbers(node, "translation", {0, 0, 0}, place);
    const auto turn = file_.numbers(node, "rotation", {0, 0, 0, 1}, place);
    const auto scale = file_.numbers(node, "scale", {1, 1, 1}, place);
    result.linear() = rotation_of(turn, place).toRotationMatrix() *
                      Eigen::Vector3d(scale[0], scale[1], scale[2]).asDiagonal();
    result.translation() = Eigen::Vector3d(shift[0], shift[1], shift[2]);
    return result;
  }

  // A quaternion whose length is not 1 would scale: rounding by the exporter is taken out, and more
  // is nothing that the format defines.
  Eigen::Quaterniond rotation_of(const std::vector<double>& q, const std::string& place) const {
    constexpr double kMostError = 1e-3;
    const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    if (!(std::abs(square - 1) <= kMostError))
      file_.fail(ErrorCode::kNotAMesh, place,
                 fmt::format("its rotation has the length {:g}, not 1; apply it before you export "
                             "the mesh",
                             std::sqrt(square)));
    const double length = std::sqrt(square);
    return {q[3] / length, q[0] / length, q[1] / length, q[2] / length};
  }

  void place_mesh(const Json& node, const Eigen::Affine3d& transform, const std::string& place) {
    const std::uint64_t number = file_.index(node, "mesh", place);
    if (GltfFile::find(node, "skin") != nullptr)
      file_.fail(ErrorCode::kNotAMesh, place,
                 "a skin bends its mesh; apply it before you export the mesh");
    const Json& mesh = file_.element("meshes", number);
    const Json* primitives = GltfFile::find(mesh, "primitives");
    if (primitives == nullptr || !primitives->is_array()) return;
    for (std::size_t i = 0; i < primitives->size(); ++i) {
      const std::string part = fmt::format("{}, mesh {}, primitive {}", place, number, i);
      place_primitive((*primitives)[i], transform, part);
    }
  }

  void place_primitive(const Json& primitive, const Eigen::Affine3d& transform,
                       const std::string& place) {
    if (GltfFile::find(primitive, "targets") != nullptr)
      file_.fail(ErrorCode::kNotAMesh, place,
                 "morph targets move its vertices; apply them before you export the mesh");
    const Json* attributes = GltfFile::find(primitive, "attributes");
    if (attributes == nullptr || GltfFile::find(*attributes, "POSITION") == nullptr) return;
    const GltfAccessor points = file_.accessor(file_.index(*attributes, "POSITION", place));
    if (points.type != "VEC3" || points.component != kFloat)
      file_.fail(ErrorCode::kNotAMesh, place, "its positions are no floats; export the mesh again");
    placed_.expect(points.count, place);
    const std::uint64_t mode = file_.index_or(primitive, "mode", kTriangles, place);
    std::vector<std::uint32_t> corners;
    if (mode >= kTriangles && mode <= kFan) corners = corners_of(primitive, points.count, place);
    TriangleMesh mesh;
    mesh.vertices.reserve(points.count);
    for (std::size_t i = 0; i < points.count; ++i) {
      std::array<float, 3> point;
      std::memcpy(point.data(), points.first + i * points.stride, sizeof point);
      mesh.vertices.emplace_back(point[0], point[1], point[2]);
    }
    if (mode == kTriangles && corners.size() % 3 != 0)
      file_.fail(
          ErrorCode::kNotAMesh, place,
          fmt::format("{} corners are no whole triangles; export the mesh again", corners.size()));
    for (std::size_t i = 0; i + 2 < corners.size(); i += mode == kTriangles ? 3 : 1) {
      // Every other triangle of a strip is wound the other way.
      const std::size_t odd = mode == kStrip ? i % 2 : 0;
      mesh.triangles.push_back(
          {corners[mode == kFan ? 0 : i], corners[i + 1 + odd], corners[i + 2 - odd]});
    }
    placed_.add(mesh, transform, place);
  }

  std::vector<std::uint32_t> corners_of(const Json& primitive, std::size_t points,
                                        const std::string& place) {
    std::vector<std::uint32_t> corners;
    if (GltfFile::find(primitive, "indices") == nullptr) {
      for (std::size_t i = 0; i < points; ++i) corners.push_back(static_cast<std::uint32_t>(i));
      return corners;
    }
    const GltfAccessor indices = file_.accessor(file_.index(primitive, "indices", place));
    const std::size_t bytes = indices.component == kUnsignedByte    ? 1
                              : indices.component == kUnsignedShort ? 2
                              : indices.component == kUnsignedInt   ? 4
                                                                    : 0;
    if (indices.type != "SCALAR" || bytes == 0)
      file_.fail(ErrorCode::kNotAMesh, place,
                 "its indices are no whole numbers; export the mesh again");
    placed_.expect(indices.count, place);
    corners.reserve(indices.count);
    for (std::size_t i = 0; i < indices.count; ++i) {
      std::uint32_t corner = 0;
      std::memcpy(&corner, indices.first + i * indices.stride, bytes);
      if (corner >= points)
        file_.fail(ErrorCode::kMeshBadIndex, place,
                   fmt::format("corner {} is vertex {}, but there are {}, counted from 0; export "
                               "the mesh again",
                               i, corner, points));
      corners.push_back(corner);
    }
    return corners;
  }

  GltfFile file_;
  PlacedMeshes placed_;
};

}  // namespace

TriangleMesh read_gltf(std::string_view content, std::string_view file) {
  return GltfReader(content, file).read();
}

}  // namespace ist
