#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "answers/formats/glb_writer.h"
#include "answers/formats/samples.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

using answers::NamedPolyData;
using answers::PolyData;
using nlohmann::json;

// A file's two chunks; checks the lengths that its headers say.
class GlbFile {
 public:
  explicit GlbFile(const std::vector<NamedPolyData>& bodies, double metres_per_unit = 0.001) {
    const TempDir dir;
    answers::write_glb(bodies, metres_per_unit, dir.path() / "data.glb");
    const std::string content = file_content(dir.path() / "data.glb");
    const auto word = [&content](std::size_t at) {
      std::uint32_t number = 0;
      std::memcpy(&number, content.data() + at, sizeof number);
      return number;
    };
    EXPECT_EQ(content.substr(0, 4), "glTF");
    EXPECT_EQ(word(4), 2u);
    EXPECT_EQ(word(8), content.size());
    const std::size_t end = 20 + word(12);
    EXPECT_EQ(end % 4, 0u);
    EXPECT_EQ(content.substr(16, 4), "JSON");
    root = json::parse(content.substr(20, end - 20));
    if (end == content.size()) return;
    EXPECT_EQ(word(end), content.size() - end - 8);
    EXPECT_EQ(word(end) % 4, 0u);
    EXPECT_EQ(content.substr(end + 4, 4), std::string("BIN\0", 4));
    binary = content.substr(end + 8);
    EXPECT_EQ(root["buffers"], json::array({{{"byteLength", binary.size()}}}));
  }

  [[nodiscard]] const json& accessor(const json& index) const {
    return root["accessors"][index.get<std::size_t>()];
  }
  // The numbers behind an accessor that is of this kind; checks its buffer view.
  template <typename T>
  [[nodiscard]] std::vector<T> numbers(const json& index, int component, const std::string& type,
                                       std::size_t components, int target) const {
    const json& from = accessor(index);
    EXPECT_EQ(from["componentType"], component);
    EXPECT_EQ(from["type"], type);
    const json& view = root["bufferViews"][from["bufferView"].get<std::size_t>()];
    const auto offset = view["byteOffset"].get<std::size_t>();
    EXPECT_EQ(offset % 4, 0u);
    EXPECT_EQ(view["target"], target);
    EXPECT_EQ(view["buffer"], 0);
    std::vector<T> numbers(from["count"].get<std::size_t>() * components);
    EXPECT_EQ(view["byteLength"], sizeof(T) * numbers.size());
    EXPECT_LE(offset + sizeof(T) * numbers.size(), binary.size());
    std::memcpy(numbers.data(), binary.data() + offset, sizeof(T) * numbers.size());
    return numbers;
  }

  json root;
  std::string binary;
};

// The sRGB byte that a viewer shows for a linear share of light (IEC 61966-2-1).
long shown(std::uint16_t share) {
  const double light = share / 65535.0;
  return std::lround(
      255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055));
}

