// What threemf_reader.cpp does, in a build without zlib.

#include "ist/base/error.h"
#include "ist/mesh/format/mesh_readers.h"

namespace ist {

TriangleMesh read_3mf(std::string_view, std::string_view file) {
  throw Error(ErrorCode::kNotAMesh,
              std::string(file) +
                  ": it is a 3MF, or another zip archive, and this build has no zlib to unpack it: "
                  "convert the mesh to STL, PLY, OBJ, OFF or glTF");
}

}  // namespace ist
