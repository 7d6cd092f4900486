#include "cli/occlusion/teeth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "cli/occlusion/bites.h"
#include "support/errors.h"
#include "support/shapes.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

using cli::read_labels, cli::teeth_of, cli::ToothLabels, cli::ToothNumbers;

// Four triangles, six vertices: 0 2 4 / 1 3 5.
const TriangleMesh kStrip = open_strip(2);

ToothLabels read(const std::string& content, ToothNumbers numbers = ToothNumbers::kFdi) {
  const TempDir dir;
  return read_labels(dir.write("teeth.txt", content), kStrip, numbers);
}

std::string refusal(const std::string& content, ToothNumbers numbers = ToothNumbers::kFdi) {
  const auto error = error_of([&] { (void)read(content, numbers); });
  if (!error || error->code() != ErrorCode::kInputInvalid) return "not refused";
  const std::string text = error->what();
  return text.find("teeth.txt: ") == text.npos ? "names no file" : text;
}

TEST(Teeth, LabelsAreOfTrianglesInTheirOrder) {
  EXPECT_EQ(read("11\n0\n85\n48\n"), (ToothLabels{11, 0, 85, 48}));
  EXPECT_EQ(read("11\r\n 0 \r\n85\t\r\n48"), (ToothLabels{11, 0, 85, 48}));
}

TEST(Teeth, NumbersOutsideTheSystemAreRefusedByLine) {
  for (const int good : {11, 18, 21, 28, 31, 38, 41, 48, 51, 55, 61, 65, 71, 75, 81, 85, 0}) {
    EXPECT_EQ(read("0\n0\n0\n" + std::to_string(good))[3], good);
  }
  for (const int bad :
       {-11, 1, 9, 10, 19, 20, 29, 49, 50, 56, 66, 76, 86, 90, 91, 99, 111, 32000}) {
    const std::string said = refusal("0\n" + std::to_string(bad) + "\n0\n0\n");
    EXPECT_NE(said.find("line 2 is " + std::to_string(bad) + ": FDI"), said.npos) << said;
  }
  EXPECT_EQ(read("1\n32\n0\n9\n", ToothNumbers::kUniversal), (ToothLabels{1, 32, 0, 9}));
  const std::string said = refusal("0\n0\n33\n0\n", ToothNumbers::kUniversal);
  EXPECT_NE(said.find("line 3 is 33: universal numbers are 1 to 32"), said.npos) << said;
  EXPECT_NE(refusal("0\n-1\n0\n0\n", ToothNumbers::kUniversal).find("line 2"), said.npos);
}

TEST(Teeth, LinesThatAreNoNumberAreRefused) {
  for (const char* bad : {"11a", "1 1", "11.0", "x", "99999999999", "+11", "0x11", "11,"}) {
    const std::string said = refusal("0\n0\n0\n" + std::string(bad) + "\n");
    EXPECT_NE(said.find("line 4 is \"" + std::string(bad) + "\": write one whole number a line"),
              said.npos)
        << said;
  }
  const std::string said = refusal("11\n\n12\n13\n14\n");
  EXPECT_NE(said.find("line 2 is empty: write 0 for no tooth"), said.npos) << said;
  EXPECT_EQ(read("11\n12\n13\n14\n\n \n").size(), 4U) << "blank at the end";
}

TEST(Teeth, OtherCountsAreRefused) {
  for (const char* content :
       {"", "11\n", "11\n11\n11\n", "0\n0\n0\n0\n0\n", "0\n0\n0\n0\n0\n0\n0\n"}) {
    const std::string said = refusal(content);
    EXPECT_NE(said.find("labels for a mesh of 4 triangles and 6 vertices: write one a line"),
              said.npos)
        << said;
  }
  const TempDir dir;
  EXPECT_EQ(
      error_name([&] { (void)read_labels(dir.path() / "none.txt", kStrip, ToothNumbers::kFdi); }),
      "file-unreadable");
}

