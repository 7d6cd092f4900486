// glTF 2.0 by ist-import: scenes, and every field that may be wrong.

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "import/scene_files.h"
#include "ist/base/error.h"
#include "ist/mesh/mesh.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/mesh_files.h"
#include "support/shapes.h"
#include "support/temp_dir.h"

namespace ist {
namespace {

using test::corners;
using test::replaced;

// A triangle with distinct coordinates, all of them floats.
const TriangleMesh kOne = test::triangle({1, 0, 0}, {0, 2, 0}, {0, 0, 3});
const std::string kPlain = test::as_gltf(kOne);

TriangleMesh read_gltf_bytes(std::string_view bytes) {
  const test::TempDir folder;
  return read_mesh(folder.write("mesh.gltf", bytes));
}

std::string refusal(std::string_view bytes) {
  const test::TempDir folder;
  const auto file = folder.write("mesh.gltf", bytes);
  const auto error = test::error_of([&] { static_cast<void>(read_mesh(file)); });
  if (!error) return "fine";
  const std::string text = error->what(), name = file.string() + ": ";
  EXPECT_TRUE(text.starts_with(name)) << text;
  return std::string(to_string(error->code())) + ": " + text.substr(name.size());
}

std::string with(const std::string& from, const std::string& to) {
  const std::string changed = replaced(kPlain, from, to);
  EXPECT_NE(changed, kPlain) << from;
  return changed;
}

TEST(Gltf, NodesPlaceTheirMeshes) {
  const std::string nodes =
      R"("nodes":[{"children":[2,1],"translation":[10,0,0]},)"
      R"({"mesh":0,"scale":[2,2,2],"rotation":[0,0,0.7071067811865476,0.7071067811865476]},)"
      R"({"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,5,1]}])";
  const TriangleMesh mesh = read_gltf_bytes(with(R"("nodes":[{"mesh":0}])", nodes));
  ASSERT_EQ(mesh.triangles.size(), 2u);
  const auto got = corners(mesh);
  EXPECT_EQ(got[0], (std::array<double, 9>{11, 0, 5, 10, 2, 5, 10, 0, 8}));
  const std::array<double, 9> turned{10, 2, 0, 6, 0, 0, 10, 0, 6};
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_NEAR(got[1][i], turned[i], 1e-6)  // transforms are floats
        << i;
}

// A turn of 90 degrees about z, as exporters round it, in a text and in a GLB. It would scale.
TEST(Gltf, ARotationNeverScales) {
  const std::array<double, 9> turned{0, 1, 0, -2, 0, 0, 0, 0, 3};
  const auto rotated = [](const std::string& text, const std::string& half) {
    return replaced(text, R"({"mesh":0})",
                    R"({"mesh":0,"rotation":[0,0,)" + half + "," + half + "]}");
  };
  for (const char* half : {"0.707", "0.7071", "0.707107", "0.70710678"}) {
    for (const std::string& bytes :
         {rotated(kPlain, half),
          test::as_glb(rotated(test::gltf_json(kOne, ""), half), test::gltf_buffer(kOne))}) {
      const auto got = corners(read_gltf_bytes(bytes));
      for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(got.at(0)[i], turned[i], 3e-7) << half << i;
    }
  }
  const std::pair<const char*, const char*> refused[] = {
      {"[0,0,0.9,0.9]", "1.27279"}, {"[0,0,0.71,0.71]", "1.00409"}, {"[0,0,0,0]", "0"},
      {"[0,0,0,1.002]", "1.002"},   {"[0,0,0,0.998]", "0.998"},     {"[0,0,1e200,0]", "inf"}};
  for (const auto& [rotation, length] : refused)
    EXPECT_EQ(
        refusal(with(R"({"mesh":0})", std::string(R"({"mesh":0,"rotation":)") + rotation + "}")),
        std::string("not-a-mesh: node 0: its rotation has the length ") + length +
            ", not 1; apply it before you export the mesh");
}

TEST(Gltf, AMirroredMeshKeepsItsOuterSide) {
  const TriangleMesh ball = test::icosphere(2, 1);
  const std::string plain = test::as_gltf(ball);
  for (const char* scale : {"[-1,1,1]", "[1,1,1]", "[-1,-1,1]", "[-2,-2,-2]"}) {
    const TriangleMesh mesh = read_gltf_bytes(
        replaced(plain, R"({"mesh":0})", std::string(R"({"mesh":0,"scale":)") + scale + "}"));
    EXPECT_GT(check_mesh(mesh).signed_volume, 4) << scale;
    EXPECT_TRUE(check_mesh(mesh).closed) << scale;
  }
}

