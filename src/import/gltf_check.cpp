#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "import/format_checks.h"
#include "import/placed_polygons.h"
#include "ist/base/printable.h"

namespace ist::import {
namespace {

using Json = nlohmann::json;

// Notes the place of a JSON text's first error.
struct ErrorPlace : nlohmann::detail::json_sax_acceptor<Json> {
  std::size_t at = 0;
  bool parse_error(std::size_t position, const std::string&, const Json::exception&) {
    at = position;
    return false;
  }
};

[[noreturn]] void refuse_mesh(std::string_view place, std::string_view cause) {
  refuse(ErrorCode::kNotAMesh, place, cause);
}

// Returns the JSON of a GLB: a header of 12 bytes, then chunks, the first one of JSON.
std::string_view json_of_glb(std::string_view content) {
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, content.data() + at, sizeof value);
    return std::size_t{value};
  };
  if (content.size() < 20 || content.size() < word(8) || content.size() - 20 < word(12))
    refuse(ErrorCode::kMeshTruncated, fmt::format("byte {}", content.size()),
           "the file ends within a chunk; copy or export it again");
  if (word(4) != 2)
    refuse_mesh("byte 4", fmt::format("GLB version {} is not supported; export glTF 2.0", word(4)));
  if (content.substr(16, 4) != "JSON")
    refuse_mesh("byte 12", "the first chunk is no JSON; export the mesh again");
  return content.substr(20, word(12));
}

// Replaces the JSON of a GLB. Blanks fill it up to whole words.
void set_json_of_glb(std::string& content, std::string json) {
  json.append((4 - json.size() % 4) % 4, ' ');
  content.replace(20, json_of_glb(content).size(), json);
  const auto set_word = [&](std::size_t at, std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    std::memcpy(content.data() + at, &word, sizeof word);
  };
  set_word(8, content.size());
  set_word(12, json.size());
}

// Extensions that change looks, light or names alone.
bool is_harmless(std::string_view extension) {
  constexpr std::string_view kBegins[] = {"KHR_materials_", "KHR_texture_",   "EXT_texture_",
                                          "MSFT_texture_",  "KHR_lights_",    "EXT_lights_",
                                          "KHR_xmp",        "EXT_materials_", "ADOBE_materials_"};
  return extension == "KHR_techniques_webgl" ||
         std::any_of(std::begin(kBegins), std::end(kBegins),
                     [&](std::string_view begin) { return extension.starts_with(begin); });
}

class GltfCheck {
 public:
  explicit GltfCheck(std::string_view text)
      : root_(Json::parse(text.begin(), text.end(), nullptr, false)) {
    if (!root_.is_discarded()) return;
    ErrorPlace error;
    Json::sax_parse(text.begin(), text.end(), &error);
    refuse(error.at > text.size() ? ErrorCode::kMeshTruncated : ErrorCode::kNotAMesh,
           fmt::format("byte {} of the JSON", error.at),
           "the text is no JSON from here on; copy or export the mesh again");
  }

  // Returns the JSON for assimp if it differs from the text.
  std::optional<std::string> check() {
    check_version();
    for (const Json& extension : elements(root_, "extensionsRequired")) {
      const std::string name = extension.is_string() ? extension.get<std::string>() : "";
      if (!is_harmless(name))
        refuse_mesh("extensionsRequired",
                    fmt::format("{} is not supported; export the mesh without compression or "
                                "extensions",
                                printable(name, 80)));
    }
    if (elements(root_, "scenes").empty())
      refuse(ErrorCode::kMeshEmpty, "", "the glTF has no scene; export the mesh again");
    const std::uint64_t scene = root_.contains("scene") ? index(root_, "scene", "scene") : 0;
    std::vector<std::uint64_t> left;
    push(element("scenes", scene), "nodes", left);
    std::vector<bool> visited(elements(root_, "nodes").size());
    while (!left.empty()) {
      const std::uint64_t node = left.back();
      left.pop_back();
      static_cast<void>(element("nodes", node));  // it exists
      Json& described = root_["nodes"][node];
      const std::string place = fmt::format("node {}", node);
      if (visited[node])
        refuse_mesh(place, "it is the child of several nodes, or of itself; export the mesh again");
      visited[node] = true;
      check_node(described, place);
      push(described, "children", left);
    }
    if (!changed_) return {};
    return root_.dump();
  }

