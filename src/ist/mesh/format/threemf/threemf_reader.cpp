#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <system_error>
#include <unordered_map>
#include <utility>
#include <vector>

#include "ist/base/platform/from_chars.h"
#include "ist/base/printable.h"
#include "ist/mesh/format/affine.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/format/placed_meshes.h"
#include "ist/mesh/format/text_reader.h"
#include "ist/mesh/format/threemf/xml_reader.h"
#include "ist/mesh/format/threemf/zip_entry.h"

namespace ist {
namespace {

// Returns the name of the model's part, which the package's relationships tell; where they do not,
// the usual one.
std::string model_part(std::string_view archive, std::string_view file) {
  constexpr std::string_view kRelationships = "_rels/.rels",
                             kType = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
  const std::string text = unzip(archive, kRelationships, file).value_or("");
  XmlReader xml(text, file, kRelationships);
  for (auto tag = xml.next(); tag != XmlReader::Tag::kEnd; tag = xml.next()) {
    if (tag != XmlReader::Tag::kOpen || xml.attribute("Type") != kType) continue;
    std::string_view target = xml.attribute("Target").value_or("");
    if (target.starts_with('/')) target.remove_prefix(1);
    if (!target.empty()) return std::string(target);
  }
  return "3D/3dmodel.model";
}

// Reads the objects of a model, meshes or components that place other objects, and places those
// that the build names.
class ThreeMfReader {
 public:
  // `part` is the name of the model in the archive.
  ThreeMfReader(std::string_view model, std::string_view file, std::string_view part)
      : xml_(model, file, part), placed_(file) {}

  TriangleMesh read() {
    for (auto tag = xml_.next(); tag != XmlReader::Tag::kEnd; tag = xml_.next()) {
      if (!root_seen_) read_namespaces();
      if (tag == XmlReader::Tag::kOpen) {
        open(core_name());
      } else if (core_name() == "object" && is_open_) {
        is_open_ = false;
        known_.emplace(id_, objects_.size() - 1);
      }
    }
    for (const Use& item : items_) place(item);
    return placed_.finish();
  }

 private:
  // An object, where a transform places it.
  struct Use {
    std::size_t object;
    Eigen::Affine3d transform;
  };
  struct Object {
    std::uint32_t id;
    TriangleMesh mesh;
    std::vector<Use> components;
  };

  // The root declares whether names of the core have a prefix.
  void read_namespaces() {
    constexpr std::string_view kDefault = "xmlns", kWithPrefix = "xmlns:",
                               kCore = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
    root_seen_ = true;
    bool plain = false;
    for (const auto& [name, space] : xml_.attributes()) {
      if (space != kCore) continue;
      if (name == kDefault) plain = true;
      if (name.starts_with(kWithPrefix)) prefix_ = name.substr(kWithPrefix.size());
    }
    is_plain_core_ = plain || prefix_.empty();
  }

  // The element's name in the core; empty for another namespace.
  std::string_view core_name() const {
    const std::string_view name = xml_.name();
    const std::size_t colon = name.find(':');
    if (colon == name.npos) return is_plain_core_ ? name : "";
    return name.substr(0, colon) == prefix_ ? name.substr(colon + 1) : "";
  }

  void open(std::string_view name) {
    if (name == "model") {
      const auto required = xml_.attribute("requiredextensions").value_or("");
      if (!required.empty())
        xml_.fail(
            ErrorCode::kNotAMesh,
            fmt::format("the extensions '{}' are not supported; export a plain 3MF, or an STL",
                        printable(required)));
    } else if (name == "object") {
      if (is_open_) xml_.fail(ErrorCode::kNotAMesh, "an object is in another; export it again");
      id_ = whole("id");
      if (known_.contains(id_))
        xml_.fail(ErrorCode::kNotAMesh,
                  fmt::format("object {} is defined twice; export the mesh again", id_));
      objects_.push_back({id_, {}, {}});
      is_open_ = true;
    } else if (name == "vertex") {
      object().mesh.vertices.emplace_back(coordinate("x"), coordinate("y"), coordinate("z"));
    } else if (name == "triangle") {
      read_triangle(object().mesh);
    } else if (name == "component") {
      object().components.push_back(use());
    } else if (name == "item") {
      items_.push_back(use());
    }
  }

  Object& object() {
    if (!is_open_)
      xml_.fail(ErrorCode::kNotAMesh,
                fmt::format("<{}> is in no object; export the mesh again", printable(xml_.name())));
    return objects_.back();
  }

