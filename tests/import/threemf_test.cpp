// 3MF by ist-import: objects and components, units, and every part that may be wrong.

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "ist/base/error.h"
#include "ist/mesh/mesh.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/largest_allocation.h"
#include "support/mesh_files.h"
#include "support/shapes.h"
#include "support/temp_dir.h"
#include "support/zip_file.h"

namespace ist {
namespace {

using test::as_3mf;
using test::corners;
using test::replaced;

const TriangleMesh kCorner = test::triangle({1, 0, 0}, {0, 2, 0}, {0, 0, 3.1});
const std::string kModelText = test::threemf_model(kCorner);

TriangleMesh read_3mf_bytes(std::string_view bytes) {
  const test::TempDir folder;
  return read_mesh(folder.write("mesh.3mf", bytes));
}

std::string refusal_of_3mf(std::string_view bytes) {
  const test::TempDir folder;
  const auto file = folder.write("mesh.3mf", bytes);
  const auto error = test::error_of([&] { static_cast<void>(read_mesh(file)); });
  if (!error) return "fine";
  const std::string text = error->what(), name = file.string() + ": ";
  EXPECT_TRUE(text.starts_with(name)) << text;
  return std::string(to_string(error->code())) + ": " + text.substr(name.size());
}

std::string model_with(const std::string& from, const std::string& to) {
  const std::string changed = replaced(kModelText, from, to);
  EXPECT_NE(changed, kModelText) << from;
  return changed;
}

TEST(ThreeMf, IsReadInDoubles) {
  EXPECT_EQ(corners(read_3mf_bytes(as_3mf(kModelText))), corners(kCorner));
  const TriangleMesh ball = test::icosphere(3, 1);
  const TriangleMesh again = read_3mf_bytes(as_3mf(test::threemf_model(ball)));
  EXPECT_EQ(corners(again), corners(ball));
  EXPECT_EQ(again.vertices.size(), ball.vertices.size());
}

TEST(ThreeMf, MayBeStoredAndHaveAnyXml) {
  EXPECT_EQ(corners(read_3mf_bytes(test::as_zip("3d/3DMODEL.model", kModelText, false))),
            corners(kCorner));
  std::string text = replaced(kModelText, "\"", " '");
  text = replaced(text, "/>", " ></vertex>");
  text = replaced(text, "<?xml version= '1.0 '?>",
                  "<!-- <object> --><!DOCTYPE model><?pi <a> ?><![CDATA[<b>]]>");
  EXPECT_TRUE(refusal_of_3mf(as_3mf(text)).starts_with("not-a-mesh: 3D/3dmodel.model"));
  text = replaced(kModelText, "<vertices>",
                  "<!-- <vertex> --><?pi <a> ?><![CDATA[<b>]]><m:x a = ' > ' b=\"'\"> & </m:x >"
                  "<vertices\n>");
  EXPECT_EQ(corners(read_3mf_bytes(as_3mf(text))), corners(kCorner));
}

std::string prefixed(const std::string& declared) {
  std::string text = replaced(replaced(kModelText, "</", "</c:"), "<", "<c:");
  text = replaced(replaced(text, "<c:/c:", "</c:"), "<c:?", "<?");
  return replaced(text, "<c:model ", "<c:model " + declared + " ");
}

// Elements of the core count, whatever their prefix; those of an extension may have the same names.
TEST(ThreeMf, NamesMayHaveAPrefix) {
  const std::string core = "\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"";
  for (const std::string& declared : {"xmlns:c=" + core, "xmlns:c=" + core + " xmlns=\"x\"",
                                      "xmlns=" + core + " xmlns:c=" + core})
    EXPECT_EQ(corners(read_3mf_bytes(as_3mf(prefixed(declared)))), corners(kCorner)) << declared;
  const std::string vertex = "<vertex x=\"7\" y=\"0\" z=\"0\"/>";
  const std::string both = replaced(prefixed("xmlns:c=" + core), "<c:vertices>",
                                    "<c:vertices>" + vertex + "<d:vertex/>");
  EXPECT_EQ(corners(read_3mf_bytes(as_3mf(both))), corners(kCorner));
}

TEST(ThreeMf, MayBeUtf16) {
  std::string wide("\xFF\xFE");
  for (const char c : kModelText) wide += {c, '\0'};
  EXPECT_EQ(corners(read_3mf_bytes(as_3mf(wide))), corners(kCorner));
}

// As the format defines it: the rows are where the axes and the origin come to lie.
TEST(ThreeMf, PlacesItemsAndComponents) {
  const std::string two = model_with(
      "</resources>\n<build><item objectid=\"1\"/>",
      "<object id=\"7\"><components><component objectid=\"1\" transform=\"0 1 0 -1 0 0 0 0 1 10 0 "
      "0\"/><component objectid=\"1\"/></components></object></resources>\n"
      "<build><item objectid=\"7\" transform=\"2 0 0 0 2 0 0 0 2 0 0 5\"/>");
  const auto got = corners(read_3mf_bytes(as_3mf(two)));
  ASSERT_EQ(got.size(), 2u);
  EXPECT_EQ(got[0], (std::array<double, 9>{20, 2, 5, 16, 0, 5, 20, 0, 11.2}));
  EXPECT_EQ(got[1], (std::array<double, 9>{2, 0, 5, 0, 4, 5, 0, 0, 11.2}));
}

TEST(ThreeMf, AMirroredObjectKeepsItsOuterSide) {
  const std::string text = test::threemf_model(test::icosphere(2, 1));
  for (const char* transform : {"-1 0 0 0 1 0 0 0 1 3 0 0", "0 1 0 1 0 0 0 0 1 0 0 0"}) {
    const TriangleMesh mesh = read_3mf_bytes(
        as_3mf(replaced(text, "<item objectid=\"1\"",
                        std::string("<item objectid=\"1\" transform=\"") + transform + "\"")));
    EXPECT_GT(check_mesh(mesh).signed_volume, 4) << transform;
  }
}

TEST(ThreeMf, NumbersMayHaveBlanksRoundThem) {
  const std::string model = model_with("z=\"3.1\"", "z=\" 3.1\n\"");
  EXPECT_EQ(corners(read_3mf_bytes(as_3mf(model))), corners(kCorner));
  EXPECT_TRUE(refusal_of_3mf(as_3mf(model_with("z=\"3.1\"", "z=\"3.1 2\"")))
                  .ends_with("z: '3.1 2' is no number; export the mesh again"));
}

TEST(ThreeMf, ObjectsThatAreNotPlacedMayHaveBeams) {
  const std::string beams = "<object id=\"9\"><mesh><b:beamlattice/></mesh></object>\n</resources>";
  EXPECT_EQ(corners(read_3mf_bytes(as_3mf(model_with("</resources>", beams)))), corners(kCorner));
}

TEST(ThreeMf, RefusesWhatItCannotRead) {
  const std::string at = "3D/3dmodel.model";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"mesh-bad-index: object 1: a face names vertex 9, but there are 3",
       model_with("v3=\"2\"", "v3=\"9\"")},
      {"not-a-mesh: " + at + ": <triangle> has no v3", model_with("v3=\"2\"", "")},
      {"not-a-mesh: " + at + ": v3=\"x\" is no whole number", model_with("v3=\"2\"", "v3=\"x\"")},
      {"not-a-mesh: " + at + ": v3=\"-1\" is no whole", model_with("v3=\"2\"", "v3=\"-1\"")},
      {"not-a-mesh: " + at + ": <vertex> has no x", model_with("x=\"1\"", "X=\"1\"")},
      {"not-a-mesh: " + at + ": x: 'one' is no number", model_with("x=\"1\"", "x=\"one\"")},
      {"not-a-mesh: " + at + ": x: '1,5' is no number", model_with("x=\"1\"", "x=\"1,5\"")},
      {"mesh-not-finite: object 1: vertex 0 is not finite", model_with("x=\"1\"", "x=\"nan\"")},
      {"mesh-not-finite: object 1: vertex 0 is not finite", model_with("x=\"1\"", "x=\"1e39\"")},
      {"mesh-not-finite: object 1: vertex 0 is not finite",
       model_with("<item ", "<item transform=\"1e300 0 0 0 1 0 0 0 1 0 0 0\" ")},
      {"not-a-mesh: " + at + ": transform: '' is no number",
       model_with("<item ", "<item transform=\"1 0 0\" ")},
      {"not-a-mesh: " + at + ": a transform has more than twelve",
       model_with("<item ", "<item transform=\"1 0 0 0 1 0 0 0 1 0 0 0 0\" ")},
      {"mesh-bad-index: " + at + ": object 2 is named, but not defined",
       model_with("objectid=\"1\"", "objectid=\"2\"")},
      {"not-a-mesh: " + at + ": object 1 is a mesh and has components",
       model_with("</mesh>\n", "</mesh>\n<components><component objectid=\"1\"/></components>")},
      {"not-a-mesh: " + at + ": object 2 holds itself",
       replaced(model_with("</object>\n",
                           "</object>\n<object id=\"2\"><components><component "
                           "objectid=\"2\"/></components></object>"),
                "<item objectid=\"1\"", "<item objectid=\"2\"")},
      {"not-a-mesh: " + at + ": object 1 is defined twice",
       model_with("</object>\n", "</object>\n<object id=\"1\"></object>")},
      {"not-a-mesh: " + at + ": the extension 'q' is not supported; export a plain 3MF, or an STL",
       model_with("<model ", "<model requiredextensions=\"q\" xmlns:q=\"http://q\" ")},
      {"not-a-mesh: " + at + ": object 1 has beams",
       model_with("</mesh>", "<b:beamlattice/></mesh>")},
      {"not-a-mesh: " + at + ": object 1 has its shape in slices alone",
       model_with("<object ", "<object s:meshresolution=\"lowres\" ")},
      {"not-a-mesh: " + at + ": its unit 'parsec' is not known",
       model_with("<model unit=\"millimeter\"", "<model unit=\"parsec\"")},
      {"not-a-mesh: " + at + ", line 13: it is no XML", model_with("</triangles>", "</triangle>")},
      {"mesh-points-only: the scene has 3 vertices", model_with("<triangle v1=", "<t v1=")},
      {"mesh-empty: the scene has no mesh", model_with("<item ", "<thing ")},
      {"mesh-empty: the scene has no mesh", "<model></model>"},
      {"not-a-mesh: " + at + ": it is not one model", "<a/>"},
      {"not-a-mesh: " + at + ": it is not one model", kModelText + "<model/>"},
  };
  for (const auto& [expected, model] : cases) {
    const std::string got = refusal_of_3mf(as_3mf(model));
    EXPECT_TRUE(got.starts_with(expected)) << got << "\nfor " << expected;
  }
}

