#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "ist/base/cancellation.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/mesh.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/mesh_files.h"
#include "support/shapes.h"
#include "support/temp_dir.h"

namespace ist {
namespace {

using test::all_formats;
using test::corners;
using test::narrowed;
using test::replaced;
using test::TempDir;

const TriangleMesh kBox = test::box({-1, 0.1, 2}, {0.5, 1.25, 3});

TriangleMesh read_bytes(std::string_view bytes, std::string_view name = "mesh") {
  const TempDir folder;
  return read_mesh(folder.write(name, bytes));
}

TEST(ReadMesh, TellsTheFormatByTheContent) {
  for (const auto& [name, bytes] : all_formats(kBox)) {
    for (const char* file : {"mesh", "mesh.stl", "mesh.obj", "mesh.ply", "mesh.off", "mesh.glb"}) {
      const TriangleMesh mesh = read_bytes(bytes, file);
      EXPECT_EQ(corners(mesh), corners(narrowed(kBox))) << name << " as " << file;
      EXPECT_EQ(mesh.vertices.size(), 8u) << name;
    }
  }
}

// Whatever the file says of a facet's normal, its corners go round as they do.
TEST(ReadMesh, DoesNotBelieveTheNormalsOfAnStl) {
  const std::string plain = test::as_binary_stl(kBox);
  constexpr std::size_t kFirstFacet = 84, kFacet = 50;
  for (const float sign : {1.0F, -1.0F}) {
    std::string bytes = plain;
    for (std::size_t i = 0; i < kBox.triangles.size(); ++i) {
      const Triangle& t = kBox.triangles[i];
      const Eigen::Vector3d a = kBox.vertices[t[0]];
      const Eigen::Vector3f normal =
          sign *
          (kBox.vertices[t[1]] - a).cross(kBox.vertices[t[2]] - a).normalized().cast<float>();
      std::memcpy(bytes.data() + kFirstFacet + i * kFacet, normal.data(), sizeof normal);
    }
    EXPECT_EQ(corners(read_bytes(bytes)), corners(narrowed(kBox)));
  }
}

TEST(ReadMesh, NumbersVerticesByFirstAppearance) {
  for (const auto& [name, bytes] : all_formats(kBox)) {
    std::uint32_t next = 0;
    for (const Triangle& triangle : read_bytes(bytes).triangles)
      for (const std::uint32_t vertex : triangle) {
        EXPECT_LE(vertex, next) << name;
        next = std::max(next, vertex + 1);
      }
  }
}

TEST(ReadMesh, TextMayHaveAnyLineEndsBlanksAndCase) {
  const auto expected = corners(narrowed(kBox));
  for (const auto& text :
       {test::as_text_stl(kBox), test::as_text_ply(kBox), test::as_obj(narrowed(kBox))}) {
    for (const char* line_end : {"\r\n", "\r", "\n\n", " \t\n \t", "\n\r\n"})
      EXPECT_EQ(corners(read_bytes(replaced(text, "\n", line_end))), expected);
    EXPECT_EQ(corners(read_bytes(text.substr(0, text.size() - 1))), expected);
    EXPECT_EQ(corners(read_bytes(text + std::string("\x1A\0\0", 3))), expected);
  }
  EXPECT_EQ(corners(read_bytes(std::string("\xEF\xBB\xBF") + test::as_obj(narrowed(kBox)))),
            expected);
  EXPECT_EQ(corners(read_bytes(std::string("\xEF\xBB\xBF") + test::as_text_stl(kBox))), expected);
  std::string upper = test::as_text_stl(kBox);
  for (char& c : upper) c = static_cast<char>(std::toupper(c));
  EXPECT_EQ(corners(read_bytes(upper)), expected);
}

TEST(ReadMesh, IgnoresTheNormalsOfAnStl) {
  for (const char* normal : {"nan nan nan", "-nan(ind) 0 0", "", "0 0", "vertex 1 2 3"}) {
    const std::string text =
        replaced(test::as_text_stl(kBox), "normal 0 0 1", std::string("normal ") + normal);
    EXPECT_EQ(corners(read_bytes(text)), corners(narrowed(kBox))) << normal;
  }
  std::string bytes = test::as_binary_stl(kBox);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bytes.data() + 84, &nan, sizeof nan);
  EXPECT_EQ(corners(read_bytes(bytes)), corners(narrowed(kBox)));
}

TEST(ReadMesh, JoinsTheSolidsOfAnStl) {
  const TriangleMesh other = test::moved(kBox, {5, 0, 0});
  const std::string two =
      test::as_text_stl(kBox) + "solid\nendsolid\n\nsolid endsolid\n" +
      test::as_text_stl(other).substr(std::string("solid made by hand\n").size());
  EXPECT_EQ(corners(read_bytes(two)), corners(narrowed(test::joined(kBox, other))));
}

TEST(ReadMesh, WeldsExactlyAndTakesMinusZeroForZero) {
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0.0 -0 -0e5\nv 1.0 0 -0\nv 0 -1 0\nv 1.0000000000000002 0 0\n"
      "f 1 2 3\nf 6 5 4\nf 7 3 4\n";
  const TriangleMesh mesh = read_bytes(text);
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 1, 0}, {4, 2, 0}}));
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    for (const double x : vertex) EXPECT_FALSE(x == 0 && std::signbit(x));
}

