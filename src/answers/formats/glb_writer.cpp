#include "answers/formats/glb_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "answers/formats/little_endian.h"
#include "ist/base/assert.h"
#include "ist/base/throw_error.h"

namespace ist::answers {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of the format.
constexpr int kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;
constexpr int kVertexBuffer = 34962, kIndexBuffer = 34963;
constexpr int kPoints = 0, kTriangles = 4;
constexpr std::size_t kMagic = 0x46546C67, kVersion = 2;
constexpr std::size_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

std::vector<std::uint32_t> triangles_of(const PolyData& data) {
  if (data.corners == 3) return data.polygons;
  std::vector<std::uint32_t> triangles;
  triangles.reserve(data.polygons.size() / 4 * 6);
  for (std::size_t i = 0; i < data.polygons.size(); i += 4) {
    for (const std::size_t k : {0u, 1u, 2u, 0u, 2u, 3u}) triangles.push_back(data.polygons[i + k]);
  }
  return triangles;
}

// The linear share of light of each sRGB byte (IEC 61966-2-1), 65535 for all of it. In 16 bits no
// two bytes have the same share.
std::array<std::uint16_t, 256> linear_shares() {
  std::array<std::uint16_t, 256> shares{};
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double c = static_cast<double>(i) / 255;
    const double share = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    shares[i] = static_cast<std::uint16_t>(std::lround(65535 * share));
  }
  return shares;
}

std::vector<std::array<std::uint16_t, 4>> opaque(const std::vector<Colour>& colours) {
  static const std::array<std::uint16_t, 256> kShares = linear_shares();
  std::vector<std::array<std::uint16_t, 4>> all;
  all.reserve(colours.size());
  for (const Colour& c : colours)
    all.push_back({kShares[c[0]], kShares[c[1]], kShares[c[2]], 65535});
  return all;
}

// The smallest and the largest of each coordinate.
void add_bounds(Json& accessor, std::span<const float> coordinates) {
  std::array<float, 3> least{coordinates[0], coordinates[1], coordinates[2]}, most = least;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    least[i % 3] = std::min(least[i % 3], coordinates[i]);
    most[i % 3] = std::max(most[i % 3], coordinates[i]);
  }
  accessor["min"] = least;
  accessor["max"] = most;
}

class Scene {
 public:
  Scene(double metres_per_unit, const std::filesystem::path& file) : file_(file) {
    const double s = metres_per_unit;
    // Column by column: x stays, y becomes -z, z becomes y.
    nodes_.push_back(
        {{"name", "ist"}, {"matrix", {s, 0, 0, 0, 0, 0, -s, 0, 0, s, 0, 0, 0, 0, 0, 1}}});
  }

  void add(const NamedPolyData& body) {
    if (texts_.empty()) texts_ = body.data.texts;
    Json node{{"name", body.name}};
    if (!body.data.points.empty()) {
      node["mesh"] = meshes_.size();
      meshes_.push_back({{"name", body.name}, {"primitives", Json::array({primitive(body.data)})}});
    }
    nodes_[0]["children"].push_back(nodes_.size());
    nodes_.push_back(std::move(node));
  }

  void write(OutputFile& output) const {
    const std::string text = padded_json();
    const std::size_t binary_chunk = binary_.empty() ? 0 : kChunkHeaderBytes + binary_.size();
    const std::size_t bytes = kHeaderBytes + kChunkHeaderBytes + text.size() + binary_chunk;
    if (bytes > std::numeric_limits<std::uint32_t>::max()) {
      throw_error(ErrorCode::kFileUnwritable, "{}: a GLB holds at most 4 GiB; write a .vtp",
                  file_.string());
    }
    const auto write_words = [&output](std::initializer_list<std::size_t> words) {
      for (const std::size_t word : words) {
        const auto narrowed = static_cast<std::uint32_t>(word);
        output.write(&narrowed, sizeof narrowed);
      }
    };
    write_words({kMagic, kVersion, bytes, text.size(), kJsonChunk});
    output.write(text.data(), text.size());
    if (!binary_.empty()) {
      write_words({binary_.size(), kBinaryChunk});
      output.write(binary_.data(), binary_.size());
    }
  }

