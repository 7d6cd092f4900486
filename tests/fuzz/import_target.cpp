// An answer of ist-import, as read_imported() takes it from a process.

#include <algorithm>
#include <cmath>
#include <limits>

#include "fuzz/fuzz_target.h"
#include "ist/base/error.h"
#include "ist/mesh/import/import_message.h"

namespace ist::test {

std::string fuzz_import(std::string_view bytes) {
  TriangleMesh mesh;
  try {
    mesh = read_import_message(bytes, "/opt/ist-import", "jaw.glb");
  } catch (const Error& error) {
    const std::string_view text = error.what();
    require(text.starts_with("jaw.glb: "), "an error does not name the file");
    require(std::none_of(text.begin(), text.end(),
                         [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }),
            "an error holds a control character");
    return to_string(error.code());
  }
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle)
      require(corner < mesh.vertices.size(), "a triangle names a vertex that is not there");
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    require(vertex.cwiseAbs().maxCoeff() <= double{std::numeric_limits<float>::max()},
            "a vertex is beyond the range of a float");
  require(!to_string(mesh.unit).empty() && !to_string(mesh.frame).empty(), "a number is no name");
  return "fine";
}

}  // namespace ist::test