TEST(ReadMesh, RoundsNumbersOnceHoweverTheyAreSpelled) {
  const TriangleMesh mesh = read_bytes(
      "v +.5 5. 0.1000000000000000055511151231257827\n"
      "v 0.00000000000000000000012345678e20 123456789012345678901234567890e-27 16777216.999\n"
      "v 1e-46 1e-400 1e-40\nf 1 2 3\n");
  EXPECT_EQ(mesh.vertices[0], Eigen::Vector3d(0.5, 5, 0.1));
  EXPECT_EQ(mesh.vertices[1], Eigen::Vector3d(0.012345678, 123.456789012345678, 16777216.999));
  EXPECT_EQ(mesh.vertices[2], Eigen::Vector3d(1e-46, 0, 1e-40));
}

// An STL's numbers are floats in text as well: both of its forms give the same mesh.
TEST(ReadMesh, TakesTheNumbersOfAnStlForFloats) {
  const TriangleMesh mesh = read_bytes(
      "solid\nfacet normal 0 0 1 outer loop vertex 0.1 16777216.999 1e-46 vertex 1 0 0 "
      "vertex 0 1e-400 1e-40 endloop endfacet\nendsolid\n");
  EXPECT_EQ(mesh.vertices[0], Eigen::Vector3d(0.1F, 16777216.999F, 0));
  EXPECT_EQ(mesh.vertices[2], Eigen::Vector3d(0, 0, 1e-40F));
}

TEST(ReadMesh, TakesTheNumbersOfAPlyForWhatItDeclares) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty float y\n"
      "property int z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0.1 0.1 16777217\n1 0 0\n0 1 -2147483647\n3 0 1 2\n";
  const TriangleMesh mesh = read_bytes(text);
  EXPECT_EQ(mesh.vertices[0], Eigen::Vector3d(0.1, 0.1F, 16777217));
  EXPECT_EQ(mesh.vertices[2], Eigen::Vector3d(0, 1, -2147483647));
  // The same vertices, as bytes.
  std::string bytes = text.substr(0, text.find("0.1"));
  bytes.replace(bytes.find("ascii"), 5, "binary_little_endian");
  const auto append = [&bytes](auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (const auto& [x, y, z] : {std::tuple{0.1, 0.1F, 16777217}, std::tuple{1.0, 0.0F, 0},
                                std::tuple{0.0, 1.0F, -2147483647}}) {
    append(x);
    append(y);
    append(z);
  }
  bytes += '\3';
  for (const int corner : {0, 1, 2}) append(corner);
  EXPECT_EQ(read_bytes(bytes).vertices, mesh.vertices);
}

TEST(ReadMesh, ReadsWhatObjWritersWrite) {
  const TriangleMesh mesh = read_bytes(
      "# comment\n"
      "mtllib /dev/zero\ng a b\ns 1\nusemtl c:\\path\n"
      "  v 0 0 0 1.0   # a weight\n\tv 1 0 0 0.5 0.5 0.5\nv 1 \\\n 1 0\n"
      "vt 0.5\nvn nan nan nan\nvp 1\nl 1 2\np 1\n"
      "f 1/1/1 2//1 3/1\n  f -3 -1\\\r\n 4# a vertex that comes later\ncurv 0 1\nv 0 1 0\n");
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

// Comments and names may end with a backslash: exporters write Windows paths there.
TEST(ReadMesh, InAnObjOnlyLinesOfNumbersGoOn) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
  for (const std::string line :
       {"# from D:\\scans\\", "g D:\\", "o D:\\", "usemtl D:\\", "mtllib D:\\", "shadow_obj D:\\",
        "v 0 1 0 # D:\\", "  # \\", "s off\\"}) {
    for (const char* end : {"\n", "\r\n", "\r"}) {
      const TriangleMesh mesh =
          read_bytes(line + end + vertices + line + end + "f 1 2 3\n", "a.obj");
      EXPECT_EQ(mesh.triangles.size(), 1u) << line;
    }
  }
  for (const char* text : {"f 1 2\\\n3\n", "f 1 2 \\\r\n 3\n", "f 1\\\n2\\\n3\n", "f\\\r1 2 3\n"}) {
    EXPECT_EQ(read_bytes(vertices + text).triangles.size(), 1u) << text;
  }
}

