// The formats that assimp reads, by ist-import: units, axes, placements, side files.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "import/scene_files.h"
#include "ist/base/error.h"
#include "ist/mesh/mesh.h"
#include "support/errors.h"
#include "support/mesh_files.h"
#include "support/shapes.h"
#include "support/temp_dir.h"

namespace ist {
namespace {

TriangleMesh read_as(const std::string& name, std::string_view bytes) {
  const test::TempDir folder;
  return read_mesh(folder.write(name, bytes));
}

std::string refusal_as(const std::string& name, std::string_view bytes) {
  const auto error = test::error_of([&] { static_cast<void>(read_as(name, bytes)); });
  if (!error) return "fine";
  const std::string text = error->what();
  return std::string(to_string(error->code())) + text.substr(text.find(": "));
}

// A closed mesh, wound outward, of that unit, box and volume.
void expect_box(const TriangleMesh& mesh, LengthUnit unit, const Eigen::Vector3d& low,
                const Eigen::Vector3d& high) {
  const MeshReport report = check_mesh(mesh);
  const double tolerance = 1e-6 * (high - low).maxCoeff();
  EXPECT_EQ(mesh.unit, unit);
  EXPECT_EQ(report.triangles, 12u);
  EXPECT_TRUE(report.closed && report.consistent);
  EXPECT_LE((report.box_min - low).cwiseAbs().maxCoeff(), tolerance) << report.box_min.transpose();
  EXPECT_LE((report.box_max - high).cwiseAbs().maxCoeff(), tolerance) << report.box_max.transpose();
  EXPECT_NEAR(report.signed_volume / (high - low).prod(), 1, 1e-5);
}

// assimp converts to metres, with y up.
TEST(ImportFormats, Collada) {
  const std::string mm = "<unit meter=\"0.001\" name=\"millimeter\"/>";
  expect_box(read_as("a.dae", test::box_dae(mm, "Y_UP")), LengthUnit::kMetre, {0, 0, 0},
             {0.001, 0.002, 0.003});
  expect_box(read_as("a.dae", test::box_dae("", "Y_UP")), LengthUnit::kMetre, {0, 0, 0}, {1, 2, 3});
  expect_box(read_as("a", test::box_dae(mm, "Z_UP")), LengthUnit::kMetre, {0, 0, -0.002},
             {0.001, 0.003, 0});
  expect_box(read_as("a.dae", test::box_dae("", "Y_UP",
                                            "<translate>5 0 0</translate><scale>-1 1 1"
                                            "</scale>")),
             LengthUnit::kMetre, {4, 0, 0}, {5, 2, 3});
  const std::string nested =
      "<translate>1 0 0</translate><node id=\"m\"><translate>0 0 10</translate>"
      "<instance_geometry url=\"#g\"/></node>";
  EXPECT_EQ(read_as("a.dae", test::box_dae("", "Y_UP", nested)).triangles.size(), 24u);
  EXPECT_EQ(check_mesh(read_as("a.dae", test::box_dae("", "Y_UP", nested))).box_max,
            Eigen::Vector3d(2, 2, 13));
  EXPECT_TRUE(refusal_as("a.dae", test::box_dae("", "Y_UP", "<instance_geometry url=\"#h\"/>"))
                  .starts_with("not-a-mesh: a part of it cannot be read (Collada: Unable to find "
                               "geometry for ID \"h\". Skipping); "));
  const std::string in_itself = test::box_dae("", "Y_UP", "<instance_node url=\"#n\"/>");
  EXPECT_TRUE(test::says_crash(refusal_as("a.dae", in_itself)));
}

TEST(ImportFormats, X3d) {
  expect_box(read_as("a.x3d", test::box_x3d()), LengthUnit::kMetre, {0, 0, 0}, {1, 2, 3});
  expect_box(read_as("a.x3d", test::box_x3d("<Transform scale='-1 1 1' translation='5 0 0'>",
                                            "</Transform>")),
             LengthUnit::kMetre, {4, 0, 0}, {5, 2, 3});
  for (const char* clockwise : {"ccw=\"false\"", "ccw = 'false'"})
    EXPECT_EQ(
        refusal_as("a.x3d", test::replaced(test::box_x3d(), "<IndexedFaceSet ",
                                           std::string("<IndexedFaceSet ") + clockwise + " ")),
        "not-a-mesh: its faces run clockwise (ccw=false), which is not supported; export "
        "them counterclockwise");
  EXPECT_TRUE(refusal_as("a.x3d", test::box_x3d("<LOD>", "</LOD>"))
                  .starts_with("not-a-mesh: a shape lies in <LOD>, which is not supported"));
  EXPECT_TRUE(refusal_as("a.x3d", "<X3D><Scene>").starts_with("not-a-mesh: it is no XML"));
  EXPECT_EQ(
      refusal_as("a.x3d", test::replaced(test::box_x3d(), "0 2 3 1 -1", "0 2 33 1 -1")),
      "mesh-bad-index: the scene, mesh 0: a face names vertex 33, but there are 8, counted from 0; "
      "export the mesh again");
  EXPECT_EQ(
      refusal_as("a.x3d",
                 "<X3D><Scene><Shape><IndexedLineSet coordIndex='0 1 -1'><Coordinate point='0 "
                 "0 0 1 0 0'/></IndexedLineSet></Shape></Scene></X3D>"),
      "not-a-mesh: it holds lines or points, which are taken for triangles; export the surface "
      "alone");
}

// The head of an X3D may scale its metres.
TEST(ImportFormats, X3dHasAUnit) {
  const auto with = [](const std::string& units) {
    return test::replaced(test::box_x3d(), "<Scene>", "<head>" + units + "</head><Scene>");
  };
  const std::string mm = "<unit category='length' name='mm' conversionFactor='0.001'/>";
  expect_box(read_as("a.x3d", with(mm)), LengthUnit::kMetre, {0, 0, 0}, {0.001, 0.002, 0.003});
  expect_box(read_as("a.x3d", with("<unit category='mass' conversionFactor='7'/>")),
             LengthUnit::kMetre, {0, 0, 0}, {1, 2, 3});
  const std::string refused = "not-a-mesh: its head does not state one length unit";
  for (const std::string& units : {mm + mm, test::replaced(mm, "0.001", "0"),
                                   test::replaced(mm, "0.001", "-1"), "<meta>" + mm + "</meta>"})
    EXPECT_TRUE(refusal_as("a.x3d", with(units)).starts_with(refused)) << units;
  EXPECT_TRUE(refusal_as("a.x3d", with(test::replaced(mm, "0.001", "mm")))
                  .starts_with("not-a-mesh: 'mm' is no number"));
  EXPECT_TRUE(refusal_as("a.x3d", with("<unit category='angle' conversionFactor='0.0175'/>"))
                  .starts_with("not-a-mesh: its angles are no radians"));
}

TEST(ImportFormats, Amf) {
  expect_box(read_as("a.amf", test::box_amf(" unit=\"inch\"")), LengthUnit::kInch, {0, 0, 0},
             {1, 2, 3});
  expect_box(read_as("a.amf", test::box_amf(" unit='micron'")), LengthUnit::kMicrometre, {0, 0, 0},
             {1, 2, 3});
  expect_box(read_as("a.amf", test::box_amf(" unit=\"feet\"")), LengthUnit::kInch, {0, 0, 0},
             {12, 24, 36});
  expect_box(read_as("a", test::box_amf("")), LengthUnit::kMillimetre, {0, 0, 0}, {1, 2, 3});
  EXPECT_TRUE(refusal_as("a.amf", test::replaced(test::box_amf(""), "<v3>7", "<v3>77"))
                  .starts_with("mesh-bad-index: it cannot be read ("));
  EXPECT_TRUE(refusal_as("a.amf", test::box_amf("",
                                                "<constellation id=\"2\"><instance "
                                                "objectid=\"1\"/></constellation>"))
                  .starts_with("not-a-mesh: a constellation places its objects"));
  // Another object without a volume does not balance it.
  const std::string none = "<object id=\"2\"><mesh><vertices/></mesh></object>";
  for (const std::string& extra : {std::string(), none})
    EXPECT_EQ(
        refusal_as("a.amf",
                   test::replaced(test::box_amf("", extra), "</volume>", "</volume><volume/>")),
        "not-a-mesh: an object has several volumes, which is not supported; export them as one");
  EXPECT_EQ(refusal_as("a.amf", test::replaced(test::box_amf(""), "<x>1", "<x>a")),
            "not-a-mesh: 'a' is no number; export the mesh again");
}

TEST(ImportFormats, MayBeginWithAByteOrderMark) {
  const std::string mark = "\xEF\xBB\xBF";
  expect_box(read_as("a.dae", mark + test::box_dae("", "Y_UP")), LengthUnit::kMetre, {0, 0, 0},
             {1, 2, 3});
  expect_box(read_as("a.ac", mark + test::box_ac()), LengthUnit::kUnknown, {1, 2, 3}, {2, 4, 6});
}

TEST(ImportFormats, ColladaThatAssimpWouldMisreadIsRefused) {
  const std::string box = test::box_dae("", "Y_UP");
  EXPECT_EQ(refusal_as("a.dae", test::replaced(box, "count=\"24\">0", "count=\"24\">0,5")),
            "not-a-mesh: its numbers have decimal commas; export the mesh again with decimal "
            "points");
  EXPECT_EQ(refusal_as("a.dae", test::replaced(box, "<p>0 2", "<p>-1 2")),
            "mesh-bad-index: an index is negative; export the mesh again");
  const std::string placed = "not-a-mesh: a node is placed by <lookat> or <skew>";
  const std::string lookat = "<lookat>0 0 1 0 0 0 0 1 0</lookat>";
  EXPECT_TRUE(refusal_as("a.dae", test::box_dae("", "Y_UP", lookat)).starts_with(placed));
  const std::string parent = lookat + "<node><instance_geometry url=\"#g\"/></node>";
  EXPECT_TRUE(refusal_as("a.dae", test::box_dae("", "Y_UP", parent)).starts_with(placed));
  expect_box(read_as("a.dae", test::box_dae("", "Y_UP", "<node>" + lookat + "</node>")),
             LengthUnit::kMetre, {0, 0, 0}, {1, 2, 3});
}

// The factor of an FBX is the centimetres of its unit.
TEST(ImportFormats, Fbx) {
  const auto read = [](const std::string& factor) {
    return read_as("a.fbx", test::box_fbx(factor));
  };
  for (const char* factor : {"0.1", "1", "2.54", "100", "3", "91.44", "0.00254"}) {
    const double mm = 10 * std::stod(factor);
    expect_box(read(factor), LengthUnit::kMillimetre, {5 * mm, 0, 0}, {6 * mm, 2 * mm, 3 * mm});
  }
  EXPECT_EQ(check_mesh(read("0.1")).box_max, Eigen::Vector3d(6, 2, 3));  // to the last bit
  expect_box(read("-1"), LengthUnit::kUnknown, {5, 0, 0}, {6, 2, 3});
  EXPECT_TRUE(refusal_as("a.fbx", test::replaced(test::box_fbx("1"), "0,2,3,-2", "0,2,30,-2"))
                  .starts_with("mesh-bad-index: "));
}

TEST(ImportFormats, OthersHaveNoUnit) {
  expect_box(read_as("a.ac", test::box_ac()), LengthUnit::kUnknown, {1, 2, 3}, {2, 4, 6});
  expect_box(read_as("a.3ds", test::box_3ds()), LengthUnit::kUnknown, {0, 0, 0}, {1, 2, 3});
}

// Without a mark in the content the name tells the format.
TEST(ImportFormats, TheNameMayTellTheFormat) {
  const std::string fbx = test::replaced(test::box_fbx("0.1"), "; FBX 7.3.0 project file\n", "");
  expect_box(read_as("a.FBX", fbx), LengthUnit::kMillimetre, {5, 0, 0}, {6, 2, 3});
  const std::string refused = "not-a-mesh: the content is in no supported format";
  EXPECT_TRUE(refusal_as("a", fbx).starts_with(refused));
  EXPECT_TRUE(refusal_as("a.3ds", fbx).starts_with("not-a-mesh: "));
  for (const char* name : {"a.ase", "a.dxf", "a.lws", "a.ac", "a.x"})
    EXPECT_TRUE(refusal_as(name, "0\nSECTION\n").starts_with(refused)) << name;
}

// What assimp logs and goes on after.
TEST(ImportFormats, ALossIsRefused) {
  const std::string part = "a part of it cannot be read (";
  const std::pair<std::string, std::string> cases[] = {
      {"mesh-bad-index: " + part +
           "AC3D: Invalid vertex reference); export the mesh again, or "
           "convert the mesh to STL, PLY or OBJ, for example with Blender or MeshLab",
       test::replaced(test::box_ac(), "0 0 0\n2 0 0\n", "0 0 0\n22 0 0\n")},
      {"not-a-mesh: " + part + "AC3D: SURF token was expected",
       test::replaced(test::box_ac(), "numsurf 6", "numsurf 8")},
      {"not-a-mesh: it has 6 surfaces, but states 4; export the mesh again",
       test::replaced(test::box_ac(), "numsurf 6", "numsurf 4")},
      {"not-a-mesh: " + part + "Collada: Unable to resolve reference to instanced node light",
       test::box_dae("", "Y_UP", "<instance_node url=\"#light\"/>")},
      {"not-a-mesh: it cannot be read (Expected different index count",
       test::replaced(test::box_dae("", "Y_UP"), "<p>0 2 3 1 ", "<p>")},
  };
  for (const auto& [expected, content] : cases) {
    const std::string got = refusal_as("a", content);
    EXPECT_TRUE(got.starts_with(expected)) << got << "\nfor " << expected;
  }
  // Looks and animations are no loss.
  expect_box(read_as("a.dae", test::box_dae("", "Y_UP",
                                            "<instance_camera url=\"#c\"/><instance_light "
                                            "url=\"#l\"/>")),
             LengthUnit::kMetre, {0, 0, 0}, {1, 2, 3});
}

TEST(ImportFormats, WhatAssimpDoesNotReadIsRefusedByName) {
  for (const auto& [name, begin] : {std::pair{"STEP", "ISO-10303-21;\n"},
                                    {"VRML", "#VRML V2.0 utf8\n"},
                                    {"PDF", "%PDF-1.4\n"},
                                    {"DirectX", "xof 0303txt 0032\n"}})
    EXPECT_TRUE(refusal_as("a", begin)
                    .starts_with("not-a-mesh: the file's format is " + std::string(name) + ", "))
        << name;
}

class SideFile : public ::testing::Test {
 protected:
  [[nodiscard]] std::string refusal(const std::string& uri) const {
    const auto file = folder_.write("scene/jaw.gltf", test::gltf_json(kTriangle, uri));
    const auto error = test::error_of([&] { static_cast<void>(read_mesh(file)); });
    return error ? error->what() : "fine";
  }
  [[nodiscard]] std::string missing(const std::string& uri) const {
    return (folder_.path() / "scene/jaw.gltf").string() + ": it names the file '" + uri +
           "', which is not in its folder or below: copy it there, or export one file that holds "
           "all";
  }