TEST(ThreeMf, RefusesEveryCutOfItsModel) {
  for (std::size_t size = 3; size + 2 < kModelText.size(); size += 7) {
    const std::string got = refusal_of_3mf(as_3mf(kModelText.substr(0, size)));
    EXPECT_TRUE(got.starts_with("mesh-truncated: ") || got.starts_with("not-a-mesh: "))
        << size << ": " << got;
  }
}

// Of each name of a unit, the unit and the length of 1. A centimetre is 10 mm, a foot 12 inches.
TEST(ThreeMf, KnowsTheUnitOfItsModel) {
  const std::tuple<const char*, LengthUnit, double> units[] = {
      {"unit=\"micron\"", LengthUnit::kMicrometre, 1},
      {"unit=\"millimeter\"", LengthUnit::kMillimetre, 1},
      {"unit=\"centimeter\"", LengthUnit::kMillimetre, 10},
      {"unit=\"inch\"", LengthUnit::kInch, 1},
      {"unit=\"foot\"", LengthUnit::kInch, 12},
      {"unit=\"meter\"", LengthUnit::kMetre, 1},
      {"", LengthUnit::kMillimetre, 1}};
  for (const auto& [attribute, unit, length] : units) {
    const TriangleMesh mesh =
        read_3mf_bytes(as_3mf(replaced(kModelText, "unit=\"millimeter\"", attribute)));
    EXPECT_EQ(mesh.unit, unit) << attribute;
    EXPECT_EQ(mesh.vertices.at(0).x(), length) << attribute;
  }
}