TEST(ReadMesh, TextMayHoldAFewControlBytes) {
  const std::string obj = "# \x1B[0m\nv 0 0 0\nv 1 0 0\nv 0 1 0\ng a\x01\nf 1 2 3\n";
  EXPECT_EQ(read_bytes(obj, "a.obj").triangles.size(), 1u);
  std::string stl = test::as_text_stl(kBox);
  stl.replace(stl.find("solid"), 5, std::string("solid a\0b", 9));
  EXPECT_EQ(corners(read_bytes(stl, "a.stl")), corners(narrowed(kBox)));
}

// The header's lines end with \r, and the first byte of the first vertex is \n.
TEST(ReadMesh, APlyMayHaveCarriageReturnsBeforeItsBytes) {
  TriangleMesh mesh = test::icosphere(0, 1);
  mesh.vertices[0].x() = static_cast<double>(std::bit_cast<float>(0x3F80000Au));
  std::string bytes = test::as_binary_ply(mesh, false);
  const std::size_t header = bytes.find("end_header\n") + 11;
  for (std::size_t i = 0; i < header; ++i) {
    if (bytes[i] == '\n') bytes[i] = '\r';
  }
  EXPECT_EQ(corners(read_bytes(bytes)), corners(narrowed(mesh)));
}

TEST(ReadMesh, TextMayBePaddedWithZerosOrCtrlZ) {
  for (const char pad : {'\0', '\x1A'}) {
    EXPECT_EQ(corners(read_bytes(test::as_text_stl(kBox) + std::string(5000, pad))),
              corners(narrowed(kBox)));
  }
}

TEST(ReadMesh, AHeaderOfAPlyMayEndItsLastLineInAnotherWay) {
  const TriangleMesh mesh = test::icosphere(0, 1);
  std::string bytes = test::as_binary_ply(mesh, false);
  bytes.insert(bytes.find("end_header\n") + 10, "\r");
  EXPECT_EQ(corners(read_bytes(bytes)), corners(narrowed(mesh)));
}

// As 3D Slicer writes it.
TEST(ReadMesh, TellsTheFrameThatAFileNames) {
  const auto stl = [](std::string header) {
    std::string bytes = test::as_binary_stl(kBox);
    return bytes.replace(0, header.size(), header);
  };
  const std::string text = test::as_text_stl(kBox), ply = test::as_binary_ply(kBox, true),
                    obj = test::as_obj(kBox);
  const auto with = [](std::string content, const std::string& line, std::size_t after) {
    return content.insert(content.find('\n', after) + 1, line);
  };
  const auto frame = [](const std::string& bytes) { return read_bytes(bytes).frame; };
  using enum PatientFrame;
  EXPECT_EQ(frame(stl("3D Slicer output. SPACE=RAS")), kRas);
  EXPECT_EQ(frame(stl("3D Slicer output. SPACE=LPS")), kLps);
  EXPECT_EQ(frame("solid made by hand;SPACE=LPS\n" + text.substr(text.find('\n') + 1)), kLps);
  EXPECT_EQ(frame(with(ply, "comment SPACE=RAS\n", 0)), kRas);
  EXPECT_EQ(frame(with(ply, "obj_info SPACE=lps\n", 0)), kLps);
  EXPECT_EQ(frame("# SPACE=LPS\n" + obj), kLps);
  EXPECT_EQ(frame("#SPACE=RAS a comment\n" + obj), kRas);
  // A name is no comment, and other words are no frame.
  for (const std::string& nothing :
       {obj, "o SPACE=RAS\n" + obj, stl("COLORSPACE=RAS"), stl("SPACE=RASX"), stl("SPACE=LAS"),
        stl("SPACE = RAS"), stl("SPACE="), with(ply, "comment SPACE\n", 0)}) {
    EXPECT_EQ(frame(nothing), kUnknown);
  }
  EXPECT_EQ(frame("# SPACE=RAS\n# SPACE=RAS\n" + obj), kRas);
  EXPECT_EQ(test::error_name([&] { static_cast<void>(frame("# SPACE=RAS\n# SPACE=LPS\n" + obj)); }),
            "not-a-mesh");
}

