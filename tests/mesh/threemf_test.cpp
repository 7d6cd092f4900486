// 3MF: objects and components, and every part that may be wrong.

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
  EXPECT_TRUE(refusal_of_3mf(as_3mf(text)).starts_with("not-a-mesh: 3D/3dmodel.model, line "));
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
  EXPECT_TRUE(refusal_of_3mf(as_3mf(prefixed("xmlns:c=\"x\""))).starts_with("mesh-empty: "));
  const std::string vertex = "<vertex x=\"7\" y=\"0\" z=\"0\"/>";
  const std::string both = replaced(prefixed("xmlns:c=" + core), "<c:vertices>",
                                    "<c:vertices>" + vertex + "<d:vertex/>");
  EXPECT_EQ(corners(read_3mf_bytes(as_3mf(both))), corners(kCorner));
}

TEST(ThreeMf, RefusesUtf16WithARemedy) {
  std::string wide("\xFF\xFE");
  for (const char c : kModelText) wide += {c, '\0'};
  EXPECT_EQ(
      refusal_of_3mf(as_3mf(wide)),
      "not-a-mesh: 3D/3dmodel.model: the text is UTF-16; export it as UTF-8, or export an STL");
  std::swap(wide[0], wide[1]);
  EXPECT_TRUE(
      refusal_of_3mf(as_3mf(wide)).starts_with("not-a-mesh: 3D/3dmodel.model: the text is"));
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

TEST(ThreeMf, RefusesWhatItCannotRead) {
  const std::string at = "3D/3dmodel.model, line ";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"mesh-bad-index: " + at + "12: a triangle names vertex 9, but there are 3",
       model_with("v3=\"2\"", "v3=\"9\"")},
      {"not-a-mesh: " + at + "12: <triangle> has no v3", model_with("v3=\"2\"", "")},
      {"not-a-mesh: " + at + "12: v3=\"x\" is no whole number", model_with("v3=\"2\"", "v3=\"x\"")},
      {"not-a-mesh: " + at + "12: v3=\"-1\" is no whole", model_with("v3=\"2\"", "v3=\"-1\"")},
      {"not-a-mesh: " + at + "7: <vertex> has no x", model_with("x=\"1\"", "X=\"1\"")},
      {"not-a-mesh: " + at + "7: x: 'one' is no number", model_with("x=\"1\"", "x=\"one\"")},
      {"mesh-not-finite: " + at + "7: x=\"nan\" is not finite", model_with("x=\"1\"", "x=\"nan\"")},
      {"mesh-not-finite: " + at + "7: x=\"1e39\"", model_with("x=\"1\"", "x=\"1e39\"")},
      {"mesh-not-finite: object 1: vertex 0 is not finite",
       model_with("<item ", "<item transform=\"1e300 0 0 0 1 0 0 0 1 0 0 0\" ")},
      {"not-a-mesh: " + at + "17: transform: '' is no number",
       model_with("<item ", "<item transform=\"1 0 0\" ")},
      {"not-a-mesh: " + at + "17: a transform has more than twelve",
       model_with("<item ", "<item transform=\"1 0 0 0 1 0 0 0 1 0 0 0 0\" ")},
      {"mesh-bad-index: " + at + "17: object 2 is not defined",
       model_with("objectid=\"1\"", "objectid=\"2\"")},
      {"mesh-bad-index: " + at + "15: object 1 is not defined",
       model_with("</mesh>\n", "</mesh>\n<components><component objectid=\"1\"/></components>")},
      {"not-a-mesh: " + at + "16: object 1 is defined twice",
       model_with("</object>\n", "</object>\n<object id=\"1\"></object>")},
      {"not-a-mesh: " + at + "16: <vertex> is in no object",
       model_with("</object>\n", "</object>\n<vertex/>")},
      {"not-a-mesh: " + at + "5: an object is in another",
       model_with("<mesh>", "<object id=\"2\">")},
      {"not-a-mesh: " + at + "2: the extensions 'p' are not supported",
       model_with("<model ", "<model requiredextensions=\"p\" ")},
      {"not-a-mesh: " + at + "13: </triangle> closes nothing",
       model_with("</triangles>", "</triangle>")},
      {"not-a-mesh: " + at + "12: the attribute 'v2' has no value", model_with("v2=\"1\"", "v2")},
      {"not-a-mesh: " + at + "12: a tag is malformed", model_with("v2=\"1\"", "\"\"")},
      {"mesh-points-only: the scene has 3 vertices", model_with("<triangle v1=", "<t v1=")},
      {"mesh-empty: the scene has no mesh", model_with("<item ", "<thing ")},
      {"mesh-empty: the scene has no mesh", "<model></model>"},
  };
  for (const auto& [expected, model] : cases) {
    const std::string got = refusal_of_3mf(as_3mf(model));
    EXPECT_TRUE(got.starts_with(expected)) << got << "\nfor " << expected;
  }
}