// A path names another part of the archive, whether or not the extension is required.
TEST(ThreeMf, ReadsObjectsOfOtherParts) {
  const std::string ball = test::threemf_model(test::icosphere(1, 1));
  const std::string use = "<component objectid=\"1\" p:path=\"/3D/Objects/a.model\"/>";
  const std::string root = replaced(
      replaced(ball, "</resources>",
               "<object id=\"2\"><components>" + use + "</components></object></resources>"),
      "<item objectid=\"1\"", "<item objectid=\"2\"");
  const auto package = [](const std::string& model, const std::string& part) {
    return test::as_zip({{"3D/3dmodel.model", model}, {"3D/Objects/a.model", part}});
  };
  EXPECT_EQ(corners(read_3mf_bytes(package(root, kModelText))), corners(kCorner));
  EXPECT_TRUE(refusal_of_3mf(package(root, "<model/>"))
                  .starts_with("mesh-bad-index: 3D/Objects/a.model: object 1 is named"));
  const std::string item =
      replaced(ball, "<item objectid=\"1\"", "<item p:path=\"/3D/Objects/a.model\" objectid=\"1\"");
  EXPECT_EQ(corners(read_3mf_bytes(package(item, kModelText))), corners(kCorner));
  EXPECT_TRUE(
      refusal_of_3mf(package(root, replaced(kModelText, "unit=\"millimeter\"", "unit=\"inch\"")))
          .starts_with("not-a-mesh: 3D/Objects/a.model: its unit is another one"));
  // Both become millimetres, by other factors.
  EXPECT_TRUE(refusal_of_3mf(
                  package(root, replaced(kModelText, "unit=\"millimeter\"", "unit=\"centimeter\"")))
                  .starts_with("not-a-mesh: 3D/Objects/a.model: its unit is another one"));
}

