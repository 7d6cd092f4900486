#include "ist/mesh/format/gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>

#include "ist/base/printable.h"
#include "ist/mesh/format/base64.h"
#include "ist/mesh/format/text_reader.h"

namespace ist {
namespace {

using Json = nlohmann::json;

// Finds the byte at which a text stops being JSON.
struct ErrorPlace : nlohmann::detail::json_sax_acceptor<Json> {
  std::size_t at = 0;
  bool parse_error(std::size_t position, const std::string&, const Json::exception&) {
    at = position;
    return false;
  }
};

std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, sizeof word);
  return word;
}

std::size_t bytes_of_component(std::uint64_t component) {
  switch (component) {
    case 5120:  // signed and unsigned bytes, shorts
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:  // unsigned int, float
    case 5126:
      return 4;
    default:
      return 0;
  }
}

std::size_t components_of_type(std::string_view type) {
  return type == "SCALAR" ? 1 : type == "VEC3" ? 3 : 0;
}

// Returns a value as a message quotes it. The text of a deep one would take as deep a stack.
std::string shown(const Json& value, std::size_t most) {
  const bool is_nested = std::any_of(value.begin(), value.end(),
                                     [](const Json& element) { return element.is_structured(); });
  return is_nested ? fmt::format("a nested {}", value.type_name()) : printable(value.dump(), most);
}

}  // namespace

GltfFile::GltfFile(std::string_view content, std::string_view file) : file_(file) {
  is_binary_ = content.starts_with("glTF");
  const std::string_view text = is_binary_ ? json_of_glb(content) : content;
  root_ = std::make_unique<Json>(Json::parse(text.begin(), text.end(), nullptr, false));
  if (root_->is_discarded()) {
    ErrorPlace place;
    Json::sax_parse(text.begin(), text.end(), &place);
    const bool cut = !is_binary_ && place.at > text.size();
    fail(cut ? ErrorCode::kMeshTruncated : ErrorCode::kNotAMesh,
         fmt::format("byte {} of the JSON", place.at),
         cut ? "the file ends here; copy or export it again"
             : "the text is no JSON; export the mesh again");
  }
  const Json* asset = find(*root_, "asset");
  const Json* version = asset == nullptr ? nullptr : find(*asset, "version");
  if (version == nullptr || !version->is_string())
    fail(ErrorCode::kNotAMesh, "",
         "the JSON is no glTF: asset.version is missing; convert the mesh to one");
  if (!version->get_ref<const std::string&>().starts_with("2."))
    fail(ErrorCode::kNotAMesh, "asset",
         fmt::format("glTF {} is not supported; export glTF 2.0",
                     printable(version->get_ref<const std::string&>())));
  if (const Json* required = find(*root_, "extensionsRequired");
      required != nullptr && !required->empty())
    fail(ErrorCode::kNotAMesh, "extensionsRequired",
         fmt::format("{} is not supported; export the mesh without compression or extensions",
                     shown(*required, 80)));
}

GltfFile::~GltfFile() = default;

// Returns the JSON of a GLB: a header of 12 bytes, and chunks, each with its length and its type.
std::string_view GltfFile::json_of_glb(std::string_view content) {
  constexpr std::uint32_t kJson = 0x4E4F534A, kBinary = 0x004E4942;
  const auto truncated = [&] {
    fail(ErrorCode::kMeshTruncated, fmt::format("byte {}", content.size()),
         "the file ends within a chunk; copy or export it again");
  };
  if (content.size() < 20) truncated();
  if (word_at(content, 4) != 2)
    fail(ErrorCode::kNotAMesh, "byte 4",
         fmt::format("GLB version {} is not supported; export glTF 2.0", word_at(content, 4)));
  if (content.size() < word_at(content, 8)) truncated();
  content = content.substr(0, word_at(content, 8));
  std::string_view json;
  for (std::size_t at = 12, chunk = 0; at + 8 <= content.size(); ++chunk) {
    const std::size_t length = word_at(content, at);
    const std::uint32_t type = word_at(content, at + 4);
    if (content.size() - at - 8 < length) truncated();
    const std::string_view bytes = content.substr(at + 8, length);
    if (chunk == 0 && type == kJson) json = bytes;
    if (chunk == 1 && type == kBinary) chunk_ = bytes;
    at += 8 + length;
  }
  if (json.empty())
    fail(ErrorCode::kNotAMesh, "byte 12", "the first chunk is no JSON; export the mesh again");
  return json;
}

