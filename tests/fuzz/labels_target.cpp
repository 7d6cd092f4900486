// Tooth labels of a tetrahedron: the first byte says what the file's name ends with (p: .ply, o:
// .obj, v: .vtk, else .txt), and by a capital letter that numbers are universal ones; the rest is
// its content.

#include <algorithm>
#include <cctype>

#include "answers/occlusion/labels/tooth_labels.h"
#include "fuzz/fuzz_target.h"
#include "fuzz/named_file.h"
#include "ist/base/error.h"

namespace ist::test {

std::string fuzz_labels(std::string_view bytes) {
  if (bytes.empty()) return "nothing";
  static const NamedFile file({"labels.ply", "labels.obj", "labels.vtk", "labels.txt"});
  const TriangleMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                             {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const auto first = static_cast<unsigned char>(bytes[0]);
  const char* name = std::tolower(first) == 'p'   ? "labels.ply"
                     : std::tolower(first) == 'o' ? "labels.obj"
                     : std::tolower(first) == 'v' ? "labels.vtk"
                                                  : "labels.txt";
  const auto numbers =
      std::isupper(first) != 0 ? answers::ToothNumbers::kUniversal : answers::ToothNumbers::kFdi;
  answers::ToothLabels labels;
  try {
    labels = answers::read_labels(file.write(name, bytes.substr(1)), mesh, numbers);
  } catch (const Error& error) {
    const std::string_view text = error.what();
    require(text.find(name) != std::string_view::npos, "an error does not name the file");
    return to_string(error.code());
  }
  require(labels.size() == mesh.triangles.size(), "a triangle has no label");
  require(std::all_of(labels.begin(), labels.end(),
                      [&](int label) { return answers::is_tooth_number(label, numbers); }),
          "a label is no number of the system");
  return "fine";
}

}  // namespace ist::test