// PrusaSlicer keeps modifiers and supports as triangles of the same mesh.
TEST(ThreeMf, LeavesOutWhatAPrusaProjectAdds) {
  const TriangleMesh box = test::box({0, 0, 0}, {1, 2, 3});
  const auto project = [&](const std::string& type) {
    return test::as_zip(
        {{"3D/3dmodel.model", test::threemf_model(box)},
         {"Metadata/Slic3r_PE_model.config",
          "<config><object id=\"1\"><volume firstid=\"0\" lastid=\"7\"><metadata type=\"volume\" "
          "key=\"volume_type\" value=\"ModelPart\"/></volume><volume firstid=\"8\" lastid=\"11\">"
          "<metadata type=\"volume\" " +
              type + "/></volume></object></config>"}});
  };
  EXPECT_EQ(read_3mf_bytes(project("key=\"volume_type\" value=\"ModelPart\"")).triangles.size(),
            12u);
  for (const char* type :
       {"key=\"volume_type\" value=\"ParameterModifier\"",
        "key=\"volume_type\" value=\"SupportBlocker\"",
        "key=\"volume_type\" value=\"SupportEnforcer\"", "key=\"modifier\" value=\"1\""})
    EXPECT_EQ(read_3mf_bytes(project(type)).triangles.size(), 8u) << type;
  EXPECT_EQ(
      refusal_of_3mf(project("key=\"volume_type\" value=\"NegativeVolume\"")),
      "not-a-mesh: Metadata/Slic3r_PE_model.config: a negative volume cuts the body: export the "
      "plate as STL in the slicer");
}

