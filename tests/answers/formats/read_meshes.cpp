// Reads meshes, and writes the corners of each beside it, in FILE.corners: nine doubles a triangle,
// for written_by_vtk.py. Prints the frame that each file names.

#include <cstdio>
#include <fstream>
#include <string>

#include "ist/mesh/format/frame_tags.h"
#include "ist/mesh/mesh.h"
#include "support/mesh_files.h"

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string file = argv[i];
    const ist::TriangleMesh mesh = ist::read_mesh(file);
    const auto corners = ist::test::corners(mesh);
    std::ofstream(file + ".corners", std::ios::binary)
        .write(reinterpret_cast<const char*>(corners.data()),
               static_cast<std::streamsize>(corners.size() * sizeof corners[0]));
    std::puts(std::string(ist::slicer_name(mesh.frame)).c_str());
  }
}
