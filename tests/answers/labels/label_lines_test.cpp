#include <gtest/gtest.h>

#include <string>

#include "answers/occlusion/labels/tooth_labels.h"
#include "support/errors.h"
#include "support/shapes.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

using answers::read_labels, answers::ToothLabels, answers::ToothNumbers;

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

TEST(LabelLines, AreOfTrianglesInTheirOrder) {
  EXPECT_EQ(read("11\n0\n85\n48\n"), (ToothLabels{11, 0, 85, 48}));
  EXPECT_EQ(read("11\r\n 0 \r\n85\t\r\n48"), (ToothLabels{11, 0, 85, 48}));
}

TEST(LabelLines, NumbersOutsideTheSystemAreRefusedByLine) {
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

TEST(LabelLines, LinesThatAreNoNumberAreRefused) {
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

TEST(LabelLines, OtherCountsAreRefused) {
  for (const char* content :
       {"", "11\n", "11\n11\n11\n", "0\n0\n0\n0\n0\n", "0\n0\n0\n0\n0\n0\n0\n"}) {
    const std::string said = refusal(content);
    EXPECT_NE(said.find(" for a mesh of 4 triangles and 6 vertices: write one a line"), said.npos)
        << said;
  }
  const TempDir dir;
  EXPECT_EQ(
      error_name([&] { (void)read_labels(dir.path() / "none.txt", kStrip, ToothNumbers::kFdi); }),
      "file-unreadable");
}

TEST(LabelLines, OfVerticesAreOfTrianglesByTwoCorners) {
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

TEST(LabelLines, OfVerticesInAnotherOrderAreRefused) {
  const std::string said = refusal("11\n12\n13\n14\n15\n16\n");
  EXPECT_NE(said.find("give a label for each triangle"), said.npos) << said;
  // Few are labelled, and most of the triangles there are noise.
  const TriangleMesh strip = open_strip(100);
  std::string scattered;
  for (std::size_t v = 0; v < strip.vertices.size(); ++v)
    scattered += v % 50 == 20 ? "11\n" : "0\n";
  const TempDir dir;
  const auto error = error_of(
      [&] { (void)read_labels(dir.write("teeth.txt", scattered), strip, ToothNumbers::kFdi); });
  ASSERT_TRUE(error);
  EXPECT_NE(std::string(error->what()).find("give a label for each triangle"), said.npos);
}

TEST(LabelLines, OfAFileThatIsNoTextAreRefused) {
  for (const std::string& content :
       {std::string(84, '\0'), std::string("11\n12\n13\n14\n\0", 13),
        std::string("1\x001\0\n\0", 6), std::string("ply\nformat binary\x1B[31m"),
        std::string("\x7F")}) {
    const std::string said = refusal(content);
    EXPECT_NE(said.find("it is no text: write one whole number a line"), said.npos) << said;
  }
  EXPECT_EQ(read("\xEF\xBB\xBF"
                 "11\r\n0\r\n85\r\n48\r\n"),
            (ToothLabels{11, 0, 85, 48}))
      << "after a byte order mark";
}

}  // namespace
}  // namespace ist::test