// The triangles of such a modifier are unknown.
TEST(ThreeMf, RefusesAPrusaModifierWithoutTriangles) {
  const auto project = [&](const std::string& range) {
    return refusal_of_3mf(test::as_zip(
        {{"3D/3dmodel.model", kModelText},
         {"Metadata/Slic3r_PE_model.config",
          "<config><object id=\"1\"><volume" + range +
              "><metadata type=\"volume\" key=\"volume_type\" value=\"ParameterModifier\"/>"
              "</volume></object></config>"}}));
  };
  for (const char* range : {"", " firstid=\"0\"", " lastid=\"0\""})
    EXPECT_EQ(project(range),
              "not-a-mesh: Metadata/Slic3r_PE_model.config: a modifier does not name its triangles "
              "(firstid, lastid): export the plate as STL in the slicer")
        << range;
  EXPECT_EQ(project(" firstid=\"0\" lastid=\"0\""),
            "mesh-empty: all of its objects are supports or modifiers; export the model itself");
}

// The core of 3MF has types of objects, and Cura adds settings to them.
TEST(ThreeMf, LeavesOutSupportsAndCurasModifiers) {
  const auto with_second = [](const std::string& attributes, const std::string& inside) {
    return as_3mf(model_with(
        "</resources>\n<build>",
        "<object id=\"2\" " + attributes + ">" + inside +
            "<mesh><vertices><vertex x=\"5\" y=\"0\" z=\"0\"/><vertex x=\"6\" y=\"0\" "
            "z=\"0\"/><vertex x=\"5\" y=\"1\" z=\"0\"/></vertices><triangles><triangle v1=\"0\" "
            "v2=\"1\" v3=\"2\"/></triangles></mesh></object></resources>\n<build><item "
            "objectid=\"2\"/>"));
  };
  const auto metadata = [](const std::string& name, const std::string& value) {
    return "<metadatagroup><metadata name=\"cura:" + name + "\">" + value +
           "</metadata></metadatagroup>";
  };
  for (const char* type : {"support", "solidsupport"})
    EXPECT_EQ(corners(read_3mf_bytes(with_second("type=\"" + std::string(type) + "\"", ""))),
              corners(kCorner))
        << type;
  for (const char* name : {"anti_overhang_mesh", "support_mesh", "infill_mesh"}) {
    EXPECT_EQ(corners(read_3mf_bytes(with_second("", metadata(name, "True")))), corners(kCorner))
        << name;
    EXPECT_EQ(read_3mf_bytes(with_second("", metadata(name, "False"))).triangles.size(), 2u);
  }
  for (const char* type : {"type=\"model\"", "type=\"surface\"", ""})
    EXPECT_EQ(read_3mf_bytes(with_second(type, "")).triangles.size(), 2u) << type;
  EXPECT_EQ(
      refusal_of_3mf(with_second("", metadata("cutting_mesh", "True"))),
      "not-a-mesh: 3D/3dmodel.model: object 2 cuts others (cutting_mesh); export the plate as "
      "an STL");
  EXPECT_EQ(refusal_of_3mf(as_3mf(model_with("<object ", "<object type=\"support\" "))),
            "mesh-empty: all of its objects are supports or modifiers; export the model itself");
}

// Bambu Studio and OrcaSlicer keep them as components of the object.
TEST(ThreeMf, LeavesOutWhatABambuProjectAdds) {
  const std::string objects =
      replaced(replaced(kModelText, "</resources>",
                        "<object id=\"7\"><components><component objectid=\"1\"/><component "
                        "objectid=\"1\" transform=\"1 0 0 "
                        "0 1 0 0 0 1 9 0 0\"/><component "
                        "objectid=\"3\"/></components></object><object id=\"3\"><mesh>"
                        "<vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"5\" y=\"0\" "
                        "z=\"0\"/><vertex x=\"0\" "
                        "y=\"5\" z=\"0\"/></vertices><triangles><triangle v1=\"0\" v2=\"1\" "
                        "v3=\"2\"/></triangles></mesh>"
                        "</object></resources>"),
               "<item objectid=\"1\"", "<item objectid=\"7\"");
  const auto project = [&](const std::string& subtype) {
    return test::as_zip({{"3D/3dmodel.model", objects},
                         {"Metadata/model_settings.config",
                          "<config><object id=\"7\"><part id=\"1\" subtype=\"normal_part\"/><part "
                          "id=\"3\" subtype=\"" +
                              subtype + "\"/></object></config>"}});
  };
  EXPECT_EQ(read_3mf_bytes(project("normal_part")).triangles.size(), 3u);
  for (const char* subtype : {"modifier_part", "support_blocker", "support_enforcer"})
    EXPECT_EQ(read_3mf_bytes(project(subtype)).triangles.size(), 2u) << subtype;
  EXPECT_TRUE(
      refusal_of_3mf(project("negative_part")).starts_with("not-a-mesh: Metadata/model_settings"));
}