TEST(Teeth, LabelsOfVerticesAreOfTrianglesByTwoCorners) {
  std::vector<int> of_vertices(6, 21);
  of_vertices[kStrip.triangles[0][0]] = 22;
  std::string content;
  for (const int label : of_vertices) content += std::to_string(label) + "\n";
  ToothLabels expected;
  for (const Triangle& t : kStrip.triangles) {
    int others = 0;
    for (const std::uint32_t v : t) others += of_vertices[v] == 22 ? 1 : 0;
    expected.push_back(others >= 2 ? 22 : 21);
  }
  EXPECT_EQ(read(content), expected);
}

TEST(Teeth, LabelsOfVerticesInAnotherOrderAreRefused) {
  const std::string said = refusal("11\n12\n13\n14\n15\n16\n");
  EXPECT_NE(said.find("give a label for each triangle"), said.npos) << said;
}

TEST(Teeth, SumTheContactsOfTheirTriangles) {
  SurfaceOcclusion surface;
  surface.vertices.resize(6);
  for (std::size_t v = 0; v < 6; ++v) surface.vertices[v].distance = 0.1 * static_cast<double>(v);
  surface.regions.resize(2);
  surface.regions[0].triangles = {{0, 0.5, 3, 0, 8}, {1, 0.25, 1, 0, 4}};
  surface.regions[1].triangles = {{0, 0.125, 2, 0, 4}, {3, 1, 2, 0, 4}};
  const auto teeth = teeth_of(surface, kStrip, {12, 11, 13, 0});
  ASSERT_EQ(teeth.size(), 3U);
  EXPECT_EQ(teeth[0].number, 11);
  EXPECT_EQ(teeth[0].area, 0.25);
  EXPECT_EQ(teeth[0].share, 1 / 8.0);
  EXPECT_EQ(teeth[0].share_thicker, 4 / 20.0);
  EXPECT_EQ(teeth[1].number, 12);
  EXPECT_EQ(teeth[1].area, 0.625);
  EXPECT_EQ(teeth[1].share, 5 / 8.0);
  EXPECT_EQ(teeth[1].share_thinner, 0) << "that foundation is not pressed";
  EXPECT_EQ(teeth[1].least_distance, 0);
  EXPECT_EQ(teeth[2].number, 13);
  EXPECT_EQ(teeth[2].share, 0);
  std::uint32_t first = 6;
  for (const std::uint32_t v : kStrip.triangles[2]) first = std::min(first, v);
  EXPECT_EQ(teeth[2].least_distance, 0.1 * first);
}

TEST(Teeth, BeyondTheReachHaveNoDistance) {
  SurfaceOcclusion surface;
  surface.vertices.resize(6);
  for (SurfaceDistance& one : surface.vertices) one.distance = std::nan("");
  const auto teeth = teeth_of(surface, kStrip, {0, 0, 36, 36});
  ASSERT_EQ(teeth.size(), 1U);
  EXPECT_TRUE(std::isnan(teeth[0].least_distance));
  EXPECT_EQ(teeth[0].share, 0);
}

TEST(Teeth, OfABiteShareAllThatIsLabelled) {
  const auto made = sphere_over_plate({1, 0, -0.05});
  const cli::BiteBody& body = made->bite.fixed;
  ToothLabels labels;
  for (const Triangle& t : body.mesh->triangles) {
    labels.push_back(
        (body.mesh->vertices[t[0]] + body.mesh->vertices[t[1]] + body.mesh->vertices[t[2]]).x() > 3
            ? 11
            : 21);
  }
  const auto teeth = teeth_of(body.surface, *body.mesh, labels);
  ASSERT_EQ(teeth.size(), 2U);
  EXPECT_NEAR(teeth[0].share + teeth[1].share, 1, 1e-12);
  EXPECT_NEAR(teeth[0].share, 0.5, 1e-6);
  double area = 0;
  for (const ContactRegion& region : body.surface.regions) area += region.area;
  EXPECT_NEAR(teeth[0].area + teeth[1].area, area, 1e-9);
}

}  // namespace
}  // namespace ist::test
