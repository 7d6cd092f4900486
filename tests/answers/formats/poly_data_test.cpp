#include "answers/formats/poly_data.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "answers/formats/glb_writer.h"
#include "answers/formats/ply_writer.h"
#include "answers/formats/samples.h"
#include "answers/formats/vtp_writer.h"
#include "support/errors.h"
#include "support/shapes.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

using answers::DataArray;
using answers::NamedPolyData;
using answers::PolyData;

template <typename T>
const std::vector<T>& numbers(const std::vector<DataArray>& arrays, std::size_t i) {
  return std::get<std::vector<T>>(arrays.at(i).numbers);
}

TEST(PolyData, JoinedBodiesKeepTheirNumbersAndTellTheirPlace) {
  const std::vector<NamedPolyData> bodies = sample_bodies();
  const PolyData& a = bodies[0].data;
  const PolyData& b = bodies[1].data;
  const PolyData all = answers::joined(bodies);
  ASSERT_TRUE(answers::is_consistent(all));
  ASSERT_EQ(all.points.size(), a.points.size() + b.points.size());
  ASSERT_EQ(all.cell_count(), a.cell_count() + b.cell_count());
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    const PolyData& of = i < a.points.size() ? a : b;
    const std::size_t k = i < a.points.size() ? i : i - a.points.size();
    EXPECT_EQ(all.points[i], of.points[k]);
    EXPECT_EQ(all.colours[i], of.colours[k]);
    EXPECT_EQ(all.normals[i], of.normals[k]);
    EXPECT_EQ(numbers<std::int32_t>(all.point_arrays, 1)[i],
              numbers<std::int32_t>(of.point_arrays, 1)[k]);
    EXPECT_EQ(numbers<std::uint8_t>(all.point_arrays, 2)[i], &of == &a ? 0 : 1);
  }
  for (std::size_t i = 0; i < all.polygons.size(); ++i) {
    EXPECT_EQ(all.polygons[i], i < a.polygons.size()
                                   ? a.polygons[i]
                                   : b.polygons[i - a.polygons.size()] + a.points.size());
  }
  for (std::size_t i = 0; i < all.cell_count(); ++i) {
    const PolyData& of = i < a.cell_count() ? a : b;
    const std::size_t k = i < a.cell_count() ? i : i - a.cell_count();
    EXPECT_EQ(numbers<float>(all.cell_arrays, 0)[i], numbers<float>(of.cell_arrays, 0)[k]);
    EXPECT_EQ(numbers<std::uint8_t>(all.cell_arrays, 1)[i], &of == &a ? 0 : 1);
  }
  EXPECT_EQ(all.point_arrays[2].name, "Body");
  EXPECT_EQ(all.cell_arrays[1].name, "Body");
}

TEST(PolyData, JoinedPointsAreCells) {
  const std::vector<NamedPolyData> bodies{{"a", sample_points()}, {"b", sample_points()}};
  const PolyData all = answers::joined(bodies);
  EXPECT_TRUE(answers::is_consistent(all));
  EXPECT_EQ(numbers<std::uint8_t>(all.cell_arrays, 1),
            (std::vector<std::uint8_t>{0, 0, 0, 0, 0, 1, 1, 1, 1, 1}));
  EXPECT_TRUE(answers::joined({}).points.empty());
}

TEST(PolyData, NormalsOfASphereAreItsDirections) {
  for (const double radius : {1e-12, 2.0, 1e15}) {
    const PolyData data = answers::poly_data(icosphere(3, radius));
    const auto normals = answers::vertex_normals(data);
    ASSERT_EQ(normals.size(), data.points.size());
    for (std::size_t i = 0; i < normals.size(); ++i) {
      EXPECT_NEAR(normals[i].norm(), 1, 1e-6);
      EXPECT_GT(normals[i].cast<double>().dot(data.points[i] / radius), 0.9999);
    }
  }
}

TEST(PolyData, NormalsOfQuadsAreWeightedByArea) {
  // Two squares at a right angle; the second one is three times as wide.
  PolyData data;
  data.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 3}, {0, 1, 3}, {9, 9, 9}};
  data.corners = 4;
  data.polygons = {0, 1, 2, 3, 0, 3, 5, 4};
  const auto normals = answers::vertex_normals(data);
  EXPECT_TRUE(normals[1].isApprox(Eigen::Vector3f::UnitZ()));
  EXPECT_TRUE(normals[4].isApprox(Eigen::Vector3f::UnitX()));
  EXPECT_TRUE(normals[0].isApprox(Eigen::Vector3f(3, 0, 1).normalized()));
  EXPECT_EQ(normals[6], Eigen::Vector3f::UnitZ()) << "of no polygon";
}

TEST(PolyData, InconsistencyIsSeen) {
  const PolyData good = sample_bodies()[1].data;
  EXPECT_TRUE(answers::is_consistent(good));
  EXPECT_TRUE(answers::is_consistent({}));
  const auto spoilt = [&good](auto spoil) {
    PolyData data = good;
    spoil(data);
    return answers::is_consistent(data);
  };
  EXPECT_FALSE(spoilt([](PolyData& d) { d.polygons[0] = 8; }));
  EXPECT_FALSE(spoilt([](PolyData& d) { d.polygons.pop_back(); }));
  EXPECT_FALSE(spoilt([](PolyData& d) { d.corners = 5; }));
  EXPECT_FALSE(spoilt([](PolyData& d) { d.colours.pop_back(); }));
  EXPECT_FALSE(spoilt([](PolyData& d) { d.normals.pop_back(); }));
  EXPECT_FALSE(spoilt([](PolyData& d) { d.point_arrays[0].components = 2; }));
  EXPECT_FALSE(spoilt([](PolyData& d) { d.point_arrays[0].name = "a b"; }));
  EXPECT_FALSE(spoilt([](PolyData& d) { d.cell_arrays[0].numbers = std::vector<float>(11); }));
}

TEST(PolyData, APointBeyondFloatIsAnErrorAndNoFile) {
  const TempDir dir;
  PolyData data = sample_quads();
  for (const double bad : {1e39, std::numeric_limits<double>::infinity(), std::nan("")}) {
    data.points[3] = {0, bad, 0};
    const std::vector<NamedPolyData> bodies{{"a", data}};
    const auto file = dir.path() / "file";
    const auto vtp = error_of([&] { answers::write_vtp(data, file); });
    const auto ply = error_of([&] { answers::write_ply(data, file, "bad"); });
    const auto glb = error_of([&] { answers::write_glb(bodies, 1, file); });
    for (const auto& error : {vtp, ply, glb}) {
      ASSERT_TRUE(error);
      EXPECT_EQ(error->code(), ErrorCode::kMeshNotFinite);
      EXPECT_EQ(error->what(), file.string() +
                                   ": point 3 is not finite as a float, which the file would "
                                   "hold; scale the mesh");
    }
    EXPECT_EQ(dir.entries(), 0u);
  }
}

TEST(PolyData, AFolderThatIsMissingIsAnError) {
  const std::vector<NamedPolyData> bodies{{"a", sample_quads()}};
  const std::filesystem::path file = "/none/file";
  EXPECT_EQ(error_name([&] { answers::write_vtp(bodies[0].data, file); }), "file-unwritable");
  EXPECT_EQ(error_name([&] { answers::write_ply(bodies[0].data, file, ""); }), "file-unwritable");
  EXPECT_EQ(error_name([&] { answers::write_glb(bodies, 1, file); }), "file-unwritable");
}

}  // namespace
}  // namespace ist::test