TEST(ThreeMf, MayHaveAPartNameOfAUri) {
  const std::string relations =
      "<Relationships><Relationship Target=\"/3D/my%20model.model\" "
      "Type=\"http://schemas.microsoft.com/"
      "3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
  for (const char* name : {"3D/my model.model", "3D/my%20model.model"})
    EXPECT_EQ(
        corners(read_3mf_bytes(test::as_zip({{"_rels/.rels", relations}, {name, kModelText}}))),
        corners(kCorner));
}

TEST(ThreeMf, RefusesAnArchiveThatIsDamaged) {
  const std::string archive = as_3mf(kModelText), part = "not-a-mesh: 3D/3dmodel.model: ";
  for (std::size_t size = 4; size < archive.size(); size += 13)
    EXPECT_TRUE(refusal_of_3mf(archive.substr(0, size))
                    .starts_with("mesh-truncated: the archive is damaged ("))
        << size;
  std::string wrong = archive;
  wrong[wrong.find("3dmodel.model") + 40] ^= 1;
  EXPECT_TRUE(refusal_of_3mf(wrong).starts_with(part + "Zlib error")) << refusal_of_3mf(wrong);
  for (const char* other : {"word/document.xml", "scene.dae"})
    EXPECT_EQ(refusal_of_3mf(test::as_zip(other, "<a/>")),
              part +
                  "the zip holds no such 3D model, so it is no 3MF project; unpack it and give "
                  "the mesh in it, or export the mesh as 3MF or STL");
  std::string other = test::as_zip("3D/3dmodel.model", kModelText, false);
  other[other.find("x=\"1\"") + 3] = '2';
  EXPECT_TRUE(refusal_of_3mf(other).starts_with(part + "CRC error")) << refusal_of_3mf(other);
  std::string sealed = archive;
  sealed[sealed.find("PK\1\2") + 8] = 1;
  EXPECT_NE(refusal_of_3mf(sealed), "fine");
}

std::string relationships(const std::string& target) {
  return "<?xml version=\"1.0\"?>\n<Relationships "
         "xmlns=\"http://schemas.openxmlformats.org/package/"
         "2006/relationships\"><Relationship Target=\"/thumbnail.png\" Id=\"a\" Type=\"http://"
         "schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail\"/>"
         "<Relationship Target=\"" +
         target +
         "\" Id=\"b\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>"
         "</Relationships>";
}

// As lib3mf writes every file: each size and each offset in 64 bits.
TEST(ThreeMf, MayHaveSizesOf64Bits) {
  const std::vector<test::ZipPart> parts = {{"[Content_Types].xml", "<Types/>"},
                                            {"_rels/.rels", relationships("/3D/3dmodel.model")},
                                            {"3D/3dmodel.model", kModelText}};
  const std::string wide = test::as_zip(parts, test::ZipNumbers::kWide);
  EXPECT_EQ(corners(read_3mf_bytes(wide)), corners(kCorner));
  // The sizes alone, as Python's zipfile writes them: the directory has an offset of 32 bits.
  std::string offset = wide;
  const std::size_t record = wide.rfind("PK\6\6"), end = wide.rfind("PK\5\6");
  std::memcpy(offset.data() + end + 16, wide.data() + record + 48, 4);
  EXPECT_EQ(corners(read_3mf_bytes(offset)), corners(kCorner));
}

TEST(ThreeMf, RefusesSizesOf64BitsThatAreDamaged) {
  const std::string wide =
      test::as_zip({{"3D/3dmodel.model", kModelText}}, test::ZipNumbers::kWide);
  for (std::size_t size = 4; size < wide.size(); size += 13)
    EXPECT_TRUE(refusal_of_3mf(wide.substr(0, size)).starts_with("mesh-truncated: ")) << size;
}

