#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <system_error>
#include <vector>

#include "import/readers.h"
#include "import/scene_format.h"
#include "import/slicer_parts.h"
#include "import/zip_parts.h"
#include "ist/base/platform/from_chars.h"
#include "ist/base/printable.h"
#include "ist/mesh/format/text_reader.h"

namespace ist::import {
namespace {

using Node = pugi::xml_node;

struct Object {
  Node node;         // <mesh> or <components>
  std::string flaw;  // of an object that cannot be placed
  bool is_body = true;
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

std::string_view local_name(std::string_view name) { return name.substr(name.find(':') + 1); }

// A part of the archive that holds objects.
class Model {
 public:
  Model(ZipParts& archive, std::string_view name)
      : name_(printable(name.substr(name.starts_with('/') ? 1 : 0), 200)) {
    const std::optional<std::string> text = archive.part(name);
    if (!text)
      fail(
          "the zip holds no such 3D model, so it is no 3MF project; unpack it and give the mesh in "
          "it, or export the mesh as 3MF or STL");
    const pugi::xml_parse_result result = document_.load_buffer(text->data(), text->size());
    if (!result) {
      const auto at = text->begin() + std::min<std::ptrdiff_t>(result.offset, std::ssize(*text));
      refuse(text->end() - at < 2 ? ErrorCode::kMeshTruncated : ErrorCode::kNotAMesh,
             fmt::format("{}, line {}", name_, 1 + std::count(text->begin(), at, '\n')),
             fmt::format("it is no XML ({}); copy or export the mesh again", result.description()));
    }
    root_ = document_.document_element();
    const std::string_view root = root_.name();
    if (local_name(root) != "model" || root_.next_sibling())
      fail("it is not one model; export the mesh again");
    prefix_ = root.substr(0, root.size() - local_name(root).size());  // of all names of the core
    require_known_extensions();
    for (const Node& object : children(child(root_, "resources"), "object")) add(object);
  }

  // Returns an object with its vertices and triangles.
  Object& object(std::uint32_t id) {
    const auto found = objects_.find(id);
    if (found == objects_.end())
      refuse(ErrorCode::kMeshBadIndex, name_,
             fmt::format("object {} is named, but not defined; export the mesh again", id));
    Object& object = found->second;
    if (!object.flaw.empty()) fail(object.flaw);
    if (object.is_body && object.vertices.empty() && is(object.node, "mesh")) read_mesh(object);
    return object;
  }

  [[nodiscard]] const Node& root() const { return root_; }
  [[nodiscard]] bool is(const Node& node, std::string_view name) const {
    return std::string_view(node.name()).starts_with(prefix_) &&
           std::string_view(node.name()).substr(prefix_.size()) == name;
  }
  [[nodiscard]] Node child(const Node& node, const char* name) const {
    return node.child((prefix_ + name).c_str());
  }
  [[nodiscard]] pugi::xml_object_range<pugi::xml_named_node_iterator> children(
      const Node& node, const char* name) const {
    // The range keeps the pointer.
    return node.children(names_.emplace(name, prefix_ + name).first->second.c_str());
  }
  [[noreturn]] void fail(std::string_view cause) const {
    refuse(ErrorCode::kNotAMesh, name_, cause);
  }
  [[nodiscard]] std::uint32_t whole(const Node& node, const char* attribute) const {
    const std::string_view text = needed(node, attribute);
    std::uint32_t value = 0;
    const auto [stop, error] = from_chars(text, value);
    if (error != std::errc() || stop != text.data() + text.size())
      fail(fmt::format("{}=\"{}\" is no whole number; export the mesh again", attribute,
                       printable(text)));
    return value;
  }
  [[nodiscard]] double number(std::string_view text, const char* attribute) const {
    TextReader words(text, "");  // blanks may stand round it
    const std::optional<double> value = number_of(words.word_of_any_line(), Precision::kDouble);
    if (!value || !words.word_of_any_line().empty())
      fail(fmt::format("{}: '{}' is no number; export the mesh again", attribute, printable(text)));
    return *value;
  }