  void read_triangle(TriangleMesh& mesh) {
    const Triangle triangle = {whole("v1"), whole("v2"), whole("v3")};
    for (const std::uint32_t corner : triangle)
      if (corner >= mesh.vertices.size())
        xml_.fail(
            ErrorCode::kMeshBadIndex,
            fmt::format("a triangle names vertex {}, but there are {}, counted from 0; export "
                        "the mesh again",
                        corner, mesh.vertices.size()));
    mesh.triangles.push_back(triangle);
  }

  // Only what is defined before can be named, so that no object holds itself.
  Use use() {
    const std::uint32_t id = whole("objectid");
    const auto known = known_.find(id);
    if (known == known_.end())
      xml_.fail(
          ErrorCode::kMeshBadIndex,
          fmt::format("object {} is not defined before it is named; export the mesh again", id));
    return {known->second, transform()};
  }

  // Twelve numbers: where the axes x, y and z and the origin come to lie.
  Eigen::Affine3d transform() const {
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    const auto text = xml_.attribute("transform");
    if (!text) return result;
    std::array<double, 12> numbers{};
    TextReader words(*text, "");
    for (double& value : numbers) value = number(words.word_of_any_line(), "transform");
    if (!words.word_of_any_line().empty())
      xml_.fail(ErrorCode::kNotAMesh, "a transform has more than twelve numbers; export it again");
    result.matrix().topRows<3>() = Eigen::Map<const Eigen::Matrix<double, 3, 4>>(numbers.data());
    return result;
  }

  std::string_view needed(const char* name) const {
    const auto text = xml_.attribute(name);
    if (!text)
      xml_.fail(ErrorCode::kNotAMesh,
                fmt::format("<{}> has no {}; export the mesh again", printable(xml_.name()), name));
    return *text;
  }

  std::uint32_t whole(const char* name) const {
    const std::string_view text = needed(name);
    std::uint32_t value = 0;
    const auto [stop, error] = from_chars(text, value);
    if (error != std::errc() || stop != text.data() + text.size())
      xml_.fail(ErrorCode::kNotAMesh,
                fmt::format("{}=\"{}\" is no whole number; export the mesh again", name,
                            printable(text)));
    return value;
  }

  double coordinate(const char* name) const {
    const double value = number(needed(name), name);
    if (!is_coordinate(value))
      xml_.fail(ErrorCode::kMeshNotFinite,
                fmt::format("{}=\"{}\" is not finite, or beyond a float's range; repair the mesh "
                            "where it was made",
                            name, printable(needed(name))));
    return value;
  }

  double number(std::string_view text, const char* name) const {
    const std::optional<double> value = number_of(text, Precision::kDouble);
    if (!value)
      xml_.fail(ErrorCode::kNotAMesh,
                fmt::format("{}: '{}' is no number; export the mesh again", name, printable(text)));
    return *value;
  }

  // Places an object before its components, and these in the order of the file.
  void place(const Use& item) {
    std::vector<Use> left = {item};  // the next one last
    while (!left.empty()) {
      const Use use = left.back();
      left.pop_back();
      const Object& object = objects_[use.object];
      const std::string place = fmt::format("object {}", object.id);
      placed_.expect(
          object.mesh.vertices.size() + 3 * object.mesh.triangles.size() + object.components.size(),
          place);
      placed_.add(object.mesh, use.transform, place);
      for (std::size_t i = object.components.size(); i-- > 0;) {
        const Use& component = object.components[i];
        left.push_back({component.object, joined(use.transform, component.transform)});
      }
    }
  }

  XmlReader xml_;
  PlacedMeshes placed_;
  bool root_seen_ = false, is_plain_core_ = true;
  std::string_view prefix_;  // of the core's names, empty without one
  std::vector<Object> objects_;
  bool is_open_ = false;                                  // the last object
  std::uint32_t id_ = 0;                                  // of the last object
  std::unordered_map<std::uint32_t, std::size_t> known_;  // the objects that are closed, by id
  std::vector<Use> items_;
};

}  // namespace

TriangleMesh read_3mf(std::string_view content, std::string_view file) {
  const std::string part = model_part(content, file);
  const std::optional<std::string> model = unzip(content, part, file);
  if (!model)
    fail_mesh(ErrorCode::kNotAMesh, file, printable(part),
              "the archive does not hold it; convert the mesh to 3MF or STL");
  return ThreeMfReader(*model, file, part).read();
}

}  // namespace ist
