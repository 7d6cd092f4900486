// Legacy VTK PolyData: its versions, sections and types, and every field that may be wrong.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "ist/base/error.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/mesh.h"
#include "support/errors.h"
#include "support/largest_allocation.h"
#include "support/mesh_files.h"
#include "support/shapes.h"

namespace ist {
namespace {

using test::corners;
using test::replaced;

constexpr const char* kVtkHead = "# vtk DataFile Version 4.2\ntitle\nASCII\nDATASET POLYDATA\n";
constexpr const char* kVtkBinary = "# vtk DataFile Version 4.2\ntitle\nBINARY\nDATASET POLYDATA\n";
// A square of side 2 and a corner above it.
constexpr const char* kVtkPoints = "POINTS 5 double\n0 0 0 2 0 0 2 2 0 0 2 0 1 1 0.1\n";
constexpr const char* kVtkFan = "POLYGONS 2 9\n4 0 1 2 3\n3 0 1 4\n";

template <class T>
std::string big_endian(std::vector<T> numbers) {
  std::string bytes;
  for (T number : numbers) {
    char raw[sizeof(T)];
    std::memcpy(raw, &number, sizeof(T));
    std::reverse(raw, raw + sizeof(T));
    bytes.append(raw, sizeof(T));
  }
  return bytes;
}

TriangleMesh read_vtk_bytes(std::string_view bytes) { return read_content(bytes, "mesh.vtk"); }

// The error's code and text, behind the file's name.
std::string vtk_refusal(std::string_view bytes) {
  const auto error = test::error_of([&] { static_cast<void>(read_content(bytes, "mesh.vtk")); });
  if (!error) return "fine";
  return std::string(to_string(error->code())) + (error->what() + std::strlen("mesh.vtk"));
}

std::string plain_vtk() { return std::string(kVtkHead) + kVtkPoints + kVtkFan; }

const std::vector<std::array<double, 9>> kVtkExpected = {
    {0, 0, 0, 2, 0, 0, 2, 2, 0}, {0, 0, 0, 2, 2, 0, 0, 2, 0}, {0, 0, 0, 2, 0, 0, 1, 1, 0.1}};

TEST(Vtk, ReadsPolygonsOfText) {
  EXPECT_EQ(corners(read_vtk_bytes(plain_vtk())), kVtkExpected) << "a double stays a double";
  EXPECT_EQ(corners(read_vtk_bytes(replaced(plain_vtk(), "\n", "\r\n"))), kVtkExpected);
  EXPECT_EQ(corners(read_vtk_bytes(replaced(plain_vtk(), "POLYGONS", "polygons"))), kVtkExpected);
  EXPECT_EQ(corners(read_vtk_bytes(std::string(kVtkHead) + kVtkFan + kVtkPoints)), kVtkExpected);
  const auto narrow = corners(read_vtk_bytes(replaced(plain_vtk(), "double", "float")));
  EXPECT_EQ(narrow[2][8], double{0.1f});
  EXPECT_EQ(corners(read_vtk_bytes(std::string(kVtkHead) + kVtkPoints +
                                   "POLYGONS 3 7\nOFFSETS vtktypeint64\n0 4 7\nCONNECTIVITY "
                                   "vtktypeint64\n0 1 2 3 0 1 4\n")),
            kVtkExpected);
}

TEST(Vtk, ReadsBytesOfEveryType) {
  const auto mesh = [](const std::string& type, const std::string& points) {
    return std::string(kVtkBinary) + "POINTS 4 " + type + "\n" + points + "\nPOLYGONS 1 5\n" +
           big_endian<std::int32_t>({4, 0, 1, 2, 3}) + "\n";
  };
  const std::vector<std::array<double, 9>> square = {kVtkExpected[0], kVtkExpected[1]};
  const std::vector<int> numbers = {0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0};
  const auto expect = [&]<class T>(const char* type, T) {
    const std::string bytes =
        mesh(type, big_endian(std::vector<T>(numbers.begin(), numbers.end())));
    EXPECT_EQ(corners(read_vtk_bytes(bytes)), square) << type;
  };
  expect("char", std::int8_t{});
  expect("signed_char", std::int8_t{});
  expect("unsigned_char", std::uint8_t{});
  expect("short", std::int16_t{});
  expect("unsigned_short", std::uint16_t{});
  expect("int", std::int32_t{});
  expect("unsigned_int", std::uint32_t{});
  expect("vtkIdType", std::int32_t{});
  expect("vtktypeint64", std::int64_t{});
  expect("vtktypeuint64", std::uint64_t{});
  expect("float", 0.0f);
  expect("double", 0.0);
  // A long has the size of the machine that wrote it.
  expect("long", std::int64_t{});
  expect("long", std::int32_t{});
  expect("unsigned_long", std::uint64_t{});
  expect("unsigned_long", std::uint32_t{});
}

TEST(Vtk, TurnsEveryOtherTriangleOfAStrip) {
  const std::string strips =
      "POINTS 5 float\n0 0 0 1 0 0 0 1 0 1 1 0 2 1 0\nTRIANGLE_STRIPS 2 11\n4 0 1 2 3\n5 1 3 3 4 "
      "0\n";
  const auto mesh = read_vtk_bytes(kVtkHead + strips);
  EXPECT_EQ(corners(mesh), (std::vector<std::array<double, 9>>{{0, 0, 0, 1, 0, 0, 0, 1, 0},
                                                               {0, 1, 0, 1, 0, 0, 1, 1, 0},
                                                               {1, 1, 0, 2, 1, 0, 0, 0, 0}}))
      << "triangles with a corner twice are left out";
}

// What is no surface is passed over; polygons come before strips.
TEST(Vtk, PassesOverOtherSections) {
  const std::string text =
      std::string(kVtkHead) +
      "FIELD FieldData 3\nSPACE 1 1 string\nLPS\n\nTimes 1 1 double\n3.5\nMETADATA\n"
      "INFORMATION 0\n\nNULL_ARRAY\nTRIANGLE_STRIPS 1 4\n3 0 1 4\nVERTICES 2 4\n1 0 1 3\nLINES 1 "
      "4\n3 0 1 2\n" +
      kVtkPoints +
      "METADATA\nCOMPONENT_NAMES\n\nPOLYGONS 9 9\n\nINFORMATION 1\nNAME X LOCATION Y\nDATA 1 2\n\n"
      "POLYGONS 1 5\n4 0 1 2 3\nPOINT_DATA 5\nSCALARS whatever\n";
  const TriangleMesh mesh = read_vtk_bytes(text);
  EXPECT_EQ(corners(mesh), kVtkExpected);
  EXPECT_EQ(mesh.frame, PatientFrame::kLps);
  const std::string string = std::string("\xC3", 1) + "RAS", longer = std::string("\x40\0\0\2", 4);
  const std::string binary = std::string(kVtkBinary) + "FIELD FieldData 3\nSPACE 1 1 string\n" +
                             string + "\nb%20c 2 2 string\n" + string + longer + "ab" + string +
                             std::string("\xC0", 1) + "\nbits 3 3 bit\n12\n" + "POINTS 3 float\n" +
                             big_endian<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) + "\nPOLYGONS 1 4\n" +
                             big_endian<std::int32_t>({3, 0, 1, 2}) + "\n";
  EXPECT_EQ(read_vtk_bytes(binary).frame, PatientFrame::kRas);
}

TEST(Vtk, ReadsTheFrameOfTheTitle) {
  const auto titled = [](const char* title) { return replaced(plain_vtk(), "title", title); };
  EXPECT_EQ(read_vtk_bytes(titled("3D Slicer output. SPACE=RAS")).frame, PatientFrame::kRas);
  EXPECT_EQ(read_vtk_bytes(titled("3D Slicer output. SPACE=LPS")).frame, PatientFrame::kLps);
  EXPECT_EQ(read_vtk_bytes(titled("")).frame, PatientFrame::kUnknown);
  const std::string both = replaced(titled("SPACE=RAS"), "POINTS 5",
                                    "FIELD FieldData 1\nSPACE 1 1 string\nLPS\nPOINTS 5");
  EXPECT_TRUE(
      vtk_refusal(both).starts_with("not-a-mesh: the file says both SPACE=RAS and SPACE=LPS"));
}

TEST(Vtk, OtherDatasetsAreRefusedByTheirName) {
  EXPECT_EQ(
      vtk_refusal(replaced(plain_vtk(), "POLYDATA", "UNSTRUCTURED_GRID")),
      "not-a-mesh: the file is a VTK UNSTRUCTURED_GRID, and only PolyData is read; extract its "
      "surface (in ParaView: Extract Surface) and save it as PolyData");
  EXPECT_TRUE(vtk_refusal(replaced(plain_vtk(), "DATASET POLYDATA", "FIELD x 1"))
                  .starts_with("not-a-mesh: the file is a VTK FIELD, and only"));
}

TEST(Vtk, ErrorsNameTheLineAndTheRemedy) {
  const std::string text = plain_vtk();
  for (
      const auto& [from, to, expected] :
      std::vector<std::tuple<std::string, std::string, std::string>>{
          {"ASCII", "EBCDIC",
           "not-a-mesh: line 3: 'EBCDIC' is neither ASCII nor BINARY; export the mesh again"},
          {"1 1 0.1", "1 one 0.1",
           "not-a-mesh: line 6: 'one' is not a number; export the mesh again"},
          {"1 1 0.1", "1 1 nan",
           "mesh-not-finite: line 6: a coordinate is not finite, or beyond a float's range; repair "
           "the mesh where it was made"},
          {"POINTS 5", "POINTS five",
           "not-a-mesh: line 5: 'five' is not a count; export the mesh again"},
          {"POINTS 5", "POINTS -5",
           "not-a-mesh: line 5: '-5' is not a count; export the mesh again"},
          {"double", "quad",
           "not-a-mesh: line 5: 'quad' is not a type of numbers that is read; export the mesh "
           "again"},
          {"POINTS 5", "POINTS 4",
           "not-a-mesh: line 6: '1' is not expected here; export the mesh again"},
          {"3 0 1 4", "3 0 1 5",
           "mesh-bad-index: line 9: a face names point 5, but there are 5, counted from 0; export "
           "the "
           "mesh again"},
          {"3 0 1 4", "3 0 1 -1",
           "mesh-bad-index: line 9: a face names point -1, but there are 5, counted from 0; export "
           "the mesh again"},
          {"3 0 1 4", "3 0 1 0.5",
           "mesh-bad-index: line 9: a face names point 0.5, but there are 5, counted from 0; "
           "export "
           "the mesh again"},
          {"3 0 1 4", "4 0 1 4",
           "not-a-mesh: line 9: the list of 9 numbers is not 2 cells; export the mesh again"},
          {"3 0 1 4", "-3 0 1 4",
           "not-a-mesh: line 9: the list of 9 numbers is not 2 cells; export the mesh again"},
          {"POLYGONS 2", "POLYGONS 1",
           "not-a-mesh: line 9: the list of 9 numbers is not 1 cells; export the mesh again"},
          {"POLYGONS 2 9", "POLYGONS 3 9",
           "not-a-mesh: line 10: the list holds 2 of 3 cells; export the mesh again"},
          {"POLYGONS 2 9", "POLYGONS 2 8",
           "not-a-mesh: line 9: the list of 8 numbers is not 2 cells; export the mesh again"},
          {"POLYGONS 2 9", "POLYGONS 2 10",
           "mesh-truncated: POLYGONS: the file ends within this section; copy or export it again"},
          {"4 0 1 2 3\n3 ", "2 0 1\n5 2 3 ",
           "not-a-mesh: line 8: a face has 2 corners, and needs three; export the mesh again"},
          {kVtkFan, "VERTICES 1 2\n1 0\n",
           "mesh-points-only: the file has 5 points, but no polygon or strip; export the surface "
           "as "
           "polygons"},
          {std::string(kVtkPoints) + kVtkFan, "POINTS 0 float\n",
           "mesh-empty: the PolyData has no point; export the mesh again"}}) {
    const std::string changed = replaced(text, from, to);
    ASSERT_NE(changed, text) << from;
    EXPECT_EQ(vtk_refusal(changed), expected) << to;
  }
}

TEST(Vtk, RefusesOffsetsThatAreNone) {
  const std::string head = std::string(kVtkHead) + kVtkPoints + "POLYGONS ";
  const auto cells = [&](const std::string& counts, const std::string& offsets,
                         const std::string& corners_of) {
    return vtk_refusal(head + counts + "\nOFFSETS int\n" + offsets + "\nCONNECTIVITY int\n" +
                       corners_of + "\n");
  };
  EXPECT_EQ(cells("3 7", "0 4 7", "0 1 2 3 0 1 4"), "fine");
  EXPECT_EQ(cells("3 7", "0 7 4", "0 1 2 3 0 1 4"),
            "not-a-mesh: line 9: the offset 4 follows 7, and there are 7 corners; export the mesh "
            "again");
  EXPECT_EQ(cells("3 7", "1 4 7", "0 1 2 3 0 1 4"),
            "not-a-mesh: line 9: the offset 1 follows 0, and there are 7 corners; export the mesh "
            "again");
  EXPECT_EQ(cells("3 7", "0 4 8", "0 1 2 3 0 1 4"),
            "not-a-mesh: line 9: the offset 8 follows 4, and there are 7 corners; export the mesh "
            "again");
  EXPECT_EQ(cells("3 7", "0 3 6", "0 1 2 3 0 1 4"),
            "not-a-mesh: line 10: the last offset is 6, but there are 7 corners; export the mesh "
            "again");
  EXPECT_TRUE(cells("3 7", "0 4 7", "0 1 2 3 0 1 5").starts_with("mesh-bad-index: line 11: "));
  EXPECT_TRUE(cells("9 7", "0 4 7", "0 1 2 3 0 1 4").starts_with("not-a-mesh: line 10: "));
  EXPECT_TRUE(cells("0 0", "", "").starts_with("mesh-points-only: "));
}

// In bytes an error names the section.
TEST(Vtk, BytesAreCheckedLikeText) {
  const auto mesh = [](const std::string& points, const std::string& list) {
    return std::string(kVtkBinary) + "POINTS 3 float\n" + points + "\nPOLYGONS 1 4\n" + list + "\n";
  };
  const std::string points = big_endian<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const std::string list = big_endian<std::int32_t>({3, 0, 1, 2});
  EXPECT_EQ(vtk_refusal(mesh(points, list)), "fine");
  EXPECT_EQ(
      vtk_refusal(mesh(big_endian<float>({0, 0, 0, INFINITY, 0, 0, 0, 1, 0}), list)),
      "mesh-not-finite: POINTS: a coordinate is not finite, or beyond a float's range; repair "
      "the mesh where it was made");
  EXPECT_TRUE(vtk_refusal(mesh(points, big_endian<std::int32_t>({3, 0, 1, 3})))
                  .starts_with("mesh-bad-index: POLYGONS: a face names point 3"));
  EXPECT_TRUE(vtk_refusal(mesh(points, big_endian<std::int32_t>({4, 0, 1, 2})))
                  .starts_with("not-a-mesh: POLYGONS: the list of 4 numbers is not 1 cells"));
  EXPECT_TRUE(vtk_refusal(mesh(points, list) + "SOLIDS 1 1")
                  .starts_with("not-a-mesh: SOLIDS: 'SOLIDS' is not expected here"));
  EXPECT_TRUE(vtk_refusal(mesh(points, list) + "POINTS 0 float\n")
                  .starts_with("not-a-mesh: POINTS: 'POINTS' stands twice"));
}

TEST(Vtk, BelievesNoCountThatTheFileDoesNotHold) {
  for (const char* head : {kVtkHead, kVtkBinary}) {
    for (const char* many :
         {"1000000", "4294967296", "9223372036854775807", "6148914691236517206"}) {
      for (const std::string& section :
           {std::string("POINTS ") + many + " float\n",
            std::string("POLYGONS ") + many + " 4\n3 0 1 2\n",
            std::string("POLYGONS 1 ") + many + "\n3 0 1 2\n",
            std::string("POLYGONS ") + many + " 3\nOFFSETS int\n0 3\n",
            std::string("FIELD f ") + many + "\na 1 1 int\n",
            std::string("FIELD f 1\na ") + many + " " + many + " bit\n",
            std::string("FIELD f 1\na 1 ") + many + " string\n"}) {
        std::string text;
        const std::size_t most = test::largest_allocation(
            [&] { text = vtk_refusal(head + section + "0 0 0 1 0 0 0 1 0\n"); });
        EXPECT_LT(most, std::size_t{1} << 17) << section;
        EXPECT_TRUE(text.starts_with("mesh-truncated: ") || text.starts_with("not-a-mesh: "))
            << text;
      }
    }
  }
}

// A file that ends before its polygons is a file of points.
TEST(Vtk, RefusesEveryCut) {
  const TriangleMesh one = test::triangle({1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  const std::string field = "FIELD FieldData 1\nSPACE 1 1 string\nRAS\n";
  for (const std::string& text :
       {kVtkHead + field + kVtkPoints + "METADATA\nINFORMATION 0\n\n" + kVtkFan, test::as_vtk(one),
        test::as_binary_vtk(one)}) {
    for (std::size_t size = std::strlen("# vtk DataFile"); size + 1 < text.size(); ++size) {
      const std::string found = vtk_refusal(text.substr(0, size));
      const bool is_right = found.starts_with("mesh-truncated: ") ||
                            found.starts_with("mesh-empty: ") ||
                            found.starts_with("mesh-points-only: ");
      EXPECT_TRUE(is_right) << found << " at " << size << " of " << text;
    }
  }
}

}  // namespace
}  // namespace ist