 private:
  void require_known_extensions() const {
    constexpr std::string_view kKnown[] = {"/core/",  "/production/",  "/material/",
                                           "/slice/", "/beamlattice/", "/trianglesets/"};
    const std::string_view required = root_.attribute("requiredextensions").value();
    TextReader words(required, "");
    for (auto word = words.word_of_any_line(); !word.empty(); word = words.word_of_any_line()) {
      const std::string space = root_.attribute(fmt::format("xmlns:{}", word).c_str()).value();
      if (std::none_of(std::begin(kKnown), std::end(kKnown),
                       [&](std::string_view known) { return space.find(known) != space.npos; }))
        fail(fmt::format("the extension '{}' is not supported; export a plain 3MF, or an STL",
                         printable(word)));
    }
  }

  void add(const Node& node) {
    const std::uint32_t id = whole(node, "id");
    const Node mesh = child(node, "mesh"), components = child(node, "components");
    if (!objects_.emplace(id, Object{mesh ? mesh : components, {}, true, {}, {}}).second)
      fail(fmt::format("object {} is defined twice; export the mesh again", id));
    if (mesh && components)
      fail(fmt::format("object {} is a mesh and has components; export it again", id));
    Object& object = objects_.at(id);
    std::string& flaw = object.flaw;
    const std::string_view type = node.attribute("type").value();
    if (type == "support" || type == "solidsupport") object.is_body = false;
    for (const Node& data : children(child(node, "metadatagroup"), "metadata")) {
      const std::string_view setting = local_name(data.attribute("name").value());
      if (!same_word(data.text().get(), "true")) continue;
      if (setting == "anti_overhang_mesh" || setting == "support_mesh" || setting == "infill_mesh")
        object.is_body = false;
      if (setting == "cutting_mesh")
        flaw = fmt::format("object {} cuts others (cutting_mesh); export the plate as an STL", id);
    }
    for (const pugi::xml_attribute& attribute : node.attributes())
      if (local_name(attribute.name()) == "meshresolution" &&
          std::string_view(attribute.value()) == "lowres")
        flaw = fmt::format("object {} has its shape in slices alone; export it as a mesh", id);
    for (const Node& part : mesh.children())
      if (local_name(part.name()) == "beamlattice")
        flaw = fmt::format("object {} has beams, which are no triangles; export it as an STL", id);
    for (const Node& part : node.children())
      if (local_name(part.name()) == "booleanshape" ||
          local_name(part.name()) == "displacementmesh")
        flaw = fmt::format("object {} is no plain mesh; export it as an STL", id);
  }

  void read_mesh(Object& object) const {
    for (const Node& vertex : children(child(object.node, "vertices"), "vertex"))
      object.vertices.emplace_back(number(needed(vertex, "x"), "x"),
                                   number(needed(vertex, "y"), "y"),
                                   number(needed(vertex, "z"), "z"));
    for (const Node& triangle : children(child(object.node, "triangles"), "triangle"))
      object.triangles.push_back(
          {whole(triangle, "v1"), whole(triangle, "v2"), whole(triangle, "v3")});
  }

  [[nodiscard]] std::string_view needed(const Node& node, const char* name) const {
    const pugi::xml_attribute attribute = node.attribute(name);
    if (!attribute)
      fail(fmt::format("<{}> has no {}; export the mesh again", printable(node.name()), name));
    return attribute.value();
  }

  std::string name_, prefix_;
  pugi::xml_document document_;
  Node root_;
  std::map<std::uint32_t, Object> objects_;
  mutable std::map<std::string, std::string> names_;
};

// Returns the name of the root model. The package's relationships name it; the usual name is the
// default.
std::string root_part(ZipParts& archive) {
  constexpr std::string_view kType = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
  pugi::xml_document document;
  const std::string text = archive.part("_rels/.rels").value_or("");
  if (!text.empty() && !document.load_buffer(text.data(), text.size()))
    refuse(ErrorCode::kNotAMesh, "_rels/.rels", "it is no XML; copy or export the mesh again");
  for (const Node& relation : document.document_element().children())
    if (relation.attribute("Type").value() == kType) return relation.attribute("Target").value();
  return "3D/3dmodel.model";
}

class ThreeMfReader {
 public:
  explicit ThreeMfReader(std::string_view content) : archive_(content), slicer_(archive_) {
    root_ = model(root_part(archive_));
  }

