#include <fmt/format.h>

#include "ist/mesh/format/text_reader.h"
#include "ist/mesh/import/import_message.h"
#include "ist/mesh/import/imported_mesh.h"

namespace ist {

// For platforms without processes.
TriangleMesh read_imported(std::string_view, const std::filesystem::path& file) {
  fail_mesh(ErrorCode::kNotAMesh, file.string(), "",
            fmt::format("its format is read by the program ist-import, which does not run on this "
                        "platform; {}",
                        kConvert));
}

std::string_view readable_formats() { return "STL, PLY, OBJ, OFF or VTK PolyData"; }

}  // namespace ist
