// STL, PLY, OBJ, OFF and glTF as assimp reads them, beside read_mesh(). Both give the same
// triangles for plain files; where they do not, assimp 5.2 is wrong, and the tests say how.

#include <assimp/scene.h>
#include <assimp/version.h>
#include <gtest/gtest.h>

#include <array>
#include <assimp/Importer.hpp>
#include <bit>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "ist/base/error.h"
#include "ist/mesh/mesh.h"
#include "support/data_dir.h"
#include "support/mesh_files.h"
#include "support/shapes.h"
#include "support/skip.h"
#include "support/temp_dir.h"

namespace ist {
namespace {

using test::corners;
using test::narrowed;
using Facets = std::vector<std::array<double, 9>>;  // corners of each triangle, as floats

// The triangles of a file by assimp; none where it refuses the file. Faces that are no triangles
// are left out; a corner that is no vertex is at infinity.
std::optional<Facets> assimp_reads(std::string_view bytes, const char* format) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, format);
  if (scene == nullptr) return {};
  Facets all;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;
      auto& facet = all.emplace_back();
      for (unsigned i = 0; i < 9; ++i) {
        const unsigned corner = face.mIndices[i / 3];
        facet[i] = corner < mesh.mNumVertices ? double{mesh.mVertices[corner][i % 3]} + 0.0
                                              : std::numeric_limits<double>::infinity();
      }
    }
  }
  return all;
}

// The same by read_mesh(), rounded to float as assimp's are.
std::optional<Facets> we_read(std::string_view bytes) {
  const test::TempDir folder;
  try {
    return corners(narrowed(read_mesh(folder.write("mesh", bytes))));
  } catch (const Error&) {
    return {};
  }
}

bool is_known_assimp() { return aiGetVersionMajor() == 5 && aiGetVersionMinor() == 2; }

void expect_alike(const TriangleMesh& mesh) {
  for (const auto& [name, bytes] : test::all_formats(mesh)) {
    const char* format = name.find("STL") != name.npos    ? "stl"
                         : name.find("PLY") != name.npos  ? "ply"
                         : name.find("OFF") != name.npos  ? "off"
                         : name.find("glTF") != name.npos ? "gltf"
                         : name.find("GLB") != name.npos  ? "glb"
                                                          : "obj";
    const auto ours = we_read(bytes);
    EXPECT_TRUE(ours && ours == assimp_reads(bytes, format)) << name;
  }
}

TEST(AssimpDifference, IsNoneForPlainFiles) {
  expect_alike(test::box({-1, 0.5, 2}, {0.5, 1.25, 3}));
  expect_alike(test::icosphere(3, 1));
}

TEST(AssimpDifference, IsNoneForRealFiles) {
  if (!std::filesystem::is_directory(test::data_dir()))
    IST_SKIP("no folder of real meshes at " << test::data_dir());
  for (const char* name : {"human_mandible.stl", "human_maxilla.stl", "spl_cranium_face.stl",
                           "dirty/dragon_res3.stl", "bad_input/Wuson.stl"}) {
    const std::string bytes = test::file_content(test::data_dir() / name);
    const auto ours = we_read(bytes);
    EXPECT_TRUE(ours && ours == assimp_reads(bytes, "stl")) << name;
  }
}

// assimp 5.2 keeps 15 decimals of a number and rounds it twice: one in fifteen is another float.
TEST(AssimpDifference, IsInTheLastBitOfNumbersInText) {
  const auto file = test::data_dir() / "bad_input/Spider_ascii.stl";
  if (!std::filesystem::is_regular_file(file)) IST_SKIP("no " << file);
  const std::string text = test::file_content(file);
  std::vector<double> right;  // as the C library rounds them
  std::istringstream words(text);
  for (std::string word; words >> word;)
    for (int i = 0; word == "vertex" && i < 3; ++i) {
      std::string number;
      words >> number;
      right.push_back(double{std::strtof(number.c_str(), nullptr)} + 0.0);
    }
  const auto wrong_of = [&right](const Facets& facets) {
    EXPECT_EQ(9 * facets.size(), right.size());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < right.size(); ++i) wrong += facets[i / 9][i % 9] != right[i];
    return wrong;
  };
  EXPECT_EQ(wrong_of(we_read(text).value()), 0u);
  if (is_known_assimp()) {
    EXPECT_EQ(wrong_of(assimp_reads(text, "stl").value()), 843u);
  }
}

