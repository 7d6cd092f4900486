// Do two jaws touch, and how far apart are they? hello.c and hello.py print the same lines.
#include <ist/ist.h>
#include <ist/models/models.h>

#include <cstdio>
#include <exception>

int main() try {
  // make_jaw() makes a built-in jaw. read_mesh("scan.stl") reads a mesh of your own.
  const ist::TriangleMesh upper_mesh = ist::make_jaw(ist::Jaw::kUpper, 1);
  const ist::TriangleMesh lower_mesh = ist::make_jaw(ist::Jaw::kLower, 1);

  // A tree is a mesh made ready for queries. Lengths are in the unit of the mesh, here mm.
  const ist::SphereTree upper = ist::build_tree(upper_mesh);
  const ist::SphereTree lower = ist::build_tree(lower_mesh);

  // A query belongs to one thread. Several queries may share a tree.
  ist::Query query(upper, lower);

  for (const double down : {1.0, 1.5}) {
    // The pose maps points of the lower jaw to the coordinates of the upper jaw.
    const Eigen::Isometry3d pose(Eigen::Translation3d(0, 0, -down));

    // Touch is exact. The distance lies between two ends, which are at most 0.001 mm apart.
    const ist::IntersectionResult touch = query.intersects(pose);
    const ist::DistanceResult gap = query.distance(pose, 0.001);
    std::printf("lower jaw down by %.1f mm: touch %s, %.3f to %.3f mm apart\n", down,
                to_string(touch.answer), gap.distance.lower, gap.distance.upper);
  }
} catch (const std::exception& error) {
  // The text of an ist::Error names the place, the cause and the remedy.
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
