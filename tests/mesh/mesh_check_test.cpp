#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <string>

#include "ist/base/error.h"
#include "ist/mesh/mesh.h"
#include "ist/query/inside.h"
#include "ist/query/query.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist {
namespace {

std::string summary(const MeshReport& r) {
  std::string text;
  const auto add = [&text](const char* name, std::size_t count) {
    if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + name;
  };
  add("vertices", r.vertices);
  add("triangles", r.triangles);
  add("boundary", r.boundary_edges);
  add("non-manifold", r.non_manifold_edges);
  add("inconsistent", r.inconsistent_edges);
  add("duplicate", r.duplicate_triangles);
  add("degenerate", r.degenerate_triangles);
  add("parts", r.components);
  add("open", r.open_components);
  return text + (r.closed ? ", closed" : "");
}

TEST(CheckMesh, FindsNothingWrongWithABox) {
  const MeshReport report = check_mesh(test::box({-1, -2, -3}, {1, 2, 3}));
  EXPECT_EQ(summary(report), "8 vertices, 12 triangles, 1 parts, closed");
  EXPECT_EQ(report.edges, 18u);
  EXPECT_TRUE(report.consistent);
  EXPECT_EQ(report.box_min, Eigen::Vector3d(-1, -2, -3));
  EXPECT_EQ(report.box_max, Eigen::Vector3d(1, 2, 3));
  EXPECT_DOUBLE_EQ(report.signed_volume, 48);
  EXPECT_TRUE(warnings(report).empty());
}

TEST(CheckMesh, CountsWhatIsWrong) {
  const TriangleMesh cube = test::box({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(summary(check_mesh(test::open_strip(3))),
            "8 vertices, 6 triangles, 8 boundary, 1 parts, 1 open");

  TriangleMesh twice = cube;
  twice.triangles.push_back({3, 0, 2});  // the first one, begun elsewhere
  EXPECT_EQ(summary(check_mesh(twice)),
            "8 vertices, 13 triangles, 3 non-manifold, 1 duplicate, 1 parts");

  TriangleMesh one_turned = cube;
  std::swap(one_turned.triangles[0][1], one_turned.triangles[0][2]);
  EXPECT_EQ(summary(check_mesh(one_turned)),
            "8 vertices, 12 triangles, 3 inconsistent, 1 parts, closed");

  TriangleMesh equal_indices = cube;
  equal_indices.triangles.push_back({5, 5, 2});
  EXPECT_EQ(summary(check_mesh(equal_indices)),
            "8 vertices, 13 triangles, 1 degenerate, 1 parts, closed");

  const TriangleMesh mixed = test::joined(cube, test::moved(test::open_strip(1), {5, 0, 0}));
  EXPECT_EQ(summary(check_mesh(mixed)), "12 vertices, 14 triangles, 4 boundary, 2 parts, 1 open");

  // Two cubes that share a vertex hang together; by an edge, too, and that edge has four sides.
  TriangleMesh touching = test::joined(cube, test::moved(cube, {1, 1, 1}));
  for (Triangle& t : touching.triangles) std::replace(t.begin(), t.end(), 8u, 7u);
  EXPECT_EQ(check_mesh(touching).components, 1u);
  EXPECT_TRUE(check_mesh(touching).closed);

  // Two cubes that share an edge are closed: four triangles traverse it, twice each way.
  TriangleMesh at_edge = test::joined(cube, test::moved(cube, {1, 1, 0}));
  weld(at_edge);
  EXPECT_EQ(summary(check_mesh(at_edge)),
            "16 vertices, 24 triangles, 1 non-manifold, 1 parts, closed");
  EXPECT_TRUE(check_mesh(at_edge).consistent);
  for (std::size_t t = 12; t < 24; ++t) {
    std::swap(at_edge.triangles[t][1], at_edge.triangles[t][2]);
  }
  EXPECT_TRUE(check_mesh(at_edge).consistent);  // twice each way still
  std::swap(at_edge.triangles[0][1], at_edge.triangles[0][2]);
  EXPECT_FALSE(check_mesh(at_edge).consistent);
}

TEST(CheckMesh, RefusesWhatIsNoNumberOrNoVertex) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  TriangleMesh cube = test::box({0, 0, 0}, {1, 1, 1});
  for (const auto& [mesh, code] :
       {std::pair(TriangleMesh{{{0, 0, 0}, {1, kNaN, 0}, {0, 1, 0}}, {{0, 1, 2}}},
                  "mesh-not-finite"),
        std::pair(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}},
                  "mesh-bad-index")}) {
    TriangleMesh changed = mesh;
    EXPECT_EQ(test::error_name([&, &mesh = mesh] { static_cast<void>(check_mesh(mesh)); }), code);
    EXPECT_EQ(test::error_name([&] { weld(changed); }), code);
    EXPECT_EQ(test::error_name([&] { static_cast<void>(orient_outward(changed)); }), code);
    EXPECT_EQ(test::error_name([&, &mesh = mesh] { InsideTest{mesh, cube}; }), code);
    EXPECT_EQ(test::error_name([&, &mesh = mesh] { InsideTest{cube, mesh}; }), code);
  }
}

