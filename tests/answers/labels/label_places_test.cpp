#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "answers/labels/label_cases.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using answers::ToothLabels, answers::ToothNumbers;

std::string vertices_of(const TriangleMesh& mesh) {
  std::string text;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    text += "v " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " +
            std::to_string(v.z()) + "\n";
  }
  return text;
}

std::string face(const Triangle& t) {
  return "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
         std::to_string(t[2] + 1) + "\n";
}

// A box whose triangles are of two teeth in turn, in a file whose faces are sorted by tooth.
const TriangleMesh kBox = box({-1, -2, 0}, {3, 1, 5});
ToothLabels labels_in_turn() {
  ToothLabels labels;
  for (std::size_t i = 0; i < kBox.triangles.size(); ++i) labels.push_back(i % 2 == 0 ? 16 : 26);
  return labels;
}
std::string sorted_by_tooth() {
  const ToothLabels labels = labels_in_turn();
  std::string text = vertices_of(kBox);
  for (const int tooth : {26, 16}) {
    text += "g " + std::to_string(tooth) + "\n";
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (labels[i] == tooth) text += face(kBox.triangles[i]);
    }
  }
  return text;
}

TEST(LabelPlaces, GiveTheLabelsOfFacesInAnotherOrder) {
  EXPECT_EQ(labels_by("jaw.obj", sorted_by_tooth(), ToothNumbers::kFdi, kBox), labels_in_turn());
}

TEST(LabelPlaces, AreTheSameForTurnedTrianglesAndOtherFirstCorners) {
  TriangleMesh mesh = inside_out(kBox);
  for (Triangle& t : mesh.triangles) std::rotate(t.begin(), t.begin() + 1, t.end());
  EXPECT_EQ(labels_by("jaw.obj", sorted_by_tooth(), ToothNumbers::kFdi, mesh), labels_in_turn());
}

TEST(LabelPlaces, AreComparedAsFloats) {
  TriangleMesh mesh = kBox;
  for (Eigen::Vector3d& v : mesh.vertices) v *= 1 + 1e-12;
  mesh.vertices[0].z() = -0.0;
  EXPECT_EQ(labels_by("jaw.obj", sorted_by_tooth(), ToothNumbers::kFdi, mesh), labels_in_turn());
}

TEST(LabelPlaces, MayBeOfMoreThanIsMeasured) {
  TriangleMesh mesh = kBox;
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 3);
  const ToothLabels all = labels_in_turn();
  EXPECT_EQ(labels_by("jaw.obj", sorted_by_tooth(), ToothNumbers::kFdi, mesh),
            ToothLabels(all.begin() + 3, all.end()));
}

TEST(LabelPlaces, OfAnotherMeshAreRefused) {
  TriangleMesh mesh = kBox;
  mesh.vertices[0].x() += 1e-3;
  const auto of_corner = std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [](auto& t) {
    return std::count(t.begin(), t.end(), 0u) > 0;
  });
  const std::string text = refusal_of("jaw.obj", sorted_by_tooth(), ToothNumbers::kFdi, mesh);
  EXPECT_NE(text.find(std::to_string(of_corner) + " of the 12 triangles measured are not in it: "
                                                  "label the mesh that is measured"),
            text.npos)
      << text;
}

TEST(LabelPlaces, OfTwoTeethAreRefused) {
  const std::string file = vertices_of(kPair) + "g 11\nf 1 2 3\nf 3 2 4\ng ";
  EXPECT_EQ(labels_by("jaw.obj", file + "11\nf 3 2 1\n"), (ToothLabels{11, 11})) << "as one";
  for (const char* other : {"12", "gum"}) {
    const std::string text = refusal_of("jaw.obj", file + other + "\nf 3 2 1\n");
    EXPECT_NE(text.find("in one place"), text.npos) << text;
  }
}

}  // namespace
}  // namespace ist::test