struct Hard {
  const char* how;
  const char* format;
  std::string bytes;
  Facets right;  // none for a file that must be refused
};

std::string ply(const std::string& points, const std::string& faces, int count = 3) {
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
         "property list uchar int vertex_indices\nend_header\n" +
         points + faces;
}

// An STL in capitals is missing here: assimp refuses it and leaks.
std::vector<Hard> misread_files() {
  const Facets plain = {{0, 0, 0, 1, 0, 0, 0, 1, 0}};
  const std::string two = "v 1 0 0\nv 0 1 0\n", three = "v 0 0 0\n" + two;
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  TriangleMesh line_end = test::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const std::string stl = test::as_text_stl(line_end);
  line_end.vertices[0].x() = double{std::bit_cast<float>(0x3F80000Au)};
  TriangleMesh cut = test::box({0, 0, 0}, {1, 1, 1});
  cut.triangles[5][2] = 9;
  return {
      {"a number of 28 decimals is 0",
       "obj",
       "v 0.00000000000000000000012345678e20 0 0\n" + two + "f 1 2 3\n",
       {{0.012345678F, 0, 0, 1, 0, 0, 0, 1, 0}}},
      {"a number of 30 digits overflows",
       "obj",
       "v 123456789012345678901234567890e-27 0 0\n" + two + "f 1 2 3\n",
       {{123.456789012345F, 0, 0, 1, 0, 0, 0, 1, 0}}},
      {"an indented line is skipped", "obj", " v 0 0 0\n v 1 0 0\n v 0 1 0\n f 1 2 3\n", plain},
      {"a comment behind a face is refused", "obj", three + "f 1 2 3 # one\n", plain},
      {"NaN is accepted", "obj", "v nan 0 0\n" + two + "f 1 2 3\n", {}},
      {"a face of two corners is accepted", "obj", three + "f 1 2\nf 1 2 3\n", {}},
      {"a first byte of 0x0A is taken for a line end", "ply", test::as_binary_ply(line_end, false),
       corners(line_end)},
      {"an index out of range is accepted", "ply", ply(points, "3 0 1 3\n"), {}},
      {"a negative index is accepted", "ply", ply(points, "3 0 1 -1\n"), {}},
      {"a file without its last vertex is accepted", "ply", ply(points, "3 0 1 2\n", 4), {}},
      {"a face that the header does not count is accepted",
       "ply",
       ply(points, "3 0 1 2\n3 0 1 2\n"),
       {}},
      {"NaN is accepted", "ply", ply("nan 0 0\n1 0 0\n0 1 0\n", "3 0 1 2\n"), {}},
      {"a face with an index out of range is left out", "gltf", test::as_gltf(cut), {}},
      {"vertices of bytes are taken for floats",
       "gltf",
       test::replaced(test::as_gltf(line_end), "5126", "5120"),
       {}},
      {"an index out of range is the last vertex", "off", off + "3 0 1 9\n", {}},
      {"a file without its last vertex is accepted", "off", test::replaced(off, "3 1", "4 1"), {}},
      {"NaN is accepted", "off", test::replaced(off, "1 0 0", "nan 0 0") + "3 0 1 2\n", {}},
      {"a cut file is accepted", "stl", stl.substr(0, stl.find("endloop")), {}},
      {"a comma is taken for a point",
       "stl",
       test::replaced(stl, "vertex 1 0 0", "vertex 1,5 0 0"),
       {}},
      {"NaN is accepted", "stl", test::replaced(stl, "vertex 1 0 0", "vertex nan 0 0"), {}},
  };
}

TEST(AssimpDifference, IsAssimpsErrorWhereThereIsOne) {
  for (const auto& [how, format, bytes, right] : misread_files()) {
    const auto ours = we_read(bytes);
    EXPECT_EQ(ours.value_or(Facets()), right) << format << ": " << how;
    EXPECT_EQ(ours.has_value(), !right.empty()) << format << ": " << how;
    if (is_known_assimp()) {
      EXPECT_NE(assimp_reads(bytes, format), ours) << format << ": " << how;
    }
  }
}

}  // namespace
}  // namespace ist
