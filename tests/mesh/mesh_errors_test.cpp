#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "ist/base/error.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/mesh.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/mesh_files.h"
#include "support/shapes.h"
#include "support/temp_dir.h"
#include "support/zip_file.h"

namespace ist {
namespace {

using test::all_formats;
using test::replaced;
using test::TempDir;

const TriangleMesh kSoundBox = test::box({-1, 0.1, 2}, {0.5, 1.25, 3});

std::string code_of(const std::filesystem::path& file) {
  try {
    const TriangleMesh mesh = read_mesh(file);
    return "fine";
  } catch (const Error& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with(file.string() + ": ")) << error.what();
    return to_string(error.code());
  }
}

std::string code_of_bytes(std::string_view bytes, std::string_view name = "mesh") {
  const TempDir folder;
  return code_of(folder.write(name, bytes));
}

struct Refused {
  const char* code;
  std::string bytes;
  const char* name = "mesh";
};

std::string ply(const std::string& elements_and_body) {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\n" +
         elements_and_body;
}

const std::string kFaces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const std::string kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string kOff = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
const std::string kOpenFacet = "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex ";

TEST(ReadMesh, RefusesWhatIsNoMesh) {
  const std::vector<Refused> cases = {
      {"mesh-empty", ""},
      {"mesh-empty", "", "a.stl"},
      {"mesh-empty", " \r\n\n"},
      {"mesh-empty", "# nothing\n", "a.obj"},
      {"mesh-empty", "o thing\n"},
      {"mesh-empty", "solid\nendsolid\n"},
      {"mesh-empty", std::string(84, '\0')},
      {"mesh-empty", "ply\nformat ascii 1.0\nend_header\n"},
      {"mesh-empty", "ply\nformat ascii 1.0\nelement vertex 0\nelement face 0\nend_header\n"},
      {"mesh-points-only", kThree},
      {"mesh-points-only", kThree + "l 1 2 3\np 1\n"},
      {"mesh-points-only", ply("end_header\n0 0 0\n1 0 0\n0 1 0\n")},
      {"mesh-empty", "OFF\n0 0 0\n"},
      {"mesh-points-only", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n"},
      {"not-a-mesh", "4OFF\n3 1 0\n0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n"},
      {"not-a-mesh", kOff + "3 0 1 2\n3 0 1 2\n"},
      {"not-a-mesh", kOff + "2 0 1\n"},
      {"not-a-mesh", kOff + "1025 0 1 2\n"},
      {"not-a-mesh", "OFF\n-3 1 0\n"},
      {"not-a-mesh", "OFF\n3 1 0\n0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {"mesh-truncated", "OFF"},
      {"mesh-truncated", "OFF\n3\n"},
      {"mesh-truncated", kOff},
      {"mesh-truncated", kOff + "3 0 1\n"},
      {"mesh-truncated", "OFF\n353535235358 6 0\n0 0 0\n"},
      {"mesh-truncated", "OFF\n3 353535235358 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {"mesh-bad-index", kOff + "3 0 1 3\n"},
      {"mesh-bad-index", kOff + "3 0 1 -1\n"},
      {"mesh-not-finite", "OFF\n3 1 0\nnan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {"not-a-mesh", "just a letter\n", "a.obj"},
      {"not-a-mesh", "just a letter\n"},
      {"not-a-mesh", std::string("\x89PNG\r\n\x1A\n", 8) + std::string(500, '\xFF')},
      {"not-a-mesh", "solid\nthis is not an stl\nendsolid\n"},
      {"not-a-mesh", "solid\n" + kOpenFacet + "0 1 0 vertex 1 1 1 endloop endfacet\nendsolid\n"},
      {"not-a-mesh", "solid\n" + kOpenFacet + "0 1,5 0 endloop endfacet\nendsolid\n"},
      {"not-a-mesh", test::as_text_stl(kSoundBox) + "and more\n"},
      {"not-a-mesh", kThree + "f 1 2\nf 1 2 3\n"},
      {"not-a-mesh", kThree + "f 1 2 c\nf 1 2 3\n"},
      {"not-a-mesh", "v 0 0\n" + kThree + "f 1 2 3\n"},
      {"not-a-mesh", "v 0 0 zero\n" + kThree + "f 1 2 3\n"},
      {"not-a-mesh", kThree + "f" + replaced(std::string(1025, '1'), "1", " 1") + "\n"},
      {"not-a-mesh", ply(kFaces + "0 0 0\n1 0 0\n0 1 0 7\n3 0 1 2\n")},
      {"not-a-mesh", ply(kFaces + "0 0 0\n1 0\n0 1 0\n3 0 1 2\n")},
      {"not-a-mesh", ply(kFaces + "0 0 0\n1 0 0\n0 1 0\n2 0 1\n")},
      {"not-a-mesh", ply(kFaces + "0 0 0\n1 0 0\n0 1 0\n-1 0 1\n")},
      {"not-a-mesh", ply(kFaces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n")},
      {"not-a-mesh", ply("element vertex 1\n" + kFaces)},
      {"not-a-mesh", ply("property float x\n" + kFaces)},
      {"not-a-mesh", ply("property complex w\n" + kFaces)},
      {"not-a-mesh", ply("property list float int w\n" + kFaces)},
      {"not-a-mesh", ply("element face 1\nproperty int vertex_indices\nend_header\n")},
      {"not-a-mesh", ply("element face 1\nproperty list uchar float vertex_index\nend_header\n")},
      {"not-a-mesh", ply("element face 1\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")},
      {"mesh-truncated",
       ply("element tristrips 1\nproperty list int int vertex_indices\nend_header\n")},
      {"not-a-mesh", ply("element tristrips 1\nproperty int vertex_indices\nend_header\n")},
      {"not-a-mesh", "ply\nformat ebcdic 1.0\nend_header\n"},
      {"not-a-mesh", "ply\nelement vertex -3\nend_header\n"},
      {"not-a-mesh", "ply\nproperty float x\nend_header\n"},
      {"not-a-mesh", "ply\nend_header\n"},
      {"mesh-bad-index", kThree + "f 1 2 4\n"},
      {"mesh-bad-index", kThree + "f 0 1 2\n"},
      {"mesh-bad-index", kThree + "f -1 -2 -4\n"},
      {"mesh-bad-index", kThree + "f 1 2 4000000000\n"},
      {"mesh-bad-index", "f 1 2 3\n"},
      {"mesh-bad-index", ply(kFaces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n")},
      {"mesh-bad-index", ply(kFaces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n")},
      {"mesh-not-finite", kThree + "v nan 0 0\nf 1 2 3\n"},
      {"mesh-not-finite", "v -1.#IND 0 0\n" + kThree + "f 1 2 3\n"},
      {"mesh-not-finite", "v 0 -inf 0\n" + kThree + "f 1 2 3\n"},
      {"mesh-not-finite", "v 0 1e39 0\n" + kThree + "f 1 2 3\n"},
      {"mesh-not-finite", "v 0 0 1e999\n" + kThree + "f 1 2 3\n"},
      {"mesh-not-finite", "solid\n" + kOpenFacet + "NaN 0 0 endloop endfacet\nendsolid\n"},
      {"mesh-not-finite", ply(kFaces + "0 0 0\n1 0 0\n0 1 infinity\n3 0 1 2\n")},
  };
  for (const auto& [code, bytes, name] : cases)
    EXPECT_EQ(code_of_bytes(bytes, name), code) << bytes;
}

TEST(ReadMesh, RefusesBytesThatAreNotFinite) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
    TriangleMesh mesh = kSoundBox;
    mesh.vertices[3].y() = static_cast<double>(bad);
    EXPECT_EQ(code_of_bytes(test::as_binary_stl(mesh)), "mesh-not-finite");
    EXPECT_EQ(code_of_bytes(test::as_binary_ply(mesh, false)), "mesh-not-finite");
    EXPECT_EQ(code_of_bytes(test::as_binary_ply(mesh, true)), "mesh-not-finite");
  }
}

TEST(ReadMesh, RefusesSizesThatCannotBeMeant) {
  const auto scaled = [](double x, double y, double z) {
    return code_of_bytes(test::as_binary_stl(test::box({0, 0, 0}, {x, y, z})));
  };
  EXPECT_EQ(scaled(0, 0, 0), "mesh-extent");
  EXPECT_EQ(scaled(1e-13, 0, 1e-13), "mesh-extent");
  EXPECT_EQ(scaled(1, 2e15, 1), "mesh-extent");
  EXPECT_EQ(scaled(1e-11, 0, 0), "fine");
  EXPECT_EQ(scaled(1, 0, 1), "fine");
  EXPECT_EQ(scaled(9e14, 1, 1), "fine");
}

TEST(ReadMesh, AcceptsPaddingButNothingElseAfterTheLastElement) {
  for (const auto& bytes :
       {test::as_binary_stl(kSoundBox), test::as_binary_ply(kSoundBox, false)}) {
    EXPECT_EQ(code_of_bytes(bytes + std::string(300, '\0')), "fine");
    EXPECT_EQ(code_of_bytes(bytes + "\r\n"), "fine");
    EXPECT_EQ(code_of_bytes(bytes + "more"), "not-a-mesh");
  }
  std::string fewer = test::as_binary_stl(kSoundBox);
  fewer[80] = 11;  // of twelve
  EXPECT_EQ(code_of_bytes(fewer), "not-a-mesh");
  EXPECT_EQ(code_of_bytes(fewer, "a.stl"), "not-a-mesh");
}

TEST(ReadMesh, BelievesNoCountThatTheFileDoesNotHold) {
  std::string stl = test::as_binary_stl(kSoundBox);
  std::memset(stl.data() + 80, 0xFF, 4);
  EXPECT_EQ(code_of_bytes(stl), "not-a-mesh");
  EXPECT_EQ(code_of_bytes(stl, "a.stl"), "mesh-truncated");
  for (const char* many : {"4294967295", "9223372036854775807"}) {
    const std::string element = std::string("element vertex ") + many;
    for (const auto& text : {test::as_text_ply(kSoundBox), test::as_binary_ply(kSoundBox, false)}) {
      const std::string code = code_of_bytes(replaced(text, "element vertex 8", element));
      EXPECT_TRUE(code == "mesh-truncated" || code == "not-a-mesh") << code;
      EXPECT_EQ(code_of_bytes(replaced(text, "face 12", std::string("face ") + many)),
                "mesh-truncated");
    }
  }
  EXPECT_EQ(code_of_bytes(ply("property list uint char w\n" + kFaces + "0 0 0 4294967295 1\n")),
            "mesh-truncated");
}

TEST(ReadMesh, RefusesEveryCutOfASmallFile) {
  const TriangleMesh one = test::triangle({1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  for (const auto& [name, bytes] : all_formats(one)) {
    if (name == "OBJ" || name.ends_with("VTK")) continue;
    // A text whose last line lost only its line end, or the name of its solid, is whole.
    std::size_t whole = bytes.size();
    if (name == "text STL") whole = bytes.find("endsolid") + 8;
    if (name == "text PLY" || name == "OFF" || name.find("VT") != name.npos)
      whole = bytes.size() - 1;
    // Before the name of its first element, an XML could be of any format.
    const std::size_t named = name == "VTP" ? bytes.find("VTKFile") + 7 : 0;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const std::string code = code_of_bytes(bytes.substr(0, size), "a.stl");
      if (size >= whole) {
        EXPECT_EQ(code, "fine") << name << " at " << size;
      } else {
        const char* expected = size == 0      ? "mesh-empty"
                               : size < named ? "not-a-mesh"
                                              : "mesh-truncated";
        EXPECT_EQ(code, expected) << name << " at " << size;
      }
    }
  }
}

TEST(ReadMesh, RefusesAnObjThatIsCutWhereItShows) {
  const std::string text = kThree + "f 1 2 3\n";
  for (std::size_t size = 0; size < text.size() - 1; ++size)
    EXPECT_NE(code_of_bytes(text.substr(0, size)), "fine") << size;
  EXPECT_EQ(code_of_bytes(text.substr(0, text.size() - 3)), "mesh-truncated");
  EXPECT_EQ(code_of_bytes("v 0 0 0\nv 1 0"), "mesh-truncated");
}

// No byte of a file may bring more than an error: the seed of the fuzzer.
TEST(ReadMesh, AnyByteMayBeWrong) {
  const test::MemoryFile file;
  const TriangleMesh two = test::open_strip(1);
  for (const auto& [name, bytes] : all_formats(two)) {
    const bool imported = name.starts_with("gl") || name.starts_with("GL");  // a process each
    for (std::size_t at = 0; at < bytes.size(); at += imported ? 53 : 1) {
      for (const char wrong : {'\0', '\n', ' ', '9', '-', '/', '\x7F', '\xFF'}) {
        std::string changed = bytes;
        changed[at] = wrong;
        try {
          file.write(changed);
          const TriangleMesh mesh = read_mesh(file.path());
          for (const Triangle& triangle : mesh.triangles)
            for (const std::uint32_t vertex : triangle) ASSERT_LT(vertex, mesh.vertices.size());
        } catch (const Error&) {
        }
      }
    }
  }
}

TEST(ReadMesh, SaysWhatWhereAndWhatToDo) {
  const TempDir folder;
  const std::filesystem::path file = folder.write("jaw.obj", kThree + "f 1 2 9\n");
  try {
    static_cast<void>(read_mesh(file));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), file.string() +
                                ": line 4: a face names vertex 9, which does not exist; "
                                "export the mesh again");
  }
}

// The cause, without the file's name.
std::string cause(std::string_view bytes, const char* name) {
  const TempDir folder;
  const std::filesystem::path file = folder.write(name, bytes);
  try {
    static_cast<void>(read_mesh(file));
  } catch (const Error& error) {
    return std::string(error.what()).substr(file.string().size() + 2);
  }
  return "fine";
}

TEST(ReadMesh, NamesFormatsThatItDoesNotRead) {
  const std::string zeros(2000, '\0'), blank(2000, '\1');
  for (const auto& [format, bytes] : std::vector<std::pair<const char*, std::string>>{
           {"Blender's", "BLENDER-v293" + blank},
           {"Draco", "DRACO\2\2" + blank},
           {"XML", "<?xml version=\"1.0\"?>\n<a></a>\n"},
           {"DICOM", std::string(128, '\0') + "DICM" + blank},
           {"gzip, a packed file", "\x1F\x8B\x08" + blank}}) {
    for (const char* name : {"a.stl", "a", "a.vtk"}) {
      EXPECT_EQ(cause(bytes, name),
                std::string("the file's format is ") + format + ", and the supported formats are " +
                    std::string(kMeshFormats) + "; export the mesh as one of them")
          << name;
    }
  }
  EXPECT_TRUE(cause(blank, "a.lwo").starts_with("the content is in no supported format"));
}

TEST(ReadMesh, SaysThatATreeIsNoMesh) {
  const std::string begin("\x89IST\r\n\x1A\n", 8);
  for (const std::string& bytes : {begin, begin + std::string(2000, '\1')}) {
    for (const char* name : {"upper.ist", "upper.stl", "upper"}) {
      EXPECT_EQ(cause(bytes, name),
                "the file is a tree of IST; read it by read_tree, ist_tree_load or ist.load, or "
                "name the mesh that it was built from");
    }
  }
  EXPECT_FALSE(cause(begin.substr(0, 7), "a").starts_with("the file is a tree"));
}

TEST(ReadMesh, NamesUtf16) {
  const std::string text = test::as_obj(kSoundBox);
  for (const bool big : {false, true}) {
    std::string wide;
    for (const char c : text) wide += big ? std::string{'\0', c} : std::string{c, '\0'};
    for (const char* mark : {"", big ? "\xFE\xFF" : "\xFF\xFE"}) {
      for (const char* name : {"a.obj", "a.stl"}) {
        EXPECT_EQ(cause(mark + wide, name),
                  "the text is UTF-16; save it as UTF-8 or ASCII, or export the mesh again");
      }
    }
  }
}

TEST(ReadMesh, NamesABinaryOff) {
  const TempDir folder;
  for (const std::string& content : {std::string("8 12 0\n"), std::string("\0\0\0\3\xFF\n", 6)}) {
    const std::filesystem::path file = folder.write("a.off", "STOFF BINARY\n" + content);
    const auto error = test::error_of([&] { static_cast<void>(read_mesh(file)); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->what(),
              file.string() + ": line 1: a binary OFF is not supported; export it as text");
  }
}

// One number, one answer: whichever format spells it.
TEST(ReadMesh, ReadsANumberAlikeInEveryFormat) {
  const std::pair<const char*, std::vector<std::string>> numbers[] = {
      {"fine", {"+1", "1e-400", "-1e-50"}},
      {"mesh-not-finite", {"1e400", "-1e39", "inf", "NaN", "-nan(ind)", "1.#QNAN", "-1.#IND"}},
      {"not-a-mesh", {"1,5", "0x1", "++1", "1e-400x", "1e400,5", "one"}}};
  const TriangleMesh one = test::triangle({7, 0, 0}, {0, 1, 0}, {0, 0, 1});
  const std::string xml = test::threemf_model(one);
  for (const auto& [code, texts] : numbers) {
    for (const std::string& text : texts) {
      EXPECT_EQ(code_of_bytes("v " + text + " 0 0\n" + kThree + "f 1 3 4\n"), code) << text;
      EXPECT_EQ(code_of_bytes(replaced(kOff, "0 1 0", text + " 1 0") + "3 0 1 2\n"), code) << text;
      EXPECT_EQ(code_of_bytes(ply(kFaces + text + " 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")), code) << text;
      EXPECT_EQ(code_of_bytes(replaced(test::as_text_stl(one), "7", text)), code) << text;
      EXPECT_EQ(code_of_bytes(test::as_3mf(replaced(xml, "\"7\"", "\"" + text + "\""))), code)
          << text;
    }
  }
}

TEST(ReadMesh, RefusesFilesThatCannotBeRead) {
  const TempDir folder;
  EXPECT_EQ(code_of(folder.path() / "missing.stl"), "file-unreadable");
  EXPECT_EQ(code_of(folder.path()), "file-unreadable");
  ASSERT_EQ(::mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(code_of(folder.path() / "pipe"), "file-unreadable");
}

// Root may read every file, so it steps down to the user that owns none.
class NoPrivileges {
 public:
  NoPrivileges() : before_(::geteuid()) {
    if (before_ == 0 && ::seteuid(kNobody) != 0) ADD_FAILURE() << "still root";
  }
  ~NoPrivileges() { EXPECT_EQ(::seteuid(before_), 0); }
  NoPrivileges(const NoPrivileges&) = delete;
  NoPrivileges& operator=(const NoPrivileges&) = delete;

 private:
  static constexpr uid_t kNobody = 65534;
  uid_t before_;
};

TEST(ReadMesh, RefusesFilesWithoutPermission) {
  const TempDir folder;
  const std::filesystem::path file = folder.write("a.stl", test::as_binary_stl(kSoundBox));
  std::filesystem::permissions(folder.path(), std::filesystem::perms::others_exec,
                               std::filesystem::perm_options::add);
  std::filesystem::permissions(file, std::filesystem::perms::none);
  const NoPrivileges scope;
  EXPECT_EQ(code_of(file), "file-unreadable");
}

TEST(ReadMesh, RefusesARealStlWhereverItIsCut) {
  if (!std::filesystem::is_directory(test::data_dir()))
    IST_SKIP("no folder of real meshes at " << test::data_dir());
  const TempDir folder;
  const std::string bytes = test::file_content(test::data_dir() / "spl_mandible.stl");
  for (const char* name : {"a.stl", "a"}) {
    for (const std::size_t size : {std::size_t{83}, std::size_t{84}, std::size_t{5000},
                                   bytes.size() / 2, bytes.size() - 1}) {
      const std::string code = code_of(folder.write(name, bytes.substr(0, size)));
      if (std::string_view(name) == "a.stl" || size > 134) {
        EXPECT_EQ(code, "mesh-truncated") << name << " at " << size;
      } else {
        EXPECT_EQ(code, "not-a-mesh") << name << " at " << size;  // nothing shows what it was
      }
    }
  }
  EXPECT_EQ(code_of(folder.write("a.stl", "")), "mesh-empty");
  EXPECT_EQ(code_of(folder.write("a.stl", bytes.substr(0, 1))), "mesh-empty");  // a blank
}

}  // namespace
}  // namespace ist