TEST(ReadMesh, ReadsThePlyStrips) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float "
      "z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n";
  const TriangleMesh faces = read_bytes(
      "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3\nf 3 2 4\nf 3 4 5\nf 5 4 6\n");
  EXPECT_EQ(corners(read_bytes(header + "6 0 1 2 3 4 5\n")), corners(faces));
  EXPECT_EQ(corners(read_bytes(header + "11 0 1 2 3 -1 2 3 4 5 -1 -1\n")), corners(faces));
  // Corners twice in a row join two strips.
  const TriangleMesh joined = read_bytes(header + "10 0 1 2 3 3 2 2 3 4 5\n");
  EXPECT_EQ(corners(joined), corners(faces));
  EXPECT_EQ(test::error_name([&] { static_cast<void>(read_bytes(header + "4 0 1 2 6\n")); }),
            "mesh-bad-index");
  EXPECT_EQ(test::error_name([&] { static_cast<void>(read_bytes(header + "4 0 1 2 -2\n")); }),
            "mesh-bad-index");
}

TEST(ReadMesh, TheFirstCoordinateMayLookLikeALineEnd) {
  for (const std::uint32_t bits : {0x3F80000Au, 0x0A00803Fu, 0x3F800A0Du, 0x3F80000Du}) {
    TriangleMesh mesh = test::icosphere(0, 1);
    mesh.vertices[0].x() = static_cast<double>(std::bit_cast<float>(bits));
    for (const auto& [name, bytes] : all_formats(mesh))
      EXPECT_EQ(corners(read_bytes(bytes)), corners(narrowed(mesh))) << name;
  }
}

TEST(ReadMesh, ReadsPlyWithMoreThanASurface) {
  const TriangleMesh mesh = read_bytes(
      "ply\r\nformat ascii 1.0\r\ncomment TextureFile x\r\nobj_info y\r\nelement camera 1\r\n"
      "property float view\r\nelement nothing 4000000000\r\nelement vertex 3\r\n"
      "property uchar red\r\nproperty double z\r\nproperty int32 y\r\nproperty list uchar float "
      "w\r\n"
      "property float64 x\r\ncomment z\r\nelement edge 1\r\nproperty int a\r\n"
      "element face 1\r\nproperty list uint8 uint16 vertex_index\r\n"
      "property list uchar float texcoord\r\nend_header\r\n"
      "7\r\n255 3.5 2 0 1\r\n0 0 0 2 0.5 nan 0\r\n0 1 1 1 9 1\r\n5\r\n3 0 2 1 0\r\n");
  EXPECT_EQ(corners(mesh), (std::vector<std::array<double, 9>>{{1, 2, 3.5, 1, 1, 1, 0, 0, 0}}));
}

TEST(ReadMesh, ReadsWhatOffWritersWrite) {
  const TriangleMesh expected =
      read_bytes("v 0 0 0\nv 1 0 0.1\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 3 2");
  for (const char* text :
       {"OFF 4 2 0\n0 0 0\n1 0 .1\n1 1 0\n0 1 0\n4 0 1 2 3\n3 0 2 1\n",
        "COFF\n# counts\n\n4 2 # no edges\n0 0 0 255 0 0 255\n1 0 .1 0 0 0 0 # "
        "red\n"
        "# here\n1 1 0 1 1 1 1\n\n0 1 0\n4 0 1 2 3 0.5 0.5 0.5\n3 0 2 1 9\n# end\n"}) {
    const TriangleMesh mesh = read_bytes(text);
    EXPECT_EQ(mesh.vertices, expected.vertices) << text;
    EXPECT_EQ(mesh.triangles, expected.triangles) << text;
  }
}

double doubled_area(const TriangleMesh& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const double signed_area =
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).z();
    EXPECT_GT(signed_area, 0);
    area += signed_area;
  }
  return area;
}

