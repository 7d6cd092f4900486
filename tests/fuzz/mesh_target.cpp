// A mesh file: the first byte says what its name ends with (s: .stl, o: .obj, f: .off, else
// nothing), and whether a tree is built of it (t); the rest is its content.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>

#include "fuzz/fuzz_target.h"
#include "fuzz/named_file.h"
#include "fuzz/query_checks.h"
#include "ist/base/error.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/sphere_tree.h"
#include "support/mesh_files.h"

namespace ist::test {
namespace {

double extent_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  return box.sizes().maxCoeff();
}

void require_sound(const TriangleMesh& mesh) {
  std::set<std::array<double, 3>> places;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    require(std::all_of(
                v.begin(), v.end(),
                [](double x) { return std::abs(x) <= double{std::numeric_limits<float>::max()}; }),
            "a vertex is beyond the range of a float");
    require(places.insert({v.x(), v.y(), v.z()}).second, "two vertices are in one place");
  }
  std::set<std::uint32_t> named;
  for (const Triangle& triangle : mesh.triangles) named.insert(triangle.begin(), triangle.end());
  require(!named.empty() && *named.rbegin() < mesh.vertices.size(),
          "a triangle names a vertex that is not there");
  require(named.size() == mesh.vertices.size(), "a vertex is in no triangle");
  const double extent = extent_of(mesh);
  require(extent >= 1e-12 && extent <= 1e15, "the extent is out of range");
}

void check_tree(const TriangleMesh& mesh) {
  BuildOptions options;
  options.voxel_size = extent_of(mesh) / 5;
  options.keep_triangles = options.proximity = true;
  const SphereTree tree = build_tree(mesh, options);
  QueryChecks checks(tree, tree, QueryChecks::Trees::kBuilt);
  require(checks.at(Eigen::Isometry3d::Identity()) == true, "a body does not touch itself");
}

}  // namespace

std::string fuzz_mesh(std::string_view bytes) {
  if (bytes.empty()) return "nothing";
  static const NamedFile file({"mesh", "mesh.stl", "mesh.obj", "mesh.off"});
  // The importer's formats are refused: import_target.cpp has its answers.
  static const int no_importer = ::setenv("IST_IMPORT", "/dev/null", 1);
  require(no_importer == 0, "the environment cannot be set");
  const char* name = bytes[0] == 's'   ? "mesh.stl"
                     : bytes[0] == 'o' ? "mesh.obj"
                     : bytes[0] == 'f' ? "mesh.off"
                                       : "mesh";
  TriangleMesh mesh;
  try {
    mesh = read_mesh(file.write(name, bytes.substr(1)));
  } catch (const Error& error) {
    const std::string_view text = error.what();
    require(text.find(name) != std::string_view::npos, "an error does not name the file");
    require(std::none_of(text.begin(), text.end(),
                         [](char c) {
                           const auto byte = static_cast<unsigned char>(c);
                           return byte < 0x20 || byte == 0x7F;
                         }),
            "an error holds a control character of the file");
    return to_string(error.code());
  }
  require_sound(mesh);
  const TriangleMesh again = read_mesh(file.write("mesh", as_obj(mesh)));
  require(corners(again) == corners(mesh), "a mesh does not come back from OBJ as it was");
  constexpr std::size_t kFew = 16;  // triangles, of which a tree is soon built
  if (bytes[0] == 't' && mesh.triangles.size() <= kFew) check_tree(mesh);
  return "fine";
}

}  // namespace ist::test