// Digits of such numbers span more than a thousand bits.
TEST(CheckMesh, NumbersMayBeFarApart) {
  TriangleMesh mesh{{{1e-250, 0, 0}, {1e250, 0, 0}, {0, 1e250, 0}, {0, 0, 1e250}},
                    {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
  EXPECT_TRUE(check_mesh(mesh).closed);
  EXPECT_FALSE(check_mesh(mesh).self_intersections_complete);
  EXPECT_EQ(orient_outward(mesh).turned_components, 1u);
  EXPECT_TRUE(check_mesh(test::box({0, 0, 0}, {1, 1, 1})).self_intersections_complete);
}

TEST(CheckMesh, OfNothingIsNothing) {
  EXPECT_EQ(summary(check_mesh({})), "");
  EXPECT_TRUE(warnings(check_mesh({})).empty());
}

TEST(CheckMesh, TellsSliversFromTrianglesInAnyUnit) {
  for (const double s : {1e-100, 1e-6, 1.0, 1e6, 1e100}) {
    const auto degenerate = [s](double height) {
      return check_mesh(test::triangle({0, 0, 0}, {s, 0, 0}, {0.4 * s, height * s, 0}))
          .degenerate_triangles;
    };
    EXPECT_EQ(degenerate(0), 1u);
    EXPECT_EQ(degenerate(0.9e-12), 1u);
    EXPECT_EQ(degenerate(1.1e-12), 0u);
    EXPECT_EQ(check_mesh(test::triangle({s, s, s}, {s, s, s}, {s, s, s})).degenerate_triangles, 1u);
  }
}

TEST(CheckMesh, MeasuresTheVolumeWhereverTheMeshIs) {
  const TriangleMesh cube = test::box({0, 0, 0}, {1, 1, 1});
  EXPECT_DOUBLE_EQ(check_mesh(test::moved(cube, {1e9, -1e9, 1e9})).signed_volume, 1);
  EXPECT_DOUBLE_EQ(check_mesh(test::inside_out(cube)).signed_volume, -1);
}

TEST(CheckMesh, CountsTheHolesOfAnIcosphere) {
  for (int level = 0; level <= 3; ++level) {
    const MeshReport report = check_mesh(test::icosphere(level, 2));
    EXPECT_EQ(report.triangles, 20u << (2 * level));
    EXPECT_EQ(report.vertices + report.triangles, report.edges + 2);
    EXPECT_TRUE(report.closed && report.consistent && report.signed_volume > 0);
  }
}

TEST(Warnings, SayInWordsWhatIsWrong) {
  MeshReport report;
  report.boundary_edges = 1;
  report.non_manifold_edges = 1;
  report.inconsistent_edges = 1;
  report.duplicate_triangles = 1;
  report.degenerate_triangles = 1;
  const std::vector<std::string> one = warnings(report);
  ASSERT_EQ(one.size(), 5u);
  EXPECT_EQ(one[3], "1 triangle repeats an earlier one.");
  report.duplicate_triangles = 22;
  EXPECT_EQ(warnings(report)[3], "22 triangles repeat an earlier one.");
  EXPECT_EQ(warnings(check_mesh(test::inside_out(test::icosphere(0, 1)))),
            std::vector<std::string>{"The surface is inside out: its volume is negative."});
}

struct RealFile {
  const char* name;
  const char* outcome;  // the code of the error, or the summary of the report
};

// A row for every file: what must come of it. The counts of dirty/ agree with its README.
constexpr RealFile kRealFiles[] = {
    {"bad_input/3DSMaxExport.STL", "1042 vertices, 2000 triangles, 16 non-manifold, 24 parts"},
    {"bad_input/7_8ths_cube.stl", "14 vertices, 24 triangles, 1 parts, closed"},
    {"bad_input/OutOfMemory.off", "mesh-truncated"},
    {"bad_input/Spider_ascii.stl",
     "722 vertices, 1368 triangles, 72 boundary, 10 inconsistent, 56 degenerate, 18 parts, 4 open"},
    {"bad_input/Spider_binary.stl",
     "722 vertices, 1368 triangles, 72 boundary, 10 inconsistent, 56 degenerate, 18 parts, 4 open"},
    {"bad_input/Wuson.stl", "2117 vertices, 3732 triangles, 412 boundary, 51 parts, 51 open"},
    {"bad_input/busted.STL", "1941 vertices, 3878 triangles, 1 parts, closed"},
    {"bad_input/empty.obj", "mesh-empty"},
    {"bad_input/empty.ply", "mesh-empty"},
    {"bad_input/empty.stl", "mesh-empty"},
    {"bad_input/featuretype.STL", "2010 vertices, 3476 triangles, 576 boundary, 1 parts, 1 open"},
    {"bad_input/formatDetection_noext_stl", "3 vertices, 1 triangles, 3 boundary, 1 parts, 1 open"},
    {"bad_input/invalid.off", "not-a-mesh"},
    {"bad_input/issue623.ply", "mesh-points-only"},  // no faces, but their list is declared
    {"bad_input/malformed.obj", "mesh-bad-index"},   // names vertices 0 and 12 of 8
    {"bad_input/points.ply", "mesh-points-only"},
    {"bad_input/shared.STL", "14 vertices, 24 triangles, 1 non-manifold, 1 parts, closed"},
    {"bad_input/soup.stl", "300 vertices, 100 triangles, 300 boundary, 100 parts, 100 open"},
    {"bad_input/sphereWithHole.stl", "146 vertices, 285 triangles, 9 boundary, 1 parts, 1 open"},
    {"bad_input/stl_empty_ascii.stl", "mesh-empty"},
    {"bad_input/stl_empty_bin.stl", "mesh-empty"},
    {"bad_input/triangle.stl", "3 vertices, 1 triangles, 3 boundary, 1 parts, 1 open"},
    {"bad_input/triangle_with_empty_solid.stl",
     "3 vertices, 1 triangles, 3 boundary, 1 parts, 1 open"},
    {"bad_input/triangle_with_two_solids.stl",
     "6 vertices, 2 triangles, 6 boundary, 2 parts, 2 open"},
    {"dirty/dragon_res3.stl",
     "22982 vertices, 47794 triangles, 2094 non-manifold, 1254 duplicate, 1 parts, closed"},
    {"dirty/human_maxilla_raw_open_soup.stl",
     "10154 vertices, 17992 triangles, 2270 boundary, 30 parts, 14 open"},
    {"dirty/spl_mandible_orig_dirty.stl",
     "17962 vertices, 35784 triangles, 20 non-manifold, 15 inconsistent, 22 duplicate, 47 parts, "
     "closed"},
    {"dirty/vkh_skull_dirty.stl",
     "49589 vertices, 103514 triangles, 8 boundary, 4331 non-manifold, 405 duplicate, 22 parts, 1 "
     "open"},
};

class RealFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(test::data_dir()))
      IST_SKIP("no folder of real meshes at " << test::data_dir());
  }
};

