// Prints the triangles of a mesh in the order of the library's clusters, one index a line: the
// oracle of the order by which scripts/pictures/how/triangle_order.py draws them.
#include <fmt/format.h>

#include "ist/mesh/clusters/triangle_clusters.h"
#include "ist/mesh/mesh.h"

int main(int, char** argv) {
  const ist::TriangleClusters clusters(ist::read_mesh(argv[1]), {0, 0, 0});
  for (std::uint32_t i = 0; i < clusters.clusters().size(); ++i) {
    for (std::uint32_t k = 0; k < clusters.child_count(-1, i); ++k) {
      fmt::print("{}\n", clusters.clusters()[i].id[k]);
    }
  }
}