TEST(ThreeMf, RefusesEveryCutOfItsModel) {
  for (std::size_t size = 3; size + 2 < kModelText.size(); ++size) {
    const std::string got = refusal_of_3mf(as_3mf(kModelText.substr(0, size)));
    // Before <model> opens there is nothing that would have to be closed.
    if (size > kModelText.find("<model"))
      EXPECT_TRUE(got.starts_with("mesh-truncated: 3D/3dmodel.model, line "))
          << size << ": " << got;
    else
      EXPECT_NE(got, "fine") << size;
  }
}

TEST(ThreeMf, RefusesAnArchiveThatIsDamaged) {
  const std::string archive = as_3mf(kModelText);
  for (const std::size_t size : {std::size_t{4}, archive.size() / 2, archive.size() - 1})
    EXPECT_TRUE(refusal_of_3mf(archive.substr(0, size)).starts_with("mesh-truncated: byte "))
        << size;
  std::string wrong = archive;
  wrong[wrong.find("3dmodel.model") + 40] ^= 1;
  EXPECT_TRUE(refusal_of_3mf(wrong).starts_with("not-a-mesh: 3D/3dmodel.model: its "))
      << refusal_of_3mf(wrong);
  EXPECT_TRUE(refusal_of_3mf(test::as_zip("a.txt", "a"))
                  .starts_with("not-a-mesh: 3D/3dmodel.model: the archive does not hold it"));
  std::string other = test::as_zip("3D/3dmodel.model", kModelText, false);
  other[other.find("x=\"1\"") + 3] = '2';
  EXPECT_TRUE(
      refusal_of_3mf(other).starts_with("not-a-mesh: 3D/3dmodel.model: its checksum is wrong; "))
      << refusal_of_3mf(other);
  std::string sealed = archive;
  sealed[sealed.find("PK\1\2") + 8] = 1;
  EXPECT_TRUE(refusal_of_3mf(sealed).starts_with("not-a-mesh: 3D/3dmodel.model: it is encrypted"));
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
  const std::size_t record = wide.rfind("PK\6\6"), locator = wide.rfind("PK\6\7"),
                    extra = wide.rfind("3D/3dmodel.model") + 16;
  const auto with_byte = [&](std::size_t at, char byte) {
    std::string changed = wide;
    EXPECT_NE(changed[at], byte);
    changed[at] = byte;
    return refusal_of_3mf(changed);
  };
  for (const std::size_t at : {record, locator, locator + 8, locator + 15})
    EXPECT_TRUE(with_byte(at, '\x7F').starts_with("mesh-truncated: byte ")) << at;
  for (const std::size_t at : {record + 48, record + 55})
    EXPECT_TRUE(with_byte(at, '\x7F')
                    .starts_with("not-a-mesh: 3D/3dmodel.model: the archive does not hold it"))
        << at;
  for (const auto& [at, byte] : {std::pair{extra, '\2'}, std::pair{extra + 2, '\x10'}})
    EXPECT_TRUE(with_byte(at, byte).starts_with(
        "not-a-mesh: 3D/3dmodel.model: its size in 64 bits is missing; "))
        << at;
  EXPECT_TRUE(
      with_byte(extra + 19, '\1')
          .starts_with("mesh-truncated: 3D/3dmodel.model: its bytes are not in the archive"));
  EXPECT_TRUE(
      with_byte(extra + 27, '\1')
          .starts_with("mesh-truncated: 3D/3dmodel.model: its bytes are not in the archive"));
  for (std::size_t size = 4; size < wide.size(); ++size)
    EXPECT_TRUE(refusal_of_3mf(wide.substr(0, size)).starts_with("mesh-truncated: byte ")) << size;
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
            "not-a-mesh: b?.model: the archive does not hold it; convert the mesh to 3MF or STL");
  EXPECT_TRUE(refusal_of_3mf(test::as_zip({{"a.model", replaced(kModelText, "v3=\"2\"", "")},
                                           {"_rels/.rels", relationships("a.model")}}))
                  .starts_with("not-a-mesh: a.model, line 12: <triangle> has no v3"));
  // Without a model among the relationships, the usual name is looked for.
  for (const char* text : {"", "<Relationships/>"})
    EXPECT_EQ(corners(read_3mf_bytes(
                  test::as_zip({{"_rels/.rels", text}, {"3D/3dmodel.model", kModelText}}))),
              corners(kCorner));
  EXPECT_TRUE(
      refusal_of_3mf(test::as_zip({{"_rels/.rels", "<a"}, {"3D/3dmodel.model", kModelText}}))
          .starts_with("mesh-truncated: _rels/.rels, line 1: "));
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