TEST(ThreeMf, SaysTheSizeOf64BitsThatIsTooMuch) {
  const std::string got = refusal_of_3mf(test::as_zip(
      {{"3D/3dmodel.model", kModelText, true, 5'000'000'007u}}, test::ZipNumbers::kWide));
  EXPECT_TRUE(got.starts_with("mesh-too-large: 3D/3dmodel.model: it unpacks to 5000000007 bytes"))
      << got;
}

// The format leaves the name of the model's part to the relationships of the package.
TEST(ThreeMf, ReadsThePartThatTheRelationshipsName) {
  const auto package = [](const std::string& target, const std::string& part) {
    return test::as_zip({{"3D/3dmodel.model", test::threemf_model(test::icosphere(1, 1))},
                         {part, kModelText},
                         {"_rels/.rels", relationships(target)}});
  };
  EXPECT_EQ(corners(read_3mf_bytes(package("/3D/part.model", "3D/part.model"))), corners(kCorner));
  EXPECT_EQ(corners(read_3mf_bytes(package("a.model", "A.model"))), corners(kCorner));
  EXPECT_EQ(refusal_of_3mf(package("/b\x1B.model", "a.model")),
            "not-a-mesh: b?.model: the zip holds no such 3D model, so it is no 3MF project; unpack "
            "it and give the mesh in it, or export the mesh as 3MF or STL");
  EXPECT_TRUE(refusal_of_3mf(test::as_zip({{"a.model", replaced(kModelText, "v3=\"2\"", "")},
                                           {"_rels/.rels", relationships("a.model")}}))
                  .starts_with("not-a-mesh: a.model: <triangle> has no v3"));
  // Without a model among the relationships, the usual name is looked for.
  for (const char* text : {"", "<Relationships/>"})
    EXPECT_EQ(corners(read_3mf_bytes(
                  test::as_zip({{"_rels/.rels", text}, {"3D/3dmodel.model", kModelText}}))),
              corners(kCorner));
  EXPECT_TRUE(
      refusal_of_3mf(test::as_zip({{"_rels/.rels", "<a"}, {"3D/3dmodel.model", kModelText}}))
          .starts_with("not-a-mesh: _rels/.rels: it is no XML"));
}

// Half a gigabyte of blanks is half a megabyte as a zip.
TEST(ThreeMf, RefusesAnArchiveThatUnpacksToTooMuch) {
  const std::string small = as_3mf(kModelText);
  std::string got;
  const std::size_t largest = test::largest_allocation([&] {
    got = refusal_of_3mf(test::as_zip("3D/3dmodel.model", kModelText, true, 0xF0000000u));
  });
  EXPECT_TRUE(got.starts_with("mesh-too-large: 3D/3dmodel.model: it unpacks to 4026531840 bytes"))
      << got;
  EXPECT_LT(largest, 1'000'000u);
  // A size below the limit that so few bytes cannot come to is not believed either.
  got = refusal_of_3mf(test::as_zip("3D/3dmodel.model", kModelText, true, 500'000'000u));
  EXPECT_TRUE(got.starts_with("not-a-mesh: 3D/3dmodel.model: ")) << got;
  EXPECT_EQ(refusal_of_3mf(small), "fine");
}

TEST(ThreeMf, RefusesComponentsThatMultiply) {
  IST_SLOW();
  std::string objects;
  for (int id = 2; id < 12; ++id) {
    objects += "<object id=\"" + std::to_string(id) + "\"><components>";
    for (int i = 0; i < 10; ++i)
      objects += "<component objectid=\"" + std::to_string(id - 1) + "\"/>";
    objects += "</components></object>";
  }
  const std::string model = replaced(model_with("</resources>", objects + "</resources>"),
                                     "<item objectid=\"1\"", "<item objectid=\"11\"");
  EXPECT_TRUE(refusal_of_3mf(as_3mf(model)).starts_with("mesh-too-large: object "));
}

}  // namespace
}  // namespace ist
