#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "ist/base/assert.h"
#include "ist/base/files.h"
#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/mesh/bounding_box.h"
#include "ist/mesh/format/frame_tags.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/format/text_reader.h"
#include "ist/mesh/mesh.h"

namespace ist {
namespace {

void check_extent(const TriangleMesh& mesh, const std::string& file) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  if (has_usable_extent(box)) return;
  fail_mesh(ErrorCode::kMeshExtent, file, "",
            fmt::format("the largest extent is {:g} units, outside [1e-12, 1e+15]; scale the mesh",
                        box.sizes().maxCoeff()));
}

// Returns the unit normal, or zero for a triangle without area, as is usual in STL.
std::array<float, 3> unit_normal(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                 const Eigen::Vector3d& c) {
  Eigen::Vector3d u = b - a, v = c - a;
  // Scaled first, so that the squares of tiny and of huge triangles stay in range.
  const double longest = std::max(u.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff());
  if (!(longest > 0)) return {};
  u /= longest;
  v /= longest;
  const Eigen::Vector3d normal = u.cross(v);
  const double length = length_in_order(normal);
  if (!(length > 0)) return {};
  return {static_cast<float>(normal.x() / length), static_cast<float>(normal.y() / length),
          static_cast<float>(normal.z() / length)};
}

}  // namespace

void turn_into(TriangleMesh& mesh, PatientFrame frame) {
  if (!contradict(mesh.frame, frame)) return;
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = {-vertex.x(), -vertex.y(), vertex.z()};
  mesh.frame = frame;
}

TriangleMesh read_mesh(const std::filesystem::path& file) {
  const ScopedFloatEnvironment environment;  // parsing numbers rounds as well
  TriangleMesh mesh = read_content(InputFile(file).read_rest(), file);
  check_extent(mesh, file.string());
  return mesh;
}

void write_stl(const TriangleMesh& mesh, const std::filesystem::path& file) {
  const ScopedFloatEnvironment environment;
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max())
    fail_mesh(ErrorCode::kFileUnwritable, file.string(), "",
              "an STL holds at most 2^32 - 1 triangles; write the mesh in parts");
  std::string bytes(kStlCountEnd + kStlFacetBytes * mesh.triangles.size(), '\0');
  if (mesh.frame != PatientFrame::kUnknown) {
    const std::string tag = fmt::format("SPACE={}", slicer_name(mesh.frame));
    std::copy(tag.begin(), tag.end(), bytes.begin());
  }
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::memcpy(bytes.data() + kStlHeaderBytes, &count, sizeof count);
  char* facet = bytes.data() + kStlCountEnd;
  for (const Triangle& triangle : mesh.triangles) {
    std::array<Eigen::Vector3d, 3> corners;
    std::array<float, 9> narrowed{};
    for (std::size_t i = 0; i < 9; ++i) {
      IST_ASSERT(triangle[i / 3] < mesh.vertices.size());
      corners[i / 3] = mesh.vertices[triangle[i / 3]];
      narrowed[i] = static_cast<float>(corners[i / 3][static_cast<Eigen::Index>(i % 3)]);
      if (!std::isfinite(narrowed[i]))
        fail_mesh(ErrorCode::kMeshNotFinite, file.string(), "",
                  fmt::format("vertex {} is not finite as a float, and an STL holds floats; scale "
                              "the mesh",
                              triangle[i / 3]));
    }
    const std::array<float, 3> normal = unit_normal(corners[0], corners[1], corners[2]);
    std::memcpy(facet, normal.data(), sizeof normal);
    std::memcpy(facet + kStlNormalBytes, narrowed.data(), sizeof narrowed);
    facet += kStlFacetBytes;
  }
  OutputFile output(file);
  output.write(bytes.data(), bytes.size());
  output.commit();
}

}  // namespace ist
