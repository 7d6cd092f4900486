#include "answers/formats/poly_data.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <type_traits>

#include "ist/base/assert.h"
#include "ist/base/throw_error.h"

namespace ist::answers {
namespace {

template <typename T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

void append(std::vector<DataArray>& all, const std::vector<DataArray>& more) {
  IST_ASSERT(all.size() == more.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    IST_ASSERT(all[i].name == more[i].name && all[i].components == more[i].components);
    std::visit(
        [&](auto& numbers) {
          append(numbers, std::get<std::remove_reference_t<decltype(numbers)>>(more[i].numbers));
        },
        all[i].numbers);
  }
}

bool is_name(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_';
  });
}

bool fit(const std::vector<DataArray>& arrays, std::size_t count) {
  return std::all_of(arrays.begin(), arrays.end(), [count](const DataArray& array) {
    const std::size_t size =
        std::visit([](const auto& numbers) { return numbers.size(); }, array.numbers);
    return is_name(array.name) && array.components > 0 && size == count * array.components;
  });
}

}  // namespace

PolyData poly_data(const TriangleMesh& mesh) {
  PolyData data;
  data.points = mesh.vertices;
  data.polygons.reserve(3 * mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles) {
    data.polygons.insert(data.polygons.end(), triangle.begin(), triangle.end());
  }
  return data;
}

PolyData joined(std::span<const NamedPolyData> bodies) {
  IST_ASSERT(bodies.size() <= 256);
  if (bodies.empty()) return {};
  PolyData all = bodies.front().data;
  for (const auto& [name, data] : bodies.subspan(1)) {
    IST_ASSERT(data.corners == all.corners && data.polygons.empty() == all.polygons.empty());
    const auto first = static_cast<std::uint32_t>(all.points.size());
    append(all.points, data.points);
    for (const std::uint32_t corner : data.polygons) all.polygons.push_back(first + corner);
    append(all.point_arrays, data.point_arrays);
    append(all.cell_arrays, data.cell_arrays);
    append(all.colours, data.colours);
    append(all.normals, data.normals);
  }
  std::vector<std::uint8_t> of_points, of_cells;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto body = static_cast<std::uint8_t>(i);
    of_points.resize(of_points.size() + bodies[i].data.points.size(), body);
    of_cells.resize(of_cells.size() + bodies[i].data.cell_count(), body);
  }
  all.point_arrays.push_back({"Body", std::move(of_points)});
  all.cell_arrays.push_back({"Body", std::move(of_cells)});
  IST_ASSERT(is_consistent(all));
  return all;
}

std::vector<Eigen::Vector3f> vertex_normals(const PolyData& data) {
  std::vector<Eigen::Vector3d> sums(data.points.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < data.polygons.size(); i += data.corners) {
    const auto corner = [&](std::size_t k) { return data.points[data.polygons[i + k]]; };
    // Twice the area; of a quad by its diagonals.
    const Eigen::Vector3d area = data.corners == 3
                                     ? (corner(1) - corner(0)).cross(corner(2) - corner(0))
                                     : (corner(2) - corner(0)).cross(corner(3) - corner(1));
    for (std::size_t k = 0; k < data.corners; ++k) sums[data.polygons[i + k]] += area;
  }
  std::vector<Eigen::Vector3f> normals;
  normals.reserve(sums.size());
  for (const Eigen::Vector3d& sum : sums) {
    const double largest = sum.cwiseAbs().maxCoeff();
    // Scaled first, so that squares stay in range.
    const Eigen::Vector3d scaled = sum / largest;
    const double length = std::sqrt(scaled.squaredNorm());
    normals.push_back(largest > 0 && std::isfinite(length)
                          ? Eigen::Vector3f((scaled / length).cast<float>())
                          : Eigen::Vector3f::UnitZ());
  }
  return normals;
}

std::vector<float> float_points(const PolyData& data, const std::filesystem::path& file) {
  std::vector<float> floats;
  floats.reserve(3 * data.points.size());
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    for (const double coordinate : data.points[i]) {
      floats.push_back(static_cast<float>(coordinate));
      if (!std::isfinite(floats.back())) {
        throw_error(ErrorCode::kMeshNotFinite,
                    "{}: point {} is not finite as a float, which the file would hold; "
                    "scale the mesh",
                    file.string(), i);
      }
    }
  }
  return floats;
}

bool is_consistent(const PolyData& data) {
  const std::size_t points = data.points.size();
  return (data.corners == 3 || data.corners == 4) && data.polygons.size() % data.corners == 0 &&
         std::all_of(data.polygons.begin(), data.polygons.end(),
                     [points](std::uint32_t corner) { return corner < points; }) &&
         fit(data.point_arrays, points) && fit(data.cell_arrays, data.cell_count()) &&
         (data.colours.empty() || data.colours.size() == points) &&
         (data.normals.empty() || data.normals.size() == points);
}

}  // namespace ist::answers
