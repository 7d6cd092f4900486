#include <gtest/gtest.h>

#include <cmath>

#include "answers/formats/ply_writer.h"
#include "answers/formats/samples.h"
#include "support/mesh_files.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

using answers::PolyData;
using Properties = std::vector<std::pair<std::string, std::string>>;

std::string written(const PolyData& data, const std::string& comment = "c") {
  const TempDir dir;
  answers::write_ply(data, dir.path() / "data.ply", comment);
  return file_content(dir.path() / "data.ply");
}

void expect_points(const PlyFile& file, const PolyData& data) {
  ASSERT_EQ(file.vertices.size(), data.points.size());
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    EXPECT_EQ(file.vertices[i].at("x"), static_cast<float>(data.points[i].x()));
    EXPECT_EQ(file.vertices[i].at("y"), static_cast<float>(data.points[i].y()));
    EXPECT_EQ(file.vertices[i].at("z"), static_cast<float>(data.points[i].z()));
  }
}

void expect_polygons(const PlyFile& file, const PolyData& data) {
  std::vector<std::uint32_t> corners;
  for (const auto& face : file.faces) {
    EXPECT_EQ(face.size(), data.corners);
    corners.insert(corners.end(), face.begin(), face.end());
  }
  EXPECT_EQ(corners, data.polygons);
}

TEST(Ply, HoldsTwoJawsAsTheirVertexElementSays) {
  std::vector<answers::NamedPolyData> bodies = sample_bodies();
  for (auto& [name, data] : bodies) {
    data.normals.clear();
    data.point_arrays.pop_back();  // "Triangle"
  }
  const PolyData data = answers::joined(bodies);
  const std::string content = written(data, "two jaws\nend_header\r");
  EXPECT_TRUE(
      content.starts_with("ply\nformat binary_little_endian 1.0\n"
                          "comment two jaws end_header \n"
                          "element vertex 50\n"
                          "property float x\nproperty float y\nproperty float z\n"
                          "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                          "property float signed\nproperty uchar body\n"
                          "element face 92\nproperty list uchar int vertex_indices\n"
                          "end_header\n"));
  const PlyFile file = parse_ply(content);
  expect_points(file, data);
  expect_polygons(file, data);
  const auto& distances = std::get<std::vector<float>>(data.point_arrays[0].numbers);
  const auto& body = std::get<std::vector<std::uint8_t>>(data.point_arrays[1].numbers);
  std::size_t unknown = 0;
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const auto& vertex = file.vertices[i];
    EXPECT_EQ(vertex.at("red"), data.colours[i][0]);
    EXPECT_EQ(vertex.at("green"), data.colours[i][1]);
    EXPECT_EQ(vertex.at("blue"), data.colours[i][2]);
    EXPECT_EQ(vertex.at("body"), body[i]);
    if (std::isnan(distances[i])) {
      ++unknown;
      EXPECT_TRUE(std::isnan(vertex.at("signed")));
    } else {
      EXPECT_EQ(vertex.at("signed"), distances[i]);
    }
  }
  EXPECT_GT(unknown, 0u);
}

TEST(Ply, NormalsAndComponentsHaveNames) {
  const PolyData body = sample_bodies()[0].data;
  const PlyFile bodies = parse_ply(written(body));
  for (std::size_t i = 0; i < body.points.size(); ++i) {
    EXPECT_EQ(bodies.vertices[i].at("nx"), body.normals[i].x());
    EXPECT_EQ(bodies.vertices[i].at("ny"), body.normals[i].y());
    EXPECT_EQ(bodies.vertices[i].at("nz"), body.normals[i].z());
    EXPECT_EQ(bodies.vertices[i].at("triangle"),
              std::get<std::vector<std::int32_t>>(body.point_arrays[1].numbers)[i]);
  }
  const PolyData data = sample_points();
  const PlyFile points = parse_ply(written(data));
  expect_points(points, data);
  EXPECT_TRUE(points.faces.empty());
  EXPECT_EQ(points.properties, (Properties{{"float", "x"},
                                           {"float", "y"},
                                           {"float", "z"},
                                           {"float", "radius"},
                                           {"float", "normal_x"},
                                           {"float", "normal_y"},
                                           {"float", "normal_z"},
                                           {"int", "pair_0"},
                                           {"int", "pair_1"},
                                           {"uchar", "kind"}}));
  EXPECT_EQ(points.vertices[3].at("radius"), 3e30f);
  EXPECT_EQ(points.vertices[3].at("normal_x"), 0.6f);
  EXPECT_EQ(points.vertices[3].at("normal_y"), 0.8f);
  EXPECT_EQ(points.vertices[4].at("normal_z"), -1);
  EXPECT_EQ(points.vertices[3].at("pair_0"), 7);
  EXPECT_EQ(points.vertices[3].at("pair_1"), -8);
  EXPECT_EQ(points.vertices[3].at("kind"), 128);
}

TEST(Ply, QuadsAndNothing) {
  const PolyData quads = sample_quads();
  const PlyFile file = parse_ply(written(quads));
  expect_points(file, quads);
  expect_polygons(file, quads);
  EXPECT_TRUE(parse_ply(written({})).vertices.empty());
}

}  // namespace
}  // namespace ist::test