  PlacedPolygons read() {
    const StatedUnit stated = unit_of(*root_);
    placed_.unit = stated.unit;
    placed_.factor = stated.factor;
    const Node build = root_->child(root_->root(), "build");
    for (const Node& item : root_->children(build, "item")) place(use_of(*root_, item));
    if (left_out_ && placed_.sizes().empty())
      refuse(ErrorCode::kMeshEmpty, "",
             "all of its objects are supports or modifiers; export the model itself");
    placed_.require_polygons();
    return std::move(placed_);
  }

 private:
  // An object of a model and its place.
  struct Use {
    Model* model;
    std::uint32_t object;
    Eigen::Affine3d transform;
    int depth = 0;
  };

  Model* model(const std::string& name) {
    std::unique_ptr<Model>& model = models_[name];
    if (model == nullptr) model = std::make_unique<Model>(archive_, name);
    if (root_ != nullptr && unit_of(*model) != unit_of(*root_))
      model->fail("its unit is another one than the root model's; export the mesh again");
    return model.get();
  }

  static StatedUnit unit_of(const Model& model) {
    const char* name = model.root().attribute("unit").as_string("millimeter");
    const StatedUnit stated = unit_of_name(name);
    if (stated.unit == LengthUnit::kUnknown)
      model.fail(fmt::format("its unit '{}' is not known; export the mesh again", printable(name)));
    return stated;
  }

  // Objects of other models have a path (production extension).
  Use use_of(Model& in, const Node& node) {
    Use use{&in, in.whole(node, "objectid"), transform_of(in, node)};
    for (const pugi::xml_attribute& attribute : node.attributes())
      if (local_name(attribute.name()) == "path") use.model = model(attribute.value());
    return use;
  }

  // Twelve numbers: the images of the axes x, y and z and of the origin.
  static Eigen::Affine3d transform_of(const Model& model, const Node& node) {
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    const pugi::xml_attribute text = node.attribute("transform");
    if (!text) return result;
    std::array<double, 12> numbers{};
    TextReader words(text.value(), "");
    for (double& value : numbers) value = model.number(words.word_of_any_line(), "transform");
    if (!words.word_of_any_line().empty())
      model.fail("a transform has more than twelve numbers; export it again");
    result.matrix().topRows<3>() = Eigen::Map<const Eigen::Matrix<double, 3, 4>>(numbers.data());
    return result;
  }

  // Places an object before its components, and these in the order of the file.
  void place(const Use& item) {
    constexpr int kDeepest = 100;
    std::vector<Use> left = {item};  // the next one last
    while (!left.empty()) {
      const Use use = left.back();
      left.pop_back();
      const Object& object = use.model->object(use.object);
      if (use.depth > kDeepest)
        use.model->fail(fmt::format(
            "object {} holds itself, or is nested too deeply; export the mesh again", use.object));
      if (!object.is_body) {
        left_out_ = true;
        continue;
      }
      place_mesh(object, use);
      std::vector<Use> components;
      if (!use.model->is(object.node, "components")) continue;
      for (const Node& node : use.model->children(object.node, "component")) {
        Use component = use_of(*use.model, node);
        if (use.model == root_ && !slicer_.is_body_part(use.object, component.object)) {
          left_out_ = true;
          continue;
        }
        component.transform = joined(use.transform, component.transform);
        component.depth = use.depth + 1;
        components.push_back(component);
      }
      left.insert(left.end(), components.rbegin(), components.rend());
    }
  }

  void place_mesh(const Object& object, const Use& use) {
    placed_.begin(object.vertices.size(), 3 * object.triangles.size(), use.transform,
                  fmt::format("object {}", use.object));
    for (const Eigen::Vector3d& vertex : object.vertices) placed_.add_vertex(vertex);
    for (std::size_t i = 0; i < object.triangles.size(); ++i)
      if (use.model != root_ || slicer_.is_body(use.object, i))
        placed_.add_polygon(object.triangles[i]);
      else
        left_out_ = true;
  }

  ZipParts archive_;
  SlicerParts slicer_;
  std::map<std::string, std::unique_ptr<Model>> models_;
  PlacedPolygons placed_;
  Model* root_ = nullptr;
  bool left_out_ = false;  // a support or a modifier
};

}  // namespace

PlacedPolygons read_3mf(const Input& input) { return ThreeMfReader(input.content).read(); }

}  // namespace ist::import
