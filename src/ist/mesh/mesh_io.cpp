#include <fmt/format.h>

#include <Eigen/Geometry>

#include "ist/base/files.h"
#include "ist/base/float_environment.h"
#include "ist/mesh/bounding_box.h"
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

}  // namespace ist