  const TriangleMesh kTriangle = test::triangle({1, 0, 0}, {0, 2, 0}, {0, 0, 3});
  const test::TempDir folder_;
  const bool made_ = std::filesystem::create_directories(folder_.path() / "scene/below");
  const std::filesystem::path inside_ =
      folder_.write("scene/jaw.bin", test::gltf_buffer(kTriangle));
  const std::filesystem::path outside_ = folder_.write("secret.bin", test::gltf_buffer(kTriangle));
};

TEST_F(SideFile, MayLieInTheFolderOrBelow) {
  EXPECT_EQ(refusal("jaw.bin"), "fine");
  folder_.write("scene/below/a jaw.bin", test::gltf_buffer(kTriangle));
  EXPECT_EQ(refusal("below/a%20jaw.bin"), "fine");
  EXPECT_EQ(refusal("below/a jaw.bin"), "fine");
  folder_.write("scene/100%25.bin", test::gltf_buffer(kTriangle));
  EXPECT_EQ(refusal("100%25.bin"), "fine");
  std::filesystem::create_symlink("jaw.bin", folder_.path() / "scene/link.bin");
  EXPECT_EQ(refusal("link.bin"), "fine");
  EXPECT_EQ(refusal("below/../jaw.bin"), "fine");
}

TEST_F(SideFile, IsNeverOutside) {
  EXPECT_EQ(refusal("../secret.bin"), missing("../secret.bin"));
  EXPECT_NE(refusal(outside_.string()), "fine");
  EXPECT_NE(refusal("..%2Fsecret.bin"), "fine");
  EXPECT_NE(refusal("file://" + outside_.string()), "fine");
  std::filesystem::create_symlink("../secret.bin", folder_.path() / "scene/out.bin");
  EXPECT_EQ(refusal("out.bin"), missing("out.bin"));
  std::filesystem::create_directory_symlink("..", folder_.path() / "scene/up");
  EXPECT_EQ(refusal("up/secret.bin"), missing("up/secret.bin"));
  EXPECT_EQ(refusal("below"), missing("below"));
  EXPECT_EQ(refusal("no.bin"), missing("no.bin"));
  EXPECT_NE(refusal("/dev/zero"), "fine");
}

}  // namespace
}  // namespace ist