TEST(Gltf, WeldsMeshesThatMeet) {
  const TriangleMesh mesh =
      read_gltf_bytes(replaced(replaced(kPlain, R"("nodes":[0])", R"("nodes":[0,1])"),
                               R"([{"mesh":0}])", R"([{"mesh":0},{"mesh":0,"scale":[1,1,-1]}])"));
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 3, 1}}));
}

TEST(Gltf, ReadsStripsFansAndPlainCorners) {
  const TriangleMesh quad{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {2, 1, 3}}};
  const auto primitive = [&](const std::string& to) {
    return read_gltf_bytes(replaced(test::as_gltf(quad), "\"indices\":1}", to)).triangles;
  };
  EXPECT_EQ(primitive("\"indices\":1}"), quad.triangles);
  EXPECT_EQ(primitive("\"mode\":5}"), (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}}));
  EXPECT_EQ(primitive("\"mode\":6}"), (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(primitive("\"indices\":1},{\"attributes\":{\"POSITION\":0},\"mode\":1}"),
            quad.triangles);
}

TEST(Gltf, ReadsNarrowIndicesAndInterleavedVertices) {
  std::string chunk;
  for (const Eigen::Vector3d& vertex : kOne.vertices) {
    const std::array<float, 3> point{static_cast<float>(vertex.x()), static_cast<float>(vertex.y()),
                                     static_cast<float>(vertex.z())};
    chunk.append(reinterpret_cast<const char*>(point.data()), sizeof point);
    chunk += "COLR";
  }
  for (const auto& [type, bytes] : {std::pair{"5121", std::string("\0\1\2", 3)},
                                    std::pair{"5123", std::string("\0\0\1\0\2\0", 6)}}) {
    std::string json = replaced(test::gltf_json(kOne, ""), "5125", type);
    json = replaced(json, R"("byteLength":36})", R"("byteLength":48,"byteStride":16})");
    json = replaced(json, R"("byteOffset":36,"byteLength":12)",
                    R"("byteOffset":48,"byteLength":)" + std::to_string(bytes.size()));
    json = replaced(json, R"([{"byteLength":48}])",
                    R"([{"byteLength":)" + std::to_string(48 + bytes.size()) + "}]");
    EXPECT_EQ(corners(read_gltf_bytes(test::as_glb(json, chunk + bytes))), corners(kOne)) << type;
  }
}

// A remedy for what is not read, and a place for what is wrong.
TEST(Gltf, RefusesWhatItCannotRead) {
  const std::string uri = "data:application/octet-stream;base64,";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"file-unreadable: it names the file 'jaw.bin', which is not in its folder or below: copy it "
       "there, or export one file that holds all",
       test::gltf_json(kOne, "jaw.bin")},
      {"not-a-mesh: it cannot be read (GLTF: buffer", with(uri, "data:application/octet-stream,")},
      {"not-a-mesh: it cannot be read (Invalid base64", with(uri, uri + "*")},
      {"not-a-mesh: it cannot be read (GLTF: buffer", test::gltf_json(kOne, "")},
      {"not-a-mesh: it cannot be read (GLTF: buffer",
       with(R"([{"byteLength":48)", R"([{"byteLength":49)")},
      {"not-a-mesh: extensionsRequired: KHR_draco_mesh_compression is not supported",
       with("{\"asset\"", R"({"extensionsRequired":["KHR_draco_mesh_compression"],"asset")")},
      {"not-a-mesh: asset: glTF 1.0 is not supported", with("\"2.0\"", "\"1.0\"")},
      {"not-a-mesh: the JSON is no glTF", "{\"a\":1}"},
      {"not-a-mesh: asset: glTF 2.1 is not supported",
       with("\"2.0\"", R"("2.0","minVersion":"2.1")")},
      {"not-a-mesh: extensionsRequired: KHR_mesh_quantization",
       with("{\"asset\"",
            R"({"extensionsRequired":["KHR_materials_unlit","KHR_mesh_quantization"],"asset")")},
      {"not-a-mesh: node 0: an extension repeats",
       with(R"({"mesh":0})", R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{}}})")},
      {"not-a-mesh: byte 3 of the JSON: the text is no JSON", "{ ]"},
      {"mesh-truncated: byte", kPlain.substr(0, 100)},
      {"mesh-truncated: byte", "{"},
      {"mesh-empty: the glTF has no scene", with("\"scenes\"", "\"scene_\"")},
      {"mesh-empty: the scene has no mesh", with(R"("nodes":[0])", R"("nodes":[])")},
      {"mesh-points-only: the scene has 3 vertices", with("\"indices\":1", "\"mode\":0")},
      {"mesh-bad-index: scenes: element 1 is named, but there are 1",
       with("\"scene\":0", "\"scene\":1")},
      {"mesh-bad-index: nodes: element 7", with(R"("nodes":[0])", R"("nodes":[7])")},
      {"not-a-mesh: nodes: a number of a node is no whole number",
       with(R"("nodes":[0])", R"("nodes":[-1])")},
      {"not-a-mesh: nodes: a number of a node is no whole number",
       with(R"("nodes":[0])", R"("nodes":[0.5])")},
      {"mesh-bad-index: meshes: element 1", with(R"({"mesh":0})", R"({"mesh":1})")},
      {"not-a-mesh: node 0: it is the child of several nodes, or of itself",
       with(R"({"mesh":0})", R"({"mesh":0,"children":[0]})")},
      {"not-a-mesh: node 0: it is the child", with(R"("nodes":[0])", R"("nodes":[0,0])")},
      {"not-a-mesh: node 0: a skin bends", with(R"({"mesh":0})", R"({"mesh":0,"skin":0})")},
      {"not-a-mesh: node 0, mesh 0, primitive 0: morph targets",
       with("\"indices\":1", R"("indices":1,"targets":[{}])")},
      {"not-a-mesh: node 0: 'scale' is not 3 numbers",
       with(R"({"mesh":0})", R"({"mesh":0,"scale":[1,"x",1]})")},
      {"not-a-mesh: node 0: 'matrix' is not 16 numbers",
       with(R"({"mesh":0})", R"({"mesh":0,"matrix":[1]})")},
      {"not-a-mesh: node 'nodes[0]': its matrix is not affine",
       with(R"({"mesh":0})", R"({"mesh":0,"matrix":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]})")},
      {"mesh-not-finite: node 'nodes[0]', mesh 0: vertex 0 is not finite",
       with(R"({"mesh":0})", R"({"mesh":0,"scale":[3e38,3e38,3e38],"translation":[3e38,0,0]})")},
      {"not-a-mesh: accessor 0: it is sparse", with("5126,", "5126,\"sparse\":{},")},
      {"not-a-mesh: accessor 0: it is sparse", with(R"("bufferView":0,)", "")},
      {"not-a-mesh: accessor 0: its type", with("VEC3", "MAT4")},
      {"not-a-mesh: accessor 1: its type", with("5125", "9")},
      {"not-a-mesh: node 0, mesh 0, primitive 0: its positions are no floats",
       with("5126", "5122")},
      {"not-a-mesh: node 0, mesh 0, primitive 0: its indices are no whole numbers",
       with("5125", "5126")},
      {"not-a-mesh: node 0, mesh 0, primitive 0: 2 corners are no whole triangles",
       with("SCALAR\",\"count\":3", "SCALAR\",\"count\":2")},
      {"mesh-bad-index: accessor 0: its 4 elements are not within the 36 bytes of its buffer view",
       with("VEC3\",\"count\":3", "VEC3\",\"count\":4")},
      {"mesh-bad-index: accessor 0: its 18446744073709551615 elements",
       with("VEC3\",\"count\":3", "VEC3\",\"count\":18446744073709551615")},
      {"mesh-bad-index: accessor 0: its 3 elements", with("VEC3\",", "VEC3\",\"byteOffset\":4,")},
      {"mesh-bad-index: accessor 0: its 3 elements",
       with("VEC3\",", "VEC3\",\"byteOffset\":18446744073709551614,")},
      {"mesh-bad-index: it cannot be read (GLTF: Buffer view",
       with("\"byteOffset\":36", "\"byteOffset\":40")},
      {"mesh-bad-index: accessor 0: its 3 elements",
       with("\"byteLength\":36}", "\"byteLength\":36,\"byteStride\":11}")},
      {"mesh-bad-index: accessor 0: its 3 elements",
       with("\"byteLength\":36}", "\"byteLength\":36,\"byteStride\":9223372036854775808}")},
      {"mesh-bad-index: bufferViews: element 5", with("\"bufferView\":1", "\"bufferView\":5")},
  };
  for (const auto& [expected, bytes] : cases) {
    const std::string got = refusal(bytes);
    EXPECT_TRUE(got.starts_with(expected)) << got << "\nfor " << expected;
  }
}

