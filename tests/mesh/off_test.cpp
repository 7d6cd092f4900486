// OFF in every layout: by lines, free of lines, with numbers to skip.

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ist/base/error.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/mesh.h"
#include "support/errors.h"
#include "support/mesh_files.h"

namespace ist {
namespace {

using test::corners;
using test::replaced;

// A tetrahedron. No number of a vertex could be an index.
const std::vector<std::string> kOffVertices = {"0.5 0.25 0.125", "9.5 0.25 0.125", "0.5 9.25 0.125",
                                               "0.5 0.25 9.125"};
const std::vector<std::string> kOffFaces = {"3 0 2 1", "3 0 1 3", "3 0 3 2", "3 1 2 3"};
const TriangleMesh kTetrahedron = {
    {{0.5, 0.25, 0.125}, {9.5, 0.25, 0.125}, {0.5, 9.25, 0.125}, {0.5, 0.25, 9.125}},
    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

// A text of the tetrahedron, with an ending for each vertex and for each face.
std::string off_text(const std::string& header, const std::string& vertex_end = "\n",
                     const std::string& face_end = "\n") {
  std::string text = header;
  for (const std::string& vertex : kOffVertices) text += vertex + vertex_end;
  for (const std::string& face : kOffFaces) text += face + face_end;
  return text;
}

TriangleMesh read_off_bytes(std::string_view bytes, const char* name = "a.off") {
  return read_content(bytes, name);
}

// The error's code and text, behind the file's name.
std::string off_refusal(std::string_view bytes, const char* name = "a.off") {
  const auto error = test::error_of([&] { static_cast<void>(read_content(bytes, name)); });
  if (!error) return "fine";
  return std::string(to_string(error->code())) + (error->what() + std::strlen(name));
}

const auto kOffExpected = corners(kTetrahedron);

TEST(Off, IsFreeOfLines) {
  const std::string lines = off_text("OFF\n4 4 6\n");
  for (const std::string& text :
       {lines, replaced(lines, "\n", " "), replaced(lines, " ", "\n"),
        replaced(lines, "\n", "\r\n"), replaced(lines, "\n", "\r"),
        replaced(lines, "\n", " # 7 7 7\n\n# 7\n"), off_text("OFF\n4 4 6\n", " "),
        off_text("OFF\n4 4 6\n", "\n", " "), off_text("OFF 4 4 6\n"), off_text("OFF 4\n4\n6\n"),
        off_text("OFF 4 4 6 ", "\n"), off_text("OFF\n4 4\n"), replaced(lines, "3 ", "3\n"),
        replaced(lines, "0.25", "0.25\n"), replaced(lines, "0.125\n0.5", "0.125 0.5")}) {
    EXPECT_EQ(corners(read_off_bytes(text)), kOffExpected) << text;
    EXPECT_EQ(corners(read_off_bytes(text, "mesh.stl")), kOffExpected) << text;
  }
}

TEST(Off, BeginsWithCommentsAndMayGlueOrLackItsKeyword) {
  for (const char* header : {"# a\n\n#b\nOFF\n4 4 6\n", "OFF4 4 6\n", "#x\nCOFF4 4 6\n",
                             "OFF# glued\n4 4 6\n", "\xEF\xBB\xBFOFF4 4 6 "}) {
    const std::string end =
        std::string_view(header).find("COFF") != std::string_view::npos ? " 0.1 0.2 0.3 1\n" : "\n";
    EXPECT_EQ(corners(read_off_bytes(off_text(header, end), "mesh")), kOffExpected) << header;
  }
  for (const char* header : {"4 4 6\n", "# none\n4 4 6 ", "4\n4\n6\n"}) {
    EXPECT_EQ(corners(read_off_bytes(off_text(header))), kOffExpected) << header;
    EXPECT_EQ(corners(read_off_bytes(off_text(header), "A.OFF")), kOffExpected) << header;
    EXPECT_TRUE(
        off_refusal(off_text(header), "mesh").starts_with("not-a-mesh: the content is in no "));
  }
  EXPECT_TRUE(off_refusal("OFFER 4 4 6\n").starts_with("not-a-mesh: the content is in no "));
  EXPECT_TRUE(off_refusal("#\n").starts_with("not-a-mesh: the content is in no "));
}

TEST(Off, SkipsWhatFollowsAtTheEndOfALine) {
  const std::string colours[] = {" 255 0 0\n", " 0.5 0.25 1 1\n", " 7\n"};
  for (const std::string& colour : colours) {
    EXPECT_EQ(corners(read_off_bytes(off_text("OFF\n4 4 6\n", "\n", colour))), kOffExpected)
        << colour;
    EXPECT_EQ(corners(read_off_bytes(off_text("OFF\n4 4 6\n", colour))), kOffExpected) << colour;
    EXPECT_EQ(corners(read_off_bytes(off_text("COFF\n4 4 6\n", colour, colour))), kOffExpected)
        << colour;
    EXPECT_EQ(corners(read_off_bytes(off_text("OFF 4 4 6 ", " ", "\n").append("#") + colour)),
              kOffExpected);
  }
  // Vertices free of lines, faces by lines with colours; and the other way round.
  std::string text = replaced(off_text("OFF\n4 4 6\n", "|", " 9 9 9\n"), "0.125|0", "0.125 0");
  EXPECT_EQ(corners(read_off_bytes(replaced(text, "|", "\n"))), kOffExpected);
  text = replaced(off_text("COFF\n4 4 6\n", " 1 1 1 1\n", "|"), "3 ", "3\n");
  EXPECT_EQ(corners(read_off_bytes(replaced(text, "|", "\n"))), kOffExpected);
}

// Free of lines, the keyword tells how many numbers follow the coordinates.
TEST(Off, SkipsWhatItsKeywordNames) {
  for (const auto& [keyword, extras] :
       std::vector<std::pair<const char*, const char*>>{{"COFF", " 9 9 9 9 "},
                                                        {"NOFF", " 9 9 9 "},
                                                        {"CNOFF", " 9 9 9 9 9 9 9 "},
                                                        {"STOFF", " 9 9 "},
                                                        {"STCOFF", " 9 9 9 9 9 9 "},
                                                        {"STNOFF", " 9 9 9 9 9 "},
                                                        {"STCNOFF", " 9 9 9 9 9 9 9 9 9 "}}) {
    EXPECT_EQ(corners(read_off_bytes(off_text(std::string(keyword) + " 4 4 6 ", extras, " "))),
              kOffExpected)
        << keyword;
    EXPECT_EQ(corners(read_off_bytes(
                  off_text(std::string(keyword) + "\n4 4 6\n", std::string(extras) + "\n"))),
              kOffExpected)
        << keyword;
  }
  EXPECT_NE(off_refusal(off_text("COFF 4 4 6 ", " 9 9 9 ", " ")), "fine")
      << "a colour has four numbers";
}

// By lines a face of 0 1 2 and one of 3 1 2; free of lines one of 0 1 2 and one of four corners.
TEST(Off, RefusesATextThatReadsInTwoWays) {
  const std::string head = "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  EXPECT_EQ(corners(read_off_bytes(head + "3 0 1 2\n3 3 1 2\n")).size(), 2u);
  EXPECT_EQ(off_refusal(head + "3 0 1 2 4\n3 0 1 2\n"),
            "not-a-mesh: numbers at the ends of lines could be colours, or vertices and faces; "
            "export the mesh as plain OFF, without colours");
}

TEST(Off, ErrorsAreOfTheLayoutThatTheTextHas) {
  const std::string lines = off_text("OFF\n4 4 6\n");
  const std::string one_line = replaced(lines, "\n", " ");
  const std::string by_corner = replaced(lines, "3 ", "3\n");
  for (
      const auto& [text, expected] : std::vector<std::pair<std::string, std::string>>{
          {replaced(lines, "9.5 0.25", "9.5"),
           "not-a-mesh: line 4: a coordinate is missing; export the mesh again"},
          {replaced(lines, "3 0 1 3", "3 0 1"),
           "not-a-mesh: line 8: an integer is missing; export the mesh again"},
          {replaced(lines, "3 0 1 3", "3 0 1 4"),
           "mesh-bad-index: line 8: a face names vertex 4, but there are 4, counted from 0; export "
           "the mesh again"},
          {replaced(one_line, "3 0 1 3", "3 0 1 4"),
           "mesh-bad-index: line 1: a face names vertex 4, but there are 4, counted from 0; export "
           "the mesh again"},
          {replaced(by_corner, "\n1 2 3\n", "\n1 2 4\n"),
           "mesh-bad-index: line 15: a face names vertex 4, but there are 4, counted from 0; "
           "export the mesh again"},
          {lines + "3 0 1 2\n",
           "not-a-mesh: line 11: the file has more lines than the header counts; export the mesh "
           "again"},
          {one_line + "3 0 1 2",
           "not-a-mesh: line 1: the file has more lines than the header "
           "counts; export the mesh again"},
          {one_line.substr(0, one_line.size() - 3),
           "mesh-truncated: line 1: the file ends here, but an integer is missing; export the mesh "
           "again"},
          {lines.substr(0, lines.size() - 8),
           "mesh-truncated: line 9: the file ends before a face; copy or export it again"},
          {replaced(one_line, "9.25", "nan"),
           "mesh-not-finite: line 1: the coordinate 'nan' is not finite, or beyond a float's "
           "range; "
           "repair the mesh where it was made"},
          {"OFF 9999999999999 9999999999999 0 1 2 3",
           "mesh-truncated: line 1: the file ends before a vertex; copy or export it again"},
          {"OFF 0 9999999999999 0",
           "mesh-truncated: line 1: the file ends before a face; copy or export it again"},
          {"OFF 0 0 0 ", "mesh-empty: the OFF has no vertex; export the mesh again"},
          {"OFF 1 0 0 1 2 3",
           "mesh-points-only: the file has 1 vertex, but no face; export the surface as "
           "polygons"}}) {
    EXPECT_EQ(off_refusal(text), expected) << text;
  }
}

TEST(Off, RefusesEveryCutOfAFreeText) {
  const std::string one_line = replaced(off_text("OFF 4 4 6\n"), "\n", " ");
  for (std::size_t size = 1; size + 1 < one_line.size(); ++size) {
    const std::string text = off_refusal(one_line.substr(0, size), "a.stl");
    EXPECT_TRUE(text.starts_with("mesh-truncated: ")) << text << " at " << size;
  }
}

}  // namespace
}  // namespace ist
