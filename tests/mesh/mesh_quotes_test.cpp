// Messages quote what a file says: never so that a terminal obeys it, a NUL ends the message, or
// its text takes a stack.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ist/base/error.h"
#include "ist/mesh/mesh.h"
#include "support/errors.h"
#include "support/mesh_files.h"
#include "support/shapes.h"
#include "support/temp_dir.h"
#include "support/zip_file.h"

namespace ist {
namespace {

using test::replaced;

const TriangleMesh kSmallMesh = test::triangle({1, 0, 0}, {0, 2, 0}, {0, 0, 3});

// The message, from the first byte behind the file's name.
std::string message(std::string_view bytes) {
  const test::TempDir folder;
  const auto file = folder.write("mesh", bytes);
  const auto error = test::error_of([&] { static_cast<void>(read_mesh(file)); });
  if (!error) return "fine";
  const std::string text = error->what(), name = file.string() + ": ";
  EXPECT_TRUE(text.starts_with(name)) << text;
  return text.substr(name.size());
}

struct Quoting {
  const char* expected;  // a part of the message
  std::string bytes;
};

TEST(MeshQuotes, AreOfPrintableCharacters) {
  const std::string bad("\x1B[31m_\x7F"), json = "\\u001b[31m\\u0000_\x7F";
  const std::string word = "\x9B_\x7F";  // control characters up to the blank end a word
  const std::string xml = test::threemf_model(kSmallMesh), stl = test::as_text_stl(kSmallMesh),
                    off = test::as_off(kSmallMesh), ply = test::as_text_ply(kSmallMesh),
                    gltf = test::as_gltf(kSmallMesh);
  const auto model = [&](const std::string& from, const std::string& to) {
    return test::as_3mf(replaced(xml, from, to));
  };
  const std::vector<Quoting> cases = {
      {"it names the file '?[31m", test::gltf_json(kSmallMesh, json)},
      {"glTF ?[31m?_? is not supported; ", replaced(gltf, "\"2.0\"", "\"" + json + "\"")},
      {" is no whole number; ", replaced(gltf, "[0]", "[\"" + json + "\"]")},
      {"?[31m?_? is not supported; ",
       replaced(gltf, "{\"asset\"", "{\"extensionsRequired\":[\"" + json + "\"],\"asset\"")},
      {"x: '?[31m_?' is no number; ", model("x=\"1\"", "x=\"" + bad + "\"")},
      {"v3=\"?[31m_?\" is no whole number; ", model("v3=\"2\"", "v3=\"" + bad + "\"")},
      {"the extension '[31m_?' is not supported; ",
       model("<model ", "<model requiredextensions=\"" + bad + "\" ")},
      {"'?_?' is not a PLY encoding; ", replaced(ply, "format ascii", "format " + word)},
      {"'?_?' is not a PLY property type; ",
       replaced(ply, "property float x", "property " + word + " x")},
      {"'?_?' is not expected in the header", replaced(ply, "element face", word)},
      {"of the 9 elements '?_?' that its header counts; ",
       replaced(ply, "end_header", "element " + word + " 9\nproperty int a\nend_header")},
      {"'?_?' is not a number; ", replaced(ply, "end_header\n", "end_header\n" + word + "\n")},
      {"'endsolid', found '?'; ", replaced(stl, "facet normal", "\x7F normal")},
      {"an OFF of kind '?OFF' is not supported; ", "\x7F" + off},
      {"'?' is not an integer; ", replaced(off, "3 1 0", "\x7F 1 0")},
  };
  for (const auto& [expected, bytes] : cases) {
    const std::string got = message(bytes);
    EXPECT_NE(got.find(expected), got.npos) << got << "\nfor " << expected;
    EXPECT_TRUE(std::all_of(got.begin(), got.end(), [](char c) {
      return static_cast<unsigned char>(c) >= 0x20 && c != '\x7F';
    })) << got;
  }
}

TEST(MeshQuotes, EndBetweenTwoCharacters) {
  std::string umlauts;
  for (int i = 0; i < 120; ++i) umlauts += "ä";
  const std::string got = message(test::gltf_json(kSmallMesh, "x" + umlauts));
  EXPECT_NE(got.find("'x" + umlauts.substr(0, 198) + "'"), got.npos) << got;
}

// The text of a JSON value is made by a function that calls itself for each level.
TEST(MeshQuotes, OfADeepValueCostNoStack) {
  const std::string plain = test::as_gltf(kSmallMesh), deep(200'000, '['), closed(200'000, ']');
  EXPECT_TRUE(message(replaced(plain, "{\"mesh\":0}", "{\"mesh\":" + deep + closed + "}"))
                  .starts_with("node 0: 'mesh' is no whole number; "));
  EXPECT_TRUE(message(replaced(plain, "{\"asset\"",
                               "{\"extensionsRequired\":" + deep + closed + ",\"asset\""))
                  .starts_with("extensionsRequired:  is not supported; "));
}

}  // namespace
}  // namespace ist