TEST(Gltf, RefusesAnIndexOutOfRange) {
  TriangleMesh mesh = kOne;
  mesh.triangles[0][2] = 9;
  EXPECT_TRUE(refusal(test::as_glb(mesh)).starts_with("mesh-bad-index: it cannot be read ("));
  mesh = test::box({0, 0, 0}, {1, 1, 1});
  mesh.triangles[5][2] = 9;  // assimp leaves this triangle out
  EXPECT_TRUE(refusal(test::as_glb(mesh)).starts_with("mesh-bad-index: a part of it"));
}

TEST(Gltf, RefusesAVertexThatIsNotFinite) {
  TriangleMesh mesh = kOne;
  mesh.vertices[1].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refusal(test::as_glb(mesh))
                  .starts_with("mesh-not-finite: node 'nodes[0]', mesh 0: vertex 1"));
}

// A file of some kilobytes that places one mesh so often that no memory would do.
TEST(Gltf, RefusesAMeshThatIsPlacedTooOften) {
  IST_SLOW();
  const TriangleMesh ball = test::icosphere(5, 1);
  std::string roots, nodes;
  for (int i = 0; i < 500; ++i) {
    roots += (i > 0 ? "," : "") + std::to_string(i);
    nodes += std::string(i > 0 ? "," : "") + R"({"mesh":0})";
  }
  const std::string bytes =
      replaced(replaced(test::as_gltf(ball), R"("nodes":[0])", "\"nodes\":[" + roots + "]"),
               R"([{"mesh":0}])", "[" + nodes + "]");
  EXPECT_TRUE(refusal(bytes).starts_with("mesh-too-large: node ")) << refusal(bytes);
}

