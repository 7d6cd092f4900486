#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "cli/occlusion/labels/tooth_labels.h"
#include "support/errors.h"
#include "support/shapes.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

using cli::read_labels, cli::ToothLabels, cli::ToothNumbers;

// Two triangles 0 1 2 and 2 1 3, by a file of four vertices whose third is first used last.
const TriangleMesh kPair = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {2, 1, 3}}};
constexpr const char* kVertices[] = {"0 0 0", "1 0 0", "1 1 0", "0 1 0"};

std::string ply(const std::string& of_vertex, const std::string& of_face,
                const std::string& labels_of_vertices, const std::vector<std::string>& faces) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\n" +
      of_vertex + "element face " + std::to_string(faces.size()) +
      "\nproperty list uchar int vertex_indices\n" + of_face + "end_header\n";
  for (std::size_t i = 0; i < 4; ++i) {
    text += kVertices[i];
    if (!of_vertex.empty()) text += " " + labels_of_vertices.substr(3 * i, 2);
    text += "\n";
  }
  for (const std::string& face : faces) text += face + "\n";
  return text;
}

ToothLabels read(const char* name, const std::string& content,
                 ToothNumbers numbers = ToothNumbers::kFdi) {
  const TempDir dir;
  return read_labels(dir.write(name, content), kPair, numbers);
}

std::string refusal(const char* name, const std::string& content,
                    ToothNumbers numbers = ToothNumbers::kFdi) {
  const auto error = error_of([&] { (void)read(name, content, numbers); });
  if (!error) return "not refused";
  const std::string text = error->what();
  return text.find(name) == text.npos ? "names no file" : text;
}

TEST(LabelsOfPly, AreAPropertyOfFaces) {
  const std::string file = ply("", "property uchar label\n", "", {"3 0 1 3 16", "3 3 1 2 0"});
  EXPECT_EQ(read("jaw.ply", file), (ToothLabels{16, 0}));
  EXPECT_EQ(read("JAW.PLY", file), (ToothLabels{16, 0}));
  EXPECT_EQ(read("jaw.ply", ply("property int label\n", "property int ToothNumber\n", "21 21 21 21",
                                {"3 0 1 3 16", "3 3 1 2 15"})),
            (ToothLabels{16, 15}))
      << "faces before vertices";
}

TEST(LabelsOfPly, OfAPolygonAreOfAllItsTriangles) {
  EXPECT_EQ(read("jaw.ply", ply("", "property int tooth\n", "", {"4 0 1 2 3 32"}),
                 ToothNumbers::kUniversal),
            (ToothLabels{32, 32}));
}

TEST(LabelsOfPly, OfVerticesAreInTheFilesOrder) {
  EXPECT_EQ(read("jaw.ply", ply("property int LABEL\n", "", "11 11 12 12", {"3 0 1 3", "3 3 1 2"})),
            (ToothLabels{11, 12}));
  EXPECT_EQ(read("jaw.ply", ply("property int label\n", "", "11 12 13 13", {"3 0 1 3", "3 3 1 2"})),
            (ToothLabels{0, 13}))
      << "three teeth are none";
}

TEST(LabelsOfPly, OfBinaryFilesAreReadInEitherByteOrder) {
  for (const bool big : {false, true}) {
    std::string file = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                       "_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                       "property float z\nelement face 2\nproperty short label\n"
                       "property list uchar uchar vertex_indices\nproperty list uchar uchar other\n"
                       "end_header\n";
    const std::string one = big ? std::string("\x3F\x80\0\0", 4) : std::string("\0\0\x80\x3F", 4);
    const std::string zero(4, '\0');
    file += zero + zero + zero + one + zero + zero + one + one + zero + zero + one + zero;
    const auto face = [&](char label, const char* corners) {
      file += big ? std::string{'\0', label} : std::string{label, '\0'};
      file += '\3';
      file.append(corners, 3);
      file += std::string("\2ab");
    };
    face(47, "\0\1\3");
    face(48, "\3\1\2");
    EXPECT_EQ(read("jaw.ply", file), (ToothLabels{47, 48})) << big;
  }
}

