// The answer of ist-import as the library reads it: nothing in it is trusted.

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>

#include "import/fake_importer.h"
#include "ist/mesh/import/import_message.h"
#include "support/errors.h"
#include "support/mesh_files.h"

namespace ist {
namespace {

TriangleMesh read_answer(const std::string& answer) {
  return read_import_message(answer, "/opt/ist-import", "jaw.glb");
}

std::string refused_answer(const std::string& answer) {
  const auto error = test::error_of([&] { static_cast<void>(read_answer(answer)); });
  return error ? std::string(to_string(error->code())) + ": " + error->what() : "fine";
}

const std::string kNoTrust =
    "file-unreadable: jaw.glb: ist-import at /opt/ist-import gave no mesh that can be trusted: "
    "install it again, or " +
    std::string(kConvert);

TEST(ImportMessage, HoldsAMesh) {
  test::FakeMesh mesh;
  mesh.coordinates = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  mesh.sizes = {4};
  mesh.corners = {0, 1, 2, 3};
  mesh.header.unit = static_cast<std::uint32_t>(LengthUnit::kInch);
  mesh.header.frame = static_cast<std::uint32_t>(PatientFrame::kLps);
  const TriangleMesh read = read_answer(mesh.counted().bytes());
  EXPECT_EQ(read.vertices.size(), 4u);
  EXPECT_EQ(read.triangles.size(), 2u);
  EXPECT_EQ(read.unit, LengthUnit::kInch);
  EXPECT_EQ(read.frame, PatientFrame::kLps);
}

TEST(ImportMessage, MayBeCutNowhere) {
  const std::string whole = test::FakeMesh().counted().bytes();
  EXPECT_EQ(refused_answer(whole), "fine");
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_EQ(refused_answer(whole.substr(0, size)), kNoTrust) << size;
  EXPECT_EQ(refused_answer(whole + "x"), kNoTrust);
}

TEST(ImportMessage, CountsAreNotBelieved) {
  const auto with = [](auto change) {
    test::FakeMesh mesh;
    static_cast<void>(mesh.counted());
    change(mesh);
    return refused_answer(mesh.bytes());
  };
  constexpr std::uint64_t kHuge = std::numeric_limits<std::uint64_t>::max();
  for (const std::uint64_t lie : {std::uint64_t{0}, std::uint64_t{2}, kHuge, kHuge / 24 + 1}) {
    EXPECT_EQ(with([&](auto& m) { m.header.vertices = lie; }), kNoTrust) << lie;
    EXPECT_EQ(with([&](auto& m) { m.header.polygons = lie; }), kNoTrust) << lie;
    EXPECT_EQ(with([&](auto& m) { m.header.corners = lie; }), kNoTrust) << lie;
  }
  for (const std::uint32_t size : {0u, 1u, 2u, 4u, 0xFFFFFFFFu})
    EXPECT_EQ(with([&](auto& m) { m.sizes[0] = size; }), kNoTrust) << size;
  for (const std::uint32_t corner : {3u, 0xFFFFFFFFu})
    EXPECT_EQ(with([&](auto& m) { m.corners[2] = corner; }), kNoTrust) << corner;
  EXPECT_EQ(with([&](auto& m) { m.header.kind = 2; }), kNoTrust);
  EXPECT_EQ(with([&](auto& m) { m.header.unit = 5; }), kNoTrust);
  EXPECT_EQ(with([&](auto& m) { m.header.frame = 3; }), kNoTrust);
  EXPECT_EQ(with([&](auto& m) { m.header.magic[0] = 'i'; }), kNoTrust);
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e39})
    EXPECT_EQ(with([&](auto& m) { m.coordinates[4] = value; }),
              "mesh-not-finite: jaw.glb: vertex 1: it is not finite, or beyond a float's range; "
              "repair the mesh where it was made");
}

TEST(ImportMessage, AFaceHasALimit) {
  test::FakeMesh mesh;
  mesh.coordinates.assign(3 * 1025, 0.0);
  mesh.sizes = {1025};
  mesh.corners.assign(1025, 0);
  EXPECT_EQ(
      refused_answer(mesh.counted().bytes()),
      "not-a-mesh: jaw.glb: face 0: it has 1025 corners, more than 1024; triangulate the mesh "
      "first");
}

TEST(ImportMessage, AnotherVersionIsNamed) {
  test::FakeMesh mesh;
  std::memcpy(mesh.header.version.data(), "9.8\x1B", 5);
  const std::string got = refused_answer(mesh.counted().bytes());
  EXPECT_TRUE(
      got.starts_with("file-unreadable: jaw.glb: ist-import at /opt/ist-import belongs to "
                      "version 9.8?"))
      << got;
  EXPECT_TRUE(got.ends_with(": install both from one release")) << got;
  mesh = {};
  mesh.header.protocol = 7;
  EXPECT_NE(refused_answer(mesh.counted().bytes()).find("belongs to version"), std::string::npos);
}

TEST(ImportMessage, HoldsAnError) {
  EXPECT_EQ(refused_answer(test::fake_error(ErrorCode::kMeshEmpty, "node 3", "it is empty; go on")),
            "mesh-empty: jaw.glb: node 3: it is empty; go on");
  EXPECT_EQ(refused_answer(test::fake_error(ErrorCode::kNotAMesh, "", "bad\n\x1B[2J\xFF")),
            "not-a-mesh: jaw.glb: bad??[2J?");
  EXPECT_EQ(refused_answer(test::fake_error(ErrorCode::kCancelled, "", "")), kNoTrust);
  EXPECT_EQ(refused_answer(test::fake_error(static_cast<ErrorCode>(1000), "", "")), kNoTrust);
  std::string lie = test::fake_error(ErrorCode::kMeshEmpty, "node 3", "it is empty");
  lie[offsetof(ImportHeader, vertices) + 7] = '\x7F';
  EXPECT_EQ(refused_answer(lie), kNoTrust);
  const std::string text(5000, 'x');
  EXPECT_LT(refused_answer(test::fake_error(ErrorCode::kNotAMesh, text, text)).size(), 2100u);
}

}  // namespace
}  // namespace ist