// assimp parses JSON and makes nodes by recursion: its process may end by a signal.
TEST(Gltf, NestingEndsTheImporterAlone) {
  const std::string deep(1'000'000, '[');
  EXPECT_TRUE(
      refusal("{\"asset\":{\"version\":\"2.0\"},\"a\":" + deep).starts_with("mesh-truncated"));
  std::string nodes = R"({"children":[1]})";
  constexpr int kDepth = 200'000;
  for (int i = 2; i <= kDepth; ++i) nodes += ",{\"children\":[" + std::to_string(i) + "]}";
  const std::string got = refusal(with(R"([{"mesh":0}])", "[" + nodes + R"(,{"mesh":0}])"));
  EXPECT_TRUE(got == "fine" || test::says_crash(got)) << got;
}

TEST(Gltf, RefusesAGlbOfWrongChunks) {
  const std::string glb = test::as_glb(kOne);
  std::string version = glb, no_json = glb;
  version[4] = 1;
  no_json[16] = 'X';
  EXPECT_TRUE(refusal(version).starts_with("not-a-mesh: byte 4: GLB version 1"));
  EXPECT_TRUE(refusal(no_json).starts_with("not-a-mesh: byte 12: the first chunk is no JSON"));
  EXPECT_TRUE(refusal(glb.substr(0, glb.size() - 1)).starts_with("mesh-truncated: byte "));
}

// Extensions of looks touch no geometry.
TEST(Gltf, ReadsWhatRequiresLooks) {
  const std::string plain =
      with("{\"asset\"",
           R"({"extensionsRequired":["KHR_materials_unlit","KHR_texture_transform"],"asset")");
  EXPECT_EQ(corners(read_gltf_bytes(plain)), corners(kOne));
}

TEST(Gltf, IsInMetres) { EXPECT_EQ(read_gltf_bytes(kPlain).unit, LengthUnit::kMetre); }

}  // namespace
}  // namespace ist
