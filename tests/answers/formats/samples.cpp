#include "answers/formats/samples.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include "support/random.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using answers::PolyData;

PolyData sample_body(const TriangleMesh& mesh, std::uint64_t seed) {
  Random random(seed);
  PolyData data = answers::poly_data(mesh);
  data.normals = answers::vertex_normals(data);
  std::vector<float> distances;
  std::vector<std::int32_t> triangles;
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const bool known = random.below(4) != 0;
    distances.push_back(known ? static_cast<float>(random.uniform(-2, 2)) : std::nanf(""));
    triangles.push_back(static_cast<std::int32_t>(random.below(1u << 31)));
    data.colours.push_back({static_cast<std::uint8_t>(random.below(256)),
                            static_cast<std::uint8_t>(random.below(256)),
                            static_cast<std::uint8_t>(random.below(256))});
  }
  distances[0] = 0x1p-140f;  // below the smallest normal float
  distances[1] = std::numeric_limits<float>::max();
  triangles[0] = std::numeric_limits<std::int32_t>::min();
  triangles[1] = std::numeric_limits<std::int32_t>::max();
  data.colours[0] = {0, 255, 1};
  data.point_arrays = {{"Signed", std::move(distances)}, {"Triangle", std::move(triangles)}};
  std::vector<float> areas;
  for (std::size_t i = 0; i < data.cell_count(); ++i) {
    areas.push_back(static_cast<float>(random.uniform(0, 1)));
  }
  data.cell_arrays = {{"Area", std::move(areas)}};
  return data;
}

}  // namespace

std::vector<answers::NamedPolyData> sample_bodies() {
  const Eigen::Vector3d aside(1e3 / 3, -0.1, 1e-9);
  return {{"upper \"jaw\" \\ \xC3\xA4", sample_body(icosphere(1, 2.3), 1)},
          {"lower", sample_body(moved(box({-1, -2, -3}, {1, 2, 3}), aside), 2)}};
}

PolyData sample_quads() {
  PolyData data;
  for (int corner = 0; corner < 8; ++corner) {
    data.points.emplace_back(corner & 1, corner >> 1 & 1, (corner >> 2) * 0.7);
  }
  data.corners = 4;
  data.polygons = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
  return data;
}

PolyData sample_points() {
  PolyData data;
  data.points = {{0, 0, 0}, {0.1, -0.2, 0.3}, {1e7, 1, -1e-7}, {-5, 6, -7}, {1, 1, 1}};
  data.point_arrays = {
      {"radius", std::vector<float>{0.5f, 0, 1e-30f, 3e30f, 0.1f}},
      {"normal", std::vector<float>{0, 0, 1, 0, 1, 0, 1, 0, 0, 0.6f, 0.8f, 0, 0, 0, -1}, 3},
      {"pair", std::vector<std::int32_t>{1, 2, 3, 4, -5, 6, 7, -8, 9, 10}, 2},
      {"kind", std::vector<std::uint8_t>{0, 1, 2, 128, 255}}};
  data.cell_arrays = {{"weight", std::vector<float>{1, 2, 3, 4, 5}}};
  return data;
}

}  // namespace ist::test