const Json* GltfFile::find(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

const Json& GltfFile::element(const char* array, std::uint64_t index) const {
  const Json* all = find(*root_, array);
  const std::size_t count = all == nullptr || !all->is_array() ? 0 : all->size();
  if (index >= count)
    fail(ErrorCode::kMeshBadIndex, array,
         fmt::format("element {} is named, but there are {}; export the mesh again", index, count));
  return (*all)[index];
}

std::uint64_t GltfFile::whole(const Json& value, std::string_view place) const {
  if (!value.is_number_unsigned())
    fail(ErrorCode::kNotAMesh, place,
         fmt::format("{} is no whole number; export the mesh again", shown(value, 40)));
  return value.get<std::uint64_t>();
}

std::uint64_t GltfFile::index(const Json& object, const char* key, std::string_view place) const {
  const Json* value = find(object, key);
  if (value == nullptr)
    fail(ErrorCode::kNotAMesh, place, fmt::format("'{}' is missing; export the mesh again", key));
  return whole(*value, place);
}

std::uint64_t GltfFile::index_or(const Json& object, const char* key, std::uint64_t other,
                                 std::string_view place) const {
  return find(object, key) == nullptr ? other : index(object, key, place);
}

std::vector<double> GltfFile::numbers(const Json& object, const char* key,
                                      std::vector<double> other, std::string_view place) const {
  const Json* value = find(object, key);
  if (value == nullptr) return other;
  bool right = value->is_array() && value->size() == other.size();
  for (std::size_t i = 0; right && i < other.size(); ++i) {
    right = (*value)[i].is_number();
    if (right) other[i] = (*value)[i].get<double>();
  }
  if (!right)
    fail(ErrorCode::kNotAMesh, place,
         fmt::format("'{}' is not {} numbers; export the mesh again", key, other.size()));
  return other;
}

std::string_view GltfFile::buffer(std::uint64_t number) {
  const std::string place = fmt::format("buffer {}", number);
  const Json& described = element("buffers", number);
  const std::uint64_t length = index(described, "byteLength", place);
  std::string_view bytes = chunk_;
  if (const Json* uri = find(described, "uri"); uri != nullptr && uri->is_string()) {
    const std::string_view text = uri->get_ref<const std::string&>();
    constexpr std::string_view kBase64 = ";base64,";
    const std::size_t comma = text.find(kBase64);
    if (text.starts_with("data:") && comma == text.npos)
      fail(ErrorCode::kNotAMesh, place,
           "its bytes are in a data URI without base64, which is not supported; export a .glb");
    if (!text.starts_with("data:"))
      fail(ErrorCode::kNotAMesh, place,
           fmt::format("its bytes are in another file, '{}', and only the one that is named is "
                       "read; export a .glb, which holds all",
                       printable(text, 80)));
    if (decoded_.size() <= number) decoded_.resize(number + 1);
    if (decoded_[number] == nullptr) {
      auto decoded = decode_base64(text.substr(comma + kBase64.size()));
      if (!decoded)
        fail(ErrorCode::kNotAMesh, place, "its bytes are no base64; export the mesh again");
      decoded_[number] = std::make_unique<std::string>(std::move(*decoded));
    }
    bytes = *decoded_[number];
  } else if (!is_binary_ || number != 0) {
    fail(ErrorCode::kNotAMesh, place, "'uri' is missing; export the mesh again");
  }
  if (bytes.size() < length)
    fail(ErrorCode::kMeshTruncated, place,
         fmt::format("it holds {} of the {} bytes that it declares; copy or export it again",
                     bytes.size(), length));
  return bytes.substr(0, length);
}

GltfAccessor GltfFile::accessor(std::uint64_t number) {
  const std::string place = fmt::format("accessor {}", number);
  const Json& described = element("accessors", number);
  if (find(described, "sparse") != nullptr || find(described, "bufferView") == nullptr)
    fail(ErrorCode::kNotAMesh, place,
         "it is sparse or without bytes, which is not supported; export the mesh as plain arrays");
  GltfAccessor result;
  result.component = index(described, "componentType", place);
  if (const Json* type = find(described, "type"); type != nullptr && type->is_string())
    result.type = type->get_ref<const std::string&>();
  const std::size_t size = components_of_type(result.type) * bytes_of_component(result.component);
  if (size == 0)
    fail(ErrorCode::kNotAMesh, place, "its type is not supported; export the mesh again");
  result.count = index(described, "count", place);

  const std::uint64_t view_number = index(described, "bufferView", place);
  const Json& view = element("bufferViews", view_number);
  const std::string_view bytes = buffer(index(view, "buffer", place));
  const std::uint64_t offset = index_or(view, "byteOffset", 0, place);
  const std::uint64_t length = index(view, "byteLength", place);
  const std::uint64_t begin = index_or(described, "byteOffset", 0, place);
  result.stride = index_or(view, "byteStride", size, place);
  constexpr std::uint64_t kLargestStride = 252;
  const bool within =
      offset <= bytes.size() && length <= bytes.size() - offset && begin <= length &&
      result.stride >= size && result.stride <= kLargestStride && result.count <= bytes.size() &&
      (result.count == 0 || (result.count - 1) * result.stride + size <= length - begin);
  if (!within)
    fail(ErrorCode::kMeshBadIndex, place,
         fmt::format("its {} elements are not within the {} bytes of buffer view {}; export the "
                     "mesh again",
                     result.count, length, view_number));
  result.first = bytes.data() + offset + begin;
  return result;
}

void GltfFile::fail(ErrorCode code, std::string_view place, std::string_view cause) const {
  fail_mesh(code, file_, place, cause);
}

}  // namespace ist