 private:
  static const Json& elements(const Json& object, const char* key) {
    static const Json kNone = Json::array();
    const auto found = object.is_object() ? object.find(key) : object.end();
    return object.is_object() && found != object.end() && found->is_array() ? *found : kNone;
  }

  const Json& element(const char* array, std::uint64_t at) const {
    const Json& all = elements(root_, array);
    if (at >= all.size())
      refuse(ErrorCode::kMeshBadIndex, array,
             fmt::format("element {} is named, but there are {}; export the mesh again", at,
                         all.size()));
    return all[at];
  }

  static std::uint64_t index(const Json& object, const char* key, std::string_view place) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_number_unsigned())
      refuse_mesh(place, fmt::format("'{}' is no whole number; export the mesh again", key));
    return found->get<std::uint64_t>();
  }

  static std::uint64_t index_or(const Json& object, const char* key, std::uint64_t other,
                                std::string_view place) {
    return object.contains(key) ? index(object, key, place) : other;
  }

  static void push(const Json& holder, const char* key, std::vector<std::uint64_t>& left) {
    for (const Json& node : elements(holder, key)) {
      if (!node.is_number_unsigned())
        refuse_mesh(key, "a number of a node is no whole number; export the mesh again");
      left.push_back(node.get<std::uint64_t>());
    }
  }

  void check_version() const {
    const auto text = [&](const char* key) {
      const auto asset = root_.is_object() ? root_.find("asset") : root_.end();
      if (!root_.is_object() || asset == root_.end() || !asset->is_object()) return std::string();
      const auto found = asset->find(key);
      return found != asset->end() && found->is_string() ? found->get<std::string>() : "";
    };
    const std::string version = text("version"), least = text("minVersion");
    if (version.empty())
      refuse_mesh("", "the JSON is no glTF: asset.version is missing; convert the mesh to one");
    if (!version.starts_with("2.") || !(least.empty() || least == "2.0"))
      refuse_mesh("asset", fmt::format("glTF {} is not supported; export glTF 2.0",
                                       printable(least.empty() ? version : least)));
  }

  void check_node(Json& node, const std::string& place) {
    if (!node.is_object()) refuse_mesh(place, "it is no object; export the mesh again");
    if (node.contains("extensions") && node["extensions"].contains("EXT_mesh_gpu_instancing"))
      refuse_mesh(place, "an extension repeats its mesh; export each as a node of its own");
    check_transform(node, place);
    if (!node.contains("mesh")) return;
    if (node.contains("skin"))
      refuse_mesh(place, "a skin bends its mesh; apply it before you export the mesh");
    const std::uint64_t mesh = index(node, "mesh", place);
    const Json& primitives = elements(element("meshes", mesh), "primitives");
    for (std::size_t i = 0; i < primitives.size(); ++i)
      check_primitive(primitives[i], fmt::format("{}, mesh {}, primitive {}", place, mesh, i));
  }

  // assimp passes over an array of another kind, and takes any quaternion for a rotation. Exporters
  // round them, some to four digits.
  void check_transform(Json& node, const std::string& place) {
    constexpr std::pair<const char*, std::size_t> kArrays[] = {
        {"matrix", 16}, {"translation", 3}, {"rotation", 4}, {"scale", 3}};
    for (const auto& [key, size] : kArrays) {
      const Json& numbers = elements(node, key);
      const bool right = numbers.size() == size &&
                         std::all_of(numbers.begin(), numbers.end(),
                                     [](const Json& number) { return number.is_number(); });
      if (node.contains(key) && !right)
        refuse_mesh(place, fmt::format("'{}' is not {} numbers; export the mesh again", key, size));
    }
    if (!node.contains("rotation")) return;
    constexpr double kMostError = 1e-3;
    double square = 0;
    for (const Json& number : node["rotation"])
      square += number.get<double>() * number.get<double>();
    const double length = std::sqrt(square);
    if (!(std::abs(length - 1) <= kMostError))
      refuse_mesh(place, fmt::format("its rotation has the length {:g}, not 1; apply it before you "
                                     "export the mesh",
                                     length));
    changed_ = changed_ || length != 1;
    for (Json& number : node["rotation"]) number = number.get<double>() / length;
  }

  void check_primitive(const Json& primitive, const std::string& place) const {
    constexpr std::uint64_t kFloat = 5126, kTriangles = 4;
    if (primitive.contains("targets"))
      refuse_mesh(place, "morph targets move its vertices; apply them before you export the mesh");
    if (!primitive.contains("attributes") || !primitive["attributes"].contains("POSITION")) return;
    const std::uint64_t points = index(primitive["attributes"], "POSITION", place);
    if (check_accessor(points, "VEC3") != kFloat)
      refuse_mesh(place, "its positions are no floats; export the mesh again");
    std::uint64_t corners = points;
    if (primitive.contains("indices")) {
      corners = index(primitive, "indices", place);
      const std::uint64_t type = check_accessor(corners, "SCALAR");
      if (type != 5121 && type != 5123 && type != 5125)
        refuse_mesh(place, "its indices are no whole numbers; export the mesh again");
    }
    const std::uint64_t count = index(element("accessors", corners), "count", place);
    if (index_or(primitive, "mode", kTriangles, place) == kTriangles && count % 3 != 0)
      refuse_mesh(place,
                  fmt::format("{} corners are no whole triangles; export the mesh again", count));
  }

  // Returns the type of an accessor's numbers.
  std::uint64_t check_accessor(std::uint64_t number, std::string_view type) const {
    const std::string place = fmt::format("accessor {}", number);
    const Json& accessor = element("accessors", number);
    if (accessor.contains("sparse") || !accessor.contains("bufferView"))
      refuse_mesh(place,
                  "it is sparse or without bytes, which is not supported; export the mesh as plain "
                  "arrays");
    const std::uint64_t component = index(accessor, "componentType", place);
    const std::uint64_t bytes = component == 5120 || component == 5121   ? 1
                                : component == 5122 || component == 5123 ? 2
                                : component == 5125 || component == 5126 ? 4
                                                                         : 0;
    if (accessor.value("type", Json()) != type || bytes == 0)
      refuse_mesh(place, "its type is not supported; export the mesh again");
    const Json& view = element("bufferViews", index(accessor, "bufferView", place));
    const std::uint64_t size = type == "VEC3" ? 3 * bytes : bytes,
                        count = index(accessor, "count", place),
                        begin = index_or(accessor, "byteOffset", 0, place),
                        length = index(view, "byteLength", place),
                        stride = index_or(view, "byteStride", size, place);
    constexpr std::uint64_t kLargestStride = 252;
    if (count > length || begin > length || stride < size || stride > kLargestStride ||
        (count > 0 && (count - 1) * stride + size > length - begin))
      refuse(ErrorCode::kMeshBadIndex, place,
             fmt::format("its {} elements are not within the {} bytes of its buffer view; export "
                         "the mesh again",
                         count, length));
    return component;
  }

  Json root_;
  bool changed_ = false;
};

}  // namespace

void check_gltf(std::string& content) {
  const bool binary = content.starts_with("glTF");
  std::optional<std::string> json =
      GltfCheck(binary ? json_of_glb(content) : std::string_view(content)).check();
  if (!json) return;
  if (binary)
    set_json_of_glb(content, *std::move(json));
  else
    content = *std::move(json);
}

}  // namespace ist::import