TEST(ReadMesh, CutsPolygonsIntoTrianglesInside) {
  struct Case {
    std::string vertices;
    std::size_t corners;
    double doubled_area;
  };
  for (const auto& [vertices, n, area] : std::vector<Case>{
           {"v 0 0 5\nv 2 0 5\nv 2 1 5\nv 0 1 5\n", 4, 4},                    // a rectangle
           {"v 0 0 5\nv 3 -1 5\nv 1 0 5\nv 3 1 5\n", 4, 2},                   // an arrow head
           {"v 0 0 5\nv 2 0 5\nv 2 1 5\nv 1 1 5\nv 1 3 5\nv 0 3 5\n", 6, 8},  // an L
           {"v 0 0 5\nv 4 0 5\nv 4 3 5\nv 3 3 5\nv 3 1 5\nv 1 1 5\nv 1 3 5\nv 0 3 5\n", 8, 16}}) {
    for (std::size_t first = 0; first < n; ++first) {  // wherever the polygon begins
      std::string face = "f";
      for (std::size_t i = 0; i < n; ++i)
        face.append(" ").append(std::to_string((first + i) % n + 1));
      const TriangleMesh mesh = read_bytes(vertices + face + "\n");
      EXPECT_EQ(mesh.triangles.size(), n - 2);
      EXPECT_EQ(doubled_area(mesh), area) << vertices << face;
    }
  }
}

TEST(ReadMesh, GivesTrianglesForPolygonsWithoutAnAnswer) {
  const std::string star = "v 0 3 0\nv 2 -2 0\nv -3 1 0\nv 3 1 0\nv -2 -2 0\n";
  EXPECT_EQ(read_bytes(star + "f 1 2 3 4 5\n").triangles.size(), 3u);
  EXPECT_EQ(read_bytes(star + "f 1 2 1 2 1 2\n").triangles.size(), 4u);
  EXPECT_EQ(read_bytes("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 3 2 4\n").triangles.size(), 2u);
}

// A closed surface of polygons is a closed surface of triangles: no two polygons get the same
// diagonal.
TEST(ReadMesh, PolygonsThatShareTwoCornersStayClosed) {
  const std::string cube =
      "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\nv 1 0.3 1\n"
      "f 1 4 3 2\nf 5 6 7 8\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  for (const std::string one : {"f 1 2 6 9\n", "f 2 6 9 1\n", "f 6 9 1 2\n", "f 9 1 2 6\n"}) {
    for (const std::string other : {"f 6 5 1 9\n", "f 5 1 9 6\n", "f 1 9 6 5\n", "f 9 6 5 1\n"}) {
      const MeshReport report = check_mesh(read_bytes(cube + one + other));
      EXPECT_EQ(report.non_manifold_edges, 0u) << one << other;
      EXPECT_EQ(report.duplicate_triangles, 0u) << one << other;
      EXPECT_TRUE(report.closed && report.consistent);
      EXPECT_NEAR(report.signed_volume, 7.7, 0.1 + 1e-12) << "vertex 9 lies 0.3 inside";
    }
  }
  // Only the second of the two has another diagonal: the edge from 2 to 9 is taken.
  const MeshReport taken =
      check_mesh(read_bytes(cube + "f 1 2 6 9\nf 6 5 1 9\nv 1 -2 1\nf 2 9 10\nf 9 2 10\n"));
  EXPECT_EQ(taken.duplicate_triangles, 1u) << "the one that was written so";
}

TEST(ReadMesh, EndsWhereItsThreadIsAsked) {
  const std::atomic<bool> asked{true};
  for (const auto& format : all_formats(kBox)) {
    const ScopedCancellation cancellation(asked);
    EXPECT_EQ(test::error_name([&] { static_cast<void>(read_content(format.second, "mesh")); }),
              "cancelled")
        << format.first;
  }
  const TempDir folder;
  const auto file = folder.write("mesh", test::as_binary_stl(kBox));
  const ScopedCancellation cancellation(asked);
  EXPECT_EQ(test::error_name([&] { static_cast<void>(read_mesh(file)); }), "cancelled");
}

TEST(ReadMesh, ReadsTheSameJawFromEveryFormat) {
  IST_SLOW();
  if (!std::filesystem::is_directory(test::data_dir()))
    IST_SKIP("no folder of real meshes at " << test::data_dir());
  const TriangleMesh mesh = read_mesh(test::data_dir() / "human_maxilla.stl");
  const auto expected = corners(mesh);
  const TempDir folder;
  for (const auto& [name, bytes] : all_formats(mesh)) {
    const TriangleMesh again = read_mesh(folder.write("mesh", bytes));
    EXPECT_TRUE(again.triangles == mesh.triangles && corners(again) == expected) << name;
  }
}

}  // namespace
}  // namespace ist
