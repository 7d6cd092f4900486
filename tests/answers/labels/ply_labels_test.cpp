#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "answers/labels/label_cases.h"

namespace ist::test {
namespace {

using answers::ToothLabels, answers::ToothNumbers;

// The square's corners in their order round it.
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

TEST(LabelsOfPly, AreAPropertyOfFaces) {
  const std::string file = ply("", "property uchar label\n", "", {"3 0 1 3 16", "3 3 1 2 0"});
  EXPECT_EQ(labels_by("jaw.ply", file), (ToothLabels{16, 0}));
  EXPECT_EQ(labels_by("JAW.PLY", file), (ToothLabels{16, 0}));
  EXPECT_EQ(labels_by("jaw.ply", ply("property int label\n", "property int ToothNumber\n",
                                     "21 21 21 21", {"3 0 1 3 16", "3 3 1 2 15"})),
            (ToothLabels{16, 15}))
      << "faces before vertices";
}

TEST(LabelsOfPly, OfAPolygonAreOfAllItsTriangles) {
  const TriangleMesh fan = {kPair.vertices, {{0, 1, 3}, {0, 3, 2}}};
  EXPECT_EQ(labels_by("jaw.ply", ply("", "property int tooth\n", "", {"4 0 1 2 3 32"}),
                      ToothNumbers::kUniversal, fan),
            (ToothLabels{32, 32}));
}

TEST(LabelsOfPly, OfVerticesAreInTheFilesOrder) {
  EXPECT_EQ(
      labels_by("jaw.ply", ply("property int LABEL\n", "", "11 11 12 12", {"3 0 1 3", "3 3 1 2"})),
      (ToothLabels{11, 12}));
  EXPECT_EQ(
      labels_by("jaw.ply", ply("property int label\n", "", "11 12 13 13", {"3 0 1 3", "3 3 1 2"})),
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
    EXPECT_EQ(labels_by("jaw.ply", file), (ToothLabels{47, 48})) << big;
  }
}

TEST(LabelsOfPly, ThatTellNothingAreRefused) {
  const auto said = [](const std::string& file, const char* expected) {
    const std::string text = refusal_of("jaw.ply", file);
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
  said(ply("", "property int label\n", "", {"3 0 1 3 11"}),
       "1 of the 2 triangles measured are not in it");
  said(ply("", "property int label\n", "", {"3 0 1 3 11", "3 3 1 9 11"}), "names vertex 9");
  said("ply\nformat", "jaw.ply");
  said("", "jaw.ply");
}

}  // namespace
}  // namespace ist::test
