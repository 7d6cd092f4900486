#include "import/scene_files.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <vector>

namespace ist::test {
namespace {

using Point = std::array<int, 3>;
using Face = std::vector<int>;

const std::array<Point, 8> kPoints = {
    {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {1, 2, 0}, {0, 0, 3}, {1, 0, 3}, {0, 2, 3}, {1, 2, 3}}};
const std::vector<Face> kQuads = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                  {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

std::vector<Face> triangles() {
  std::vector<Face> all;
  for (const Face& quad : kQuads) {
    all.push_back({quad[0], quad[1], quad[2]});
    all.push_back({quad[0], quad[2], quad[3]});
  }
  return all;
}

template <class Range>
std::string joined_text(const Range& range, const std::string& between,
                        const std::function<std::string(const typename Range::value_type&)>& text) {
  std::string all;
  for (const auto& element : range) all += (all.empty() ? "" : between) + text(element);
  return all;
}

std::string points(const std::string& coordinate, const std::string& point) {
  return joined_text(kPoints, point, [&](const Point& p) {
    return fmt::format("{}{}{}{}{}", p[0], coordinate, p[1], coordinate, p[2]);
  });
}

std::string faces(const std::vector<Face>& all, const std::string& corner,
                  const std::string& face) {
  return joined_text(all, face, [&](const Face& f) {
    return joined_text(f, corner, [](int index) { return std::to_string(index); });
  });
}

}  // namespace

std::string box_dae(const std::string& unit, const std::string& up, const std::string& in_node) {
  return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
         "version=\"1.4.1\"><asset>" +
         unit + "<up_axis>" + up +
         "</up_axis></asset><library_geometries><geometry id=\"g\"><mesh><source id=\"p\">"
         "<float_array id=\"pa\" count=\"24\">" +
         points(" ", " ") +
         "</float_array><technique_common><accessor source=\"#pa\" count=\"8\" stride=\"3\">"
         "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/>"
         "<param name=\"Z\" type=\"float\"/></accessor></technique_common></source>"
         "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>"
         "<polylist count=\"6\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>"
         "<vcount>4 4 4 4 4 4</vcount><p>" +
         faces(kQuads, " ", " ") +
         "</p></polylist></mesh></geometry></library_geometries><library_visual_scenes>"
         "<visual_scene id=\"s\"><node id=\"n\">" +
         in_node +
         "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes>"
         "<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";
}

std::string box_x3d(const std::string& around, const std::string& end) {
  return "<?xml version=\"1.0\"?><X3D version=\"3.0\" profile=\"Interchange\"><Scene>" + around +
         "<Shape><IndexedFaceSet coordIndex=\"" + faces(kQuads, " ", " -1 ") +
         " -1\"><Coordinate point=\"" + points(" ", " ") + "\"/></IndexedFaceSet></Shape>" + end +
         "</Scene></X3D>";
}

std::string box_amf(const std::string& attributes, const std::string& extra) {
  std::string text =
      "<?xml version=\"1.0\"?><amf" + attributes + "><object id=\"1\"><mesh><vertices>";
  for (const Point& p : kPoints)
    text += fmt::format("<vertex><coordinates><x>{}</x><y>{}</y><z>{}</z></coordinates></vertex>",
                        p[0], p[1], p[2]);
  text += "</vertices><volume>";
  for (const Face& f : triangles())
    text += fmt::format("<triangle><v1>{}</v1><v2>{}</v2><v3>{}</v3></triangle>", f[0], f[1], f[2]);
  return text + "</volume></mesh></object>" + extra + "</amf>";
}

// A negative index ends a polygon: -1 - index.
std::string box_fbx(const std::string& unit_scale_factor) {
  std::vector<Face> polygons = kQuads;
  for (Face& polygon : polygons) polygon.back() = -1 - polygon.back();
  return "; FBX 7.3.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: "
         "1003\n\tFBXVersion: "
         "7300\n}\nGlobalSettings:  {\n\tVersion: 1000\n\tProperties70:  {\n\t\tP: "
         "\"UnitScaleFactor\", \"double\", \"Number\", \"\"," +
         unit_scale_factor +
         "\n\t}\n}\nDefinitions:  {\n\tVersion: 100\n\tCount: 2\n}\nObjects:  {\n\tGeometry: 10, "
         "\"Geometry::box\", \"Mesh\" {\n\t\tVertices: *24 {\n\t\t\ta: " +
         points(",", ",") +
         "\n\t\t}\n\t\tPolygonVertexIndex: *24 {\n\t\t\ta: " + faces(polygons, ",", ",") +
         "\n\t\t}\n\t\tGeometryVersion: 124\n\t}\n\tModel: 20, \"Model::box\", \"Mesh\" "
         "{\n\t\tVersion: 232\n\t\tProperties70:  {\n\t\t\tP: \"Lcl Translation\", \"Lcl "
         "Translation\", \"\", \"A\",5,0,0\n\t\t}\n\t}\n}\nConnections:  {\n\tC: \"OO\",20,0\n\tC: "
         "\"OO\",10,20\n}\n";
}

std::string box_ac() {
  std::string text =
      "AC3Db\nMATERIAL \"m\" rgb 1 1 1 amb 1 1 1 emis 0 0 0 spec 0 0 0 shi 0 trans 0\nOBJECT "
      "world\nkids 1\nOBJECT poly\nloc 1 2 3\nnumvert 8\n" +
      points(" ", "\n") + "\nnumsurf 6\n";
  for (const Face& quad : kQuads)
    text += fmt::format("SURF 0x0\nmat 0\nrefs 4\n{} 0 0\n{} 0 0\n{} 0 0\n{} 0 0\n", quad[0],
                        quad[1], quad[2], quad[3]);
  return text + "kids 0\n";
}

std::string box_3ds() {
  const auto bytes = [](auto value) {
    std::string all(sizeof value, '\0');
    std::memcpy(all.data(), &value, sizeof value);
    return all;
  };
  const auto chunk = [&](int id, const std::string& content) {
    return bytes(static_cast<std::uint16_t>(id)) +
           bytes(static_cast<std::uint32_t>(6 + content.size())) + content;
  };
  std::string vertices = bytes(std::uint16_t{8}), corners = bytes(std::uint16_t{12});
  for (const Point& p : kPoints)
    for (const int coordinate : p) vertices += bytes(static_cast<float>(coordinate));
  for (const Face& f : triangles()) {
    for (const int corner : f) corners += bytes(static_cast<std::uint16_t>(corner));
    corners += bytes(std::uint16_t{7});
  }
  const std::string object =
      std::string("box") + '\0' + chunk(0x4100, chunk(0x4110, vertices) + chunk(0x4120, corners));
  const std::string version = bytes(std::uint32_t{3});
  return chunk(0x4D4D, chunk(0x0002, version) +
                           chunk(0x3D3D, chunk(0x3D3E, version) + chunk(0x4000, object)));
}

bool says_crash(const std::string& refusal) {
  return refusal.find("the importer ended by signal ") != refusal.npos ||
         refusal.find("ended without a complete answer (exit code") != refusal.npos;
}

}  // namespace ist::test