 private:
  Json primitive(const PolyData& data) {
    IST_ASSERT(is_consistent(data));
    const std::vector<float> points = float_points(data, file_);
    const std::size_t count = data.points.size();
    Json attributes;
    attributes["POSITION"] =
        accessor(std::as_bytes(std::span(points)), kVertexBuffer, kFloat, "VEC3", count);
    add_bounds(accessors_.back(), points);
    if (!data.normals.empty()) {
      attributes["NORMAL"] =
          accessor(std::as_bytes(std::span(data.normals)), kVertexBuffer, kFloat, "VEC3", count);
    }
    if (!data.colours.empty()) {
      const auto colours = opaque(data.colours);
      attributes["COLOR_0"] =
          accessor(std::as_bytes(std::span(colours)), kVertexBuffer, kUnsignedShort, "VEC4", count);
      accessors_.back()["normalized"] = true;
    }
    Json primitive{{"attributes", std::move(attributes)}, {"material", 0}, {"mode", kPoints}};
    if (!data.polygons.empty()) {
      const std::vector<std::uint32_t> corners = triangles_of(data);
      primitive["mode"] = kTriangles;
      primitive["indices"] = accessor(std::as_bytes(std::span(corners)), kIndexBuffer, kUnsignedInt,
                                      "SCALAR", corners.size());
    }
    return primitive;
  }

  // Appends a buffer view, and returns the index of an accessor to all of it. Every element has 4,
  // 8 or 12 bytes, so each view begins at a multiple of 4.
  std::size_t accessor(std::span<const std::byte> bytes, int target, int kind, const char* type,
                       std::size_t count) {
    IST_ASSERT(binary_.size() % 4 == 0 && bytes.size() % 4 == 0);
    accessors_.push_back(
        {{"bufferView", views_.size()}, {"componentType", kind}, {"count", count}, {"type", type}});
    views_.push_back({{"buffer", 0},
                      {"byteOffset", binary_.size()},
                      {"byteLength", bytes.size()},
                      {"target", target}});
    binary_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return accessors_.size() - 1;
  }

  [[nodiscard]] std::string padded_json() const {
    Json json{{"asset", {{"version", "2.0"}, {"generator", "ist"}}},
              {"scene", 0},
              {"scenes", Json::array({{{"nodes", {0}}}})},
              {"nodes", nodes_}};
    for (const auto& [name, text] : texts_) json["asset"]["extras"][name] = text;
    if (!meshes_.empty()) {
      json["meshes"] = meshes_;
      // Scans are open, and no metal.
      json["materials"] = Json::array(
          {{{"doubleSided", true},
            {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.8}}}}});
      json["accessors"] = accessors_;
      json["bufferViews"] = views_;
      json["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
    }
    // A name need not be UTF-8, and JSON must.
    std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    return text;
  }

  std::filesystem::path file_;
  std::vector<NamedText> texts_;
  Json nodes_ = Json::array(), meshes_ = Json::array();
  Json accessors_ = Json::array(), views_ = Json::array();
  std::string binary_;
};

}  // namespace

void write_glb(std::span<const NamedPolyData> bodies, double metres_per_unit,
               const std::filesystem::path& file) {
  OutputFile output(file);
  write_glb(bodies, metres_per_unit, output);
  output.commit();
}

void write_glb(std::span<const NamedPolyData> bodies, double metres_per_unit, OutputFile& file) {
  IST_ASSERT(metres_per_unit > 0);
  Scene scene(metres_per_unit, file.target());
  for (const NamedPolyData& body : bodies) scene.add(body);
  scene.write(file);
}

}  // namespace ist::answers