TEST(Glb, HoldsANamedNodeAndAMeshForEachBody) {
  const auto bodies = sample_bodies();
  const GlbFile file(bodies);
  EXPECT_EQ(file.root["asset"], (json{{"version", "2.0"}, {"generator", "ist"}}));
  EXPECT_EQ(file.root["scene"], 0);
  EXPECT_EQ(file.root["scenes"], json::array({{{"nodes", {0}}}}));
  ASSERT_EQ(file.root["nodes"].size(), 3u);
  EXPECT_EQ(file.root["nodes"][0]["children"], json::array({1, 2}));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(file.root["nodes"][i + 1], (json{{"name", bodies[i].name}, {"mesh", i}}));
    const json& mesh = file.root["meshes"][i];
    EXPECT_EQ(mesh["name"], bodies[i].name);
    ASSERT_EQ(mesh["primitives"].size(), 1u);
    const json& primitive = mesh["primitives"][0];
    EXPECT_EQ(primitive["mode"], 4);
    const PolyData& data = bodies[i].data;

    std::vector<float> points, normals;
    std::array<float, 3> least{}, most{};
    for (std::size_t k = 0; k < data.points.size(); ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto x = static_cast<float>(data.points[k][static_cast<Eigen::Index>(axis)]);
        points.push_back(x);
        normals.push_back(data.normals[k][static_cast<Eigen::Index>(axis)]);
        least[axis] = k == 0 ? x : std::min(least[axis], x);
        most[axis] = k == 0 ? x : std::max(most[axis], x);
      }
    }
    const json& attributes = primitive["attributes"];
    EXPECT_EQ(attributes.size(), 3u);
    EXPECT_EQ(file.numbers<float>(attributes["POSITION"], 5126, "VEC3", 3, 34962), points);
    EXPECT_EQ((file.accessor(attributes["POSITION"])["min"].get<std::array<float, 3>>()), least);
    EXPECT_EQ((file.accessor(attributes["POSITION"])["max"].get<std::array<float, 3>>()), most);
    EXPECT_EQ(file.numbers<float>(attributes["NORMAL"], 5126, "VEC3", 3, 34962), normals);
    const auto colours = file.numbers<std::uint16_t>(attributes["COLOR_0"], 5123, "VEC4", 4, 34962);
    EXPECT_EQ(file.accessor(attributes["COLOR_0"])["normalized"], true);
    ASSERT_EQ(colours.size(), 4 * data.colours.size());
    for (std::size_t k = 0; k < colours.size(); ++k) {
      EXPECT_EQ(shown(colours[k]), k % 4 == 3 ? 255 : data.colours[k / 4][k % 4]);
    }
    EXPECT_EQ(file.numbers<std::uint32_t>(primitive["indices"], 5125, "SCALAR", 1, 34963),
              data.polygons);
  }
}

TEST(Glb, TheRootTurnsAndScales) {
  const GlbFile file({{"a", sample_quads()}}, 0.5);
  const auto m = file.root["nodes"][0]["matrix"].get<std::array<double, 16>>();
  const auto moved = [&m](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(Eigen::Matrix4d(m.data()).topRows<3>() * p.homogeneous());
  };
  EXPECT_EQ(moved({1, 0, 0}), Eigen::Vector3d(0.5, 0, 0));
  EXPECT_EQ(moved({0, 0, 1}), Eigen::Vector3d(0, 0.5, 0)) << "up is y";
  EXPECT_EQ(moved({0, 1, 0}), Eigen::Vector3d(0, 0, -0.5)) << "away is -z";
}

TEST(Glb, QuadsBecomeTrianglesThatTurnAlike) {
  const GlbFile file({{"cube", sample_quads()}});
  const json& primitive = file.root["meshes"][0]["primitives"][0];
  EXPECT_EQ(primitive["attributes"].size(), 1u) << "viewers draw flat faces without normals";
  const auto corners = file.numbers<std::uint32_t>(primitive["indices"], 5125, "SCALAR", 1, 34963);
  const auto quads = sample_quads().polygons;
  ASSERT_EQ(corners.size(), 36u);
  for (std::size_t i = 0; i < 6; ++i) {
    const auto* q = &quads[4 * i];
    const std::vector<std::uint32_t> two{q[0], q[1], q[2], q[0], q[2], q[3]};
    EXPECT_TRUE(std::equal(two.begin(), two.end(), corners.begin() + static_cast<long>(6 * i)));
  }
}

TEST(Glb, PointsAreDrawnAsPointsAndNothingIsANode) {
  const GlbFile file({{"points", sample_points()}, {"nothing", {}}, {"\xFF", sample_quads()}});
  const json& primitive = file.root["meshes"][0]["primitives"][0];
  EXPECT_EQ(primitive["mode"], 0);
  EXPECT_FALSE(primitive.contains("indices"));
  EXPECT_EQ(file.root["nodes"][2], (json{{"name", "nothing"}}));
  EXPECT_EQ(file.root["nodes"][3], (json{{"name", "\xEF\xBF\xBD"}, {"mesh", 1}}))
      << "what is no UTF-8 is replaced";
  const GlbFile empty(std::vector<NamedPolyData>{{"nothing", {}}});
  EXPECT_EQ(empty.binary, "");
  EXPECT_FALSE(empty.root.contains("buffers"));
  EXPECT_FALSE(empty.root.contains("meshes"));
}

}  // namespace
}  // namespace ist::test
