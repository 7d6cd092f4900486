#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "answers/labels/label_cases.h"
#include "support/mesh_files.h"

namespace ist::test {
namespace {

using answers::ToothLabels, answers::ToothNumbers;

// The square as two triangles, as one polygon, and as a strip; a line and a vertex come before.
constexpr const char* kVtkSquare =
    "# vtk DataFile Version 4.2\nlabelled\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n"
    "0 0 0 1 0 0 1 1 0 0 1 0\n";
constexpr const char* kVtkTriangles = "VERTICES 1 2\n1 0\nPOLYGONS 2 8\n3 0 1 3\n3 3 1 2\n";

std::string vtk_square(const std::string& data, const std::string& cells = kVtkTriangles) {
  return kVtkSquare + cells + data;
}

// The labels by FILE:ARRAY.
ToothLabels labels_by_array(const std::string& name, const std::string& content,
                            const std::string& array, ToothNumbers numbers = ToothNumbers::kFdi) {
  const TempDir dir;
  return answers::read_labels(dir.write(name, content).string() + ":" + array, kPair, numbers);
}

std::string refusal_by_array(const std::string& content, const std::string& array) {
  const auto error = error_of([&] { (void)labels_by_array("jaw.vtk", content, array); });
  if (!error) return "not refused";
  const std::string text = error->what();
  return text.substr(text.find("jaw.vtk"));
}

TEST(LabelsOfVtk, AreAnArrayOfCells) {
  const std::string file = vtk_square(
      "CELL_DATA 3\nFIELD FieldData 2\nLabel 1 3 int\n0 16 15\nother 1 3 short\n1 2 3\n");
  EXPECT_EQ(labels_by_array("jaw.vtk", file, "Label"), (ToothLabels{16, 15}));
  EXPECT_EQ(labels_by_array("JAW.VTK", file, "Label"), (ToothLabels{16, 15}));
  EXPECT_EQ(labels_by_array("jaw.vtk", replaced(file, "Label", "a%20b:c"), "a b:c"),
            (ToothLabels{16, 15}));
  EXPECT_EQ(labels_by_array("jaw.vtk", replaced(file, "int", "double"), "Label"),
            (ToothLabels{16, 15}))
      << "whole numbers of another type, by name";
  EXPECT_EQ(labels_by_array("jaw.vtk", file, "other", ToothNumbers::kUniversal),
            (ToothLabels{2, 3}));
}

TEST(LabelsOfVtk, OfAPolygonOrStripAreOfAllItsTriangles) {
  const TriangleMesh fan = {kPair.vertices, {{0, 1, 3}, {0, 3, 2}}};
  EXPECT_EQ(labels_by("jaw.vtk",
                      vtk_square("CELL_DATA 2\nSCALARS label int\nLOOKUP_TABLE default\n0 32\n",
                                 "LINES 1 3\n2 0 1\nPOLYGONS 1 5\n4 0 1 2 3\n"),
                      ToothNumbers::kUniversal, fan),
            (ToothLabels{32, 32}));
  EXPECT_EQ(labels_by("jaw.vtk", vtk_square("CELL_DATA 1\nSCALARS label int\n21\n",
                                            "TRIANGLE_STRIPS 1 6\n5 0 0 1 3 2\n")),
            (ToothLabels{21, 21}))
      << "a corner stands twice";
  EXPECT_EQ(
      labels_by("jaw.vtk", vtk_square("CELL_DATA 2\nSCALARS label int\n11 12\n",
                                      "TRIANGLE_STRIPS 1 4\n3 0 1 3\nPOLYGONS 1 4\n3 3 1 2\n")),
      (ToothLabels{12, 11}))
      << "polygons come before strips";
}

TEST(LabelsOfVtk, OfPointsAreThoseOfTwoCorners) {
  const std::string cells = "POLYGONS 2 8\n3 0 1 3\n3 3 1 2\n";
  EXPECT_EQ(labels_by("jaw.vtk",
                      vtk_square("POINT_DATA 4\nSCALARS Universal_ID int\n11 12 13 11\n", cells)),
            (ToothLabels{11, 0}));
  EXPECT_EQ(labels_by_array("jaw.vtk",
                            vtk_square("POINT_DATA 4\nSCALARS label int\n11 11 11 11\n"
                                       "CELL_DATA 2\nSCALARS label int\n21 22\n",
                                       cells),
                            "label"),
            (ToothLabels{21, 22}))
      << "cells before points";
  EXPECT_NE(
      refusal_of("jaw.vtk", vtk_square("POINT_DATA 4\nSCALARS label int\n11 11 11 11\n",
                                       "POLYGONS 1 5\n4 0 1 2 3\n"))
          .find("cell 0 has 4 corners, and labels of points need three: triangulate the mesh, "
                "or label its cells"),
      std::string::npos);
}

// All that may stand before the label.
TEST(LabelsOfVtk, AreFoundBehindOtherData) {
  EXPECT_EQ(
      labels_by("jaw.vtk",
                vtk_square(
                    "POINT_DATA 4\nSCALARS s float 2\nLOOKUP_TABLE default\n1 2 3 4 5 6 7 8\n"
                    "LOOKUP_TABLE t 2\n0 0 0 1 1 1 1 1\nNORMALS n float\n0 0 1 0 0 1 0 0 1 0 0 "
                    "1\nMETADATA\nINFORMATION 0\n\nTEXTURE_COORDINATES c 2 float\n1 2 3 4 5 6 7 8\n"
                    "COLOR_SCALARS c 1\n0 1 0.5 1\nCELL_DATA 3\nVECTORS v double\n1 2 3 4 5 6 7 "
                    "8 9\nTENSORS t float\n1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9\n"
                    "FIELD f 3\nnames 1 3 string\n\na%20b\nc\nflag 1 3 bit\n1 0 1\nPredictedID 1 3 "
                    "vtktypeint64\n0 16 15\n")),
      (ToothLabels{16, 15}));
}

TEST(LabelsOfVtk, AreFoundInBinaryFiles) {
  const auto bytes = [](std::initializer_list<int> values, int size) {
    std::string raw;
    for (const int value : values)
      raw += std::string(static_cast<std::size_t>(size - 1), '\0') + static_cast<char>(value);
    return raw;
  };
  const std::string zero(48, '\0');
  for (const auto& [type, size] : std::vector<std::pair<std::string, int>>{{"unsigned_char", 1},
                                                                           {"short", 2},
                                                                           {"int", 4},
                                                                           {"vtkIdType", 4},
                                                                           {"long", 8},
                                                                           {"long", 4},
                                                                           {"vtktypeint64", 8}}) {
    const std::string file =
        "# vtk DataFile Version 4.2\nlabelled\nBINARY\nDATASET POLYDATA\nPOINTS 4 unsigned_char\n" +
        bytes({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 1) + "\nPOLYGONS 2 8\n" +
        bytes({3, 0, 1, 3, 3, 3, 1, 2}, 4) + "\nPOINT_DATA 4\nSCALARS s float\n" +
        zero.substr(0, 16) + "\nLOOKUP_TABLE t 2\n" + zero.substr(0, 8) + "\nCOLOR_SCALARS c 3\n" +
        zero.substr(0, 12) + "\nCELL_DATA 2\nSCALARS Label " + type + "\nLOOKUP_TABLE default\n" +
        bytes({16, 15}, size) + "\nFIELD f 1\nbits 9 1 bit\n" + zero.substr(0, 2) + "\n";
    EXPECT_EQ(labels_by("jaw.vtk", file), (ToothLabels{16, 15})) << type << size;
  }
}

TEST(LabelsOfVtk, AreReadFromXml) {
  const auto vtp = [](const std::string& label) {
    return "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"4\" NumberOfVerts=\"1\" "
           "NumberOfPolys=\"2\"><PointData><DataArray type=\"String\" Name=\"remark\">0</DataArray>"
           "<DataArray type=\"Int8\" Name=\"rgb\" NumberOfComponents=\"3\">1 2 3 4 5 6 7 8 9 1 2 3"
           "</DataArray></PointData><CellData>" +
           label +
           "</CellData><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0 1 0 0 1 "
           "1 0 0 1 "
           "0</DataArray></Points><Polys><DataArray type=\"Int32\" Name=\"connectivity\">0 1 3 3 1 "
           "2"
           "</DataArray><DataArray type=\"Int32\" Name=\"offsets\">3 6</DataArray></Polys></Piece>"
           "</PolyData></VTKFile>\n";
  };
  const std::string file = vtp("<DataArray type=\"Int64\" Name=\"Label\">0 16 15</DataArray>");
  EXPECT_EQ(labels_by("jaw.vtp", file), (ToothLabels{16, 15}));
  EXPECT_EQ(labels_by_array("jaw.vtp", file, "Label"), (ToothLabels{16, 15}));
  EXPECT_NE(refusal_of("jaw.vtp", replaced(file, "0 16 15", "0 16"))
                .find("Label: the array holds 2 numbers for 3 cells"),
            std::string::npos);
  EXPECT_NE(refusal_of("jaw.vtp", vtp("")).find("its arrays of one number are none"),
            std::string::npos);
}

TEST(LabelsOfVtk, AreNotGuessed) {
  const std::string two = vtk_square(
      "CELL_DATA 3\nFIELD f 3\nLabel 1 3 int\n0 16 15\nArea 1 3 float\n1 2 3\nRegionId 1 3 "
      "short\n1 1 "
      "1\nPOINT_DATA 4\nSCALARS c int\n1 2 3 4\n");
  EXPECT_NE(
      refusal_of("jaw.vtk", two)
          .find("no array is clearly the label: name one, such as jaw.vtk:Label; its arrays of one "
                "number are 'Label' of cells, 'Area' of cells, 'RegionId' of cells, 'c' of points"),
      std::string::npos)
      << refusal_of("jaw.vtk", two);
  EXPECT_EQ(
      refusal_by_array(two, "Lable"),
      "jaw.vtk: no array is called 'Lable': its arrays of one number are 'Label' of cells, 'Area' "
      "of cells, 'RegionId' of cells, 'c' of points");
  EXPECT_NE(refusal_of("jaw.vtk", vtk_square("CELL_DATA 3\nSCALARS Region int\n1 1 1\n"))
                .find("no array is clearly the label"),
            std::string::npos);
  EXPECT_NE(refusal_of("jaw.vtk", vtk_square("CELL_DATA 3\nSCALARS Label float\n1 1 1\n"))
                .find("no array is clearly the label"),
            std::string::npos);
}

TEST(LabelsOfVtk, AreWholeNumbersOfTheSystem) {
  EXPECT_EQ(refusal_by_array(vtk_square("CELL_DATA 3\nSCALARS Label int\n0 16 19\n"), "Label")
                .find("jaw.vtk: cell 2 of 'Label' is 19: FDI numbers are"),
            0u);
  EXPECT_EQ(refusal_by_array(vtk_square("CELL_DATA 3\nSCALARS Label float\n0 1.5 16\n"), "Label"),
            "jaw.vtk: cell 1 of 'Label' is 1.5: write whole numbers");
  EXPECT_EQ(refusal_by_array(vtk_square("CELL_DATA 3\nSCALARS Label float\n0 nan 16\n"), "Label"),
            "jaw.vtk: cell 1 of 'Label' is inf: write whole numbers");
}

// A colon may stand in the name of a file that exists.
TEST(LabelsOfVtk, TheUniversalNumberOfTheGumIsNoTooth) {
  const std::string file =
      vtk_square("CELL_DATA 3\nFIELD FieldData 1\nUniversal_ID 1 3 int\n0 33 32\n");
  EXPECT_EQ(labels_by_array("jaw.vtk", file, "Universal_ID", ToothNumbers::kUniversal),
            (ToothLabels{0, 32}));
  EXPECT_EQ(labels_by_array("jaw.vtk", file, "Universal_ID"), (ToothLabels{33, 32}));
}

TEST(LabelsOfVtk, AFileThatExistsKeepsItsName) {
  const TempDir dir;
  const auto file = dir.write("jaw.vtk:Label", "16\n15\n");
  EXPECT_EQ(answers::read_labels(file, kPair, ToothNumbers::kFdi), (ToothLabels{16, 15}));
  const auto odd =
      dir.write("odd.vtp:x.vtk", vtk_square("CELL_DATA 3\nSCALARS Label int\n0 16 15\n"));
  EXPECT_EQ(answers::read_labels(odd, kPair, ToothNumbers::kFdi), (ToothLabels{16, 15}));
  EXPECT_EQ(answers::label_source("none.vtp:a:b").array, "a:b");
  EXPECT_EQ(answers::label_source("none.txt:a").file, "none.txt:a");
  EXPECT_EQ(answers::label_source("C:/none.vtk:a").file, "C:/none.vtk");
}

}  // namespace
}  // namespace ist::test