TEST_F(RealFiles, GiveWhatTheyMust) {
  for (const auto& [name, outcome] : kRealFiles) {
    std::string found;
    try {
      found = summary(check_mesh(read_mesh(test::data_dir() / name)));
    } catch (const Error& error) {
      found = to_string(error.code());
    }
    EXPECT_EQ(found, outcome) << name;
  }
}

TEST_F(RealFiles, AllHaveTheirRow) {
  for (const char* folder : {"bad_input", "dirty"}) {
    for (const auto& entry : std::filesystem::directory_iterator(test::data_dir() / folder)) {
      const std::string name = std::string(folder) + "/" + entry.path().filename().string();
      EXPECT_TRUE(std::any_of(std::begin(kRealFiles), std::end(kRealFiles),
                              [&](const RealFile& row) { return name == row.name; }))
          << name;
    }
  }
}

TEST_F(RealFiles, JawsAreWatertightWithTheirHoles) {
  struct Jaw {
    const char* name;
    std::size_t triangles, genus;
  };
  for (const auto& [name, triangles, genus] :
       {Jaw{"human_mandible.stl", 118998, 0}, Jaw{"human_maxilla.stl", 106998, 17},
        Jaw{"spl_mandible.stl", 39998, 6}, Jaw{"spl_cranium_face.stl", 59998, 101}}) {
    const MeshReport report = check_mesh(read_mesh(test::data_dir() / name));
    EXPECT_EQ(report.triangles, triangles);
    EXPECT_TRUE(report.closed && report.consistent) << name;
    EXPECT_EQ(report.components, 1u) << name;
    EXPECT_EQ(report.vertices + report.triangles + 2 * genus, report.edges + 2) << name;
    EXPECT_GT(report.signed_volume, 0) << name;
    EXPECT_EQ(warnings(report).size(), report.self_intersections > 0 ? 1u : 0u) << name;
  }
}

}  // namespace
}  // namespace ist