TEST(LabelsOfPly, ThatTellNothingAreRefused) {
  const auto said = [](const std::string& file, const char* expected) {
    const std::string text = refusal("jaw.ply", file);
    EXPECT_NE(text.find(expected), text.npos) << text;
  };
  const std::vector<std::string> faces = {"3 0 1 3", "3 3 1 2"};
  said(ply("", "", "", faces), "no property of faces or vertices is named label or tooth");
  said(ply("", "property float label\n", "", {"3 0 1 3 11", "3 3 1 2 11"}),
       "'label' of a face is not one whole number");
  said(ply("", "property list uchar int label\n", "", {"3 0 1 3 1 11", "3 3 1 2 1 11"}),
       "'label' of a face is not one whole number");
  said(ply("", "property int label\nproperty int tooth\n", "", {"3 0 1 3 11 1", "3 3 1 2 11 1"}),
       "'label' and 'tooth' may both be");
  said(ply("", "property int label\n", "", {"3 0 1 3 11", "3 3 1 2 19"}), "face 1 is 19: FDI");
  said(ply("property int label\n", "", "11 11 11 19", faces), "vertex 3 is 19: FDI");
  said(ply("property int label\n", "", "11 11 11 11", {"4 0 1 2 3"}), "triangulate the mesh");
  said(ply("", "property int label\n", "", {"3 0 1 3 11"}), "1 labels for a mesh of 2 triangles");
  said(ply("", "property int label\n", "", {"3 0 1 3 11", "3 3 1 9 11"}), "names vertex 9");
  said("ply\nformat", "jaw.ply");
  said("", "jaw.ply");
}

std::string obj(const std::string& groups) {
  return "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n" + groups;
}

TEST(LabelsOfObj, AreGroupsOrObjectsByTheirNumber) {
  EXPECT_EQ(read("jaw.obj", obj("g 16\nf 1 2 4\ng gum\nf 4 2 3\n")), (ToothLabels{16, 0}));
  EXPECT_EQ(read("jaw.obj", obj("f 1 2 4\ng upper tooth_16 smooth # 11\nf 4 2 \\\n 3\n")),
            (ToothLabels{0, 16}));
  EXPECT_EQ(read("jaw.obj", obj("o T_5\nf 1/1/1 2/2/2 3//3 4\n"), ToothNumbers::kUniversal),
            (ToothLabels{5, 5}));
  EXPECT_EQ(read("jaw.obj", obj("g 16\ng\nf 1 2 4\ng 0\ng FDI_15 15\nf 4 2 3\n")),
            (ToothLabels{0, 15}));
}

TEST(LabelsOfObj, ThatTellNothingAreRefused) {
  const auto said = [](const std::string& groups, const char* expected) {
    const std::string text = refusal("jaw.obj", obj(groups));
    EXPECT_NE(text.find(expected), text.npos) << text;
  };
  said("f 1 2 4\ng gum\nf 4 2 3\n", "no group is named by a tooth's number");
  for (const char* name : {"UR6", "16.001", "tooth16", "16b", "1_6", "-16", "a.16", "6_"}) {
    said(std::string("g ") + name + "\nf 1 2 4\nf 4 2 3\n", "line 5 names the group");
  }
  said("f 1 2 4\ng 19\nf 4 2 3\n", "line 6 is 19: FDI");
  said("g 11 12\nf 1 2 4\nf 4 2 3\n", "line 5 names tooth 11 and tooth 12");
  said("g 11\nf 1 2 4\n", "1 labels for a mesh of 2 triangles");
  said("g 11\nf 1 2 4\nf 4 2 9\n", "names vertex 9");
  said("g 99999999999999999999\nf 1 2 4\n", "jaw.obj");
}

}  // namespace
}  // namespace ist::test
