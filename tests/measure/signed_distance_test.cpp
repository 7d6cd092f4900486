#include "ist/measure/signed_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <thread>

#include "ist/base/parallel.h"
#include "ist/models/models.h"
#include "query/query_cases.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

SphereTree body(const TriangleMesh& mesh, double voxel_size = 0.5) {
  return build_tree(mesh, {.voxel_size = voxel_size});
}

std::vector<Vector> points_about(const TriangleMesh& mesh, int count, double far, Random& random) {
  std::vector<Vector> points;
  for (int k = 0; k < count; ++k) {
    points.push_back(mesh.vertices[random.below(mesh.vertices.size())] +
                     random.uniform(0, far) * random.direction());
  }
  return points;
}

bool lies_inside(const TriangleMesh& mesh, const Vector& p) {
  return std::lround(winding_by_angles(mesh, p)) != 0;
}

// Signs at points about the surface, and just off its vertices, against the sum of solid angles.
void expect_signs(const TriangleMesh& mesh, bool self_intersecting, Random& random) {
  const SphereTree tree = body(mesh);
  EXPECT_EQ(tree.orientation(), Orientation::kOutward);
  EXPECT_EQ(tree.self_intersections() > 0, self_intersecting);
  for (const double far : {2.0, 0.1, 1e-3}) {
    const std::vector<Vector> points = points_about(mesh, samples(150), far, random);
    const auto found = signed_distance(tree, points, kInfinite);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_TRUE(found[i].is_signed);
      EXPECT_EQ(found[i].self_intersecting, self_intersecting);
      EXPECT_EQ(found[i].distance < 0, lies_inside(*tree.triangles(), points[i]))
          << points[i].transpose();
    }
  }
}

// A cube of which one vertex is doubled, off by `by`: two slivers fold over.
TriangleMesh folded_cube(const Vector& by) {
  TriangleMesh mesh = box({0, 0, 0}, {10, 10, 10});
  const Vector corner(10, 10, 10);
  std::vector<std::uint32_t> ends;  // of an edge at the corner
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (mesh.vertices[v] == corner || mesh.vertices[v] == Vector(10, 10, 0)) ends.push_back(v);
  }
  mesh.vertices.push_back(corner + by);
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (const auto& [from, to] : {std::pair(ends[0], ends[1]), std::pair(ends[1], ends[0])}) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      Triangle& triangle = mesh.triangles[t];
      const auto at = std::find(triangle.begin(), triangle.end(), from) - triangle.begin();
      if (at == 3 || triangle[static_cast<std::size_t>(at + 1) % 3] != to) continue;
      const std::uint32_t third = triangle[static_cast<std::size_t>(at + 2) % 3];
      triangle = {from, middle, third};
      mesh.triangles.push_back({middle, to, third});
      break;
    }
  }
  return mesh;
}

TEST(SignedDistance, OfASphereIsItsClosedFormWithinTheFacets) {
  const SphereTree tree = body(icosphere(5, 10));
  Random random(3);
  std::vector<Vector> points;
  for (int k = 0; k < samples(500); ++k) {
    points.push_back(random.uniform(0, 20) * random.direction());
  }
  const auto found = signed_distance(tree, points, kInfinite);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_TRUE(found[i].is_signed);
    EXPECT_NEAR(found[i].distance, points[i].norm() - 10, 0.01);
    EXPECT_NEAR((found[i].closest - points[i]).norm(), std::abs(found[i].distance), 1e-13);
  }
}

TEST(SignedDistance, HasTheSignOfTheWindingNumber) {
  Random random(5);
  for (const TriangleMesh& mesh :
       {make_jaw(Jaw::kUpper, 2), torus(5, 2, 24, 12), box({0, 0, 0}, {1, 4, 9}),
        plate_with_holes(3), joined(icosphere(3, 4), inside_out(icosphere(3, 2))),
        pipe(6, 2, 3, 8)}) {
    const SphereTree tree = body(mesh);
    const std::vector<Vector> points = points_about(mesh, samples(150), 2, random);
    const auto found = signed_distance(tree, points, kInfinite);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_TRUE(found[i].is_signed);
      EXPECT_EQ(found[i].distance < 0, lies_inside(mesh, points[i])) << points[i].transpose();
    }
  }
}

TEST(SignedDistance, OverlappingParts_AreOneBody) {
  Random random(6);
  const TriangleMesh two = joined(box({0, 0, 0}, {2, 2, 2}), box({1.5, 0.5, 0.5}, {3.5, 1.5, 1.5}));
  expect_signs(two, true, random);
  expect_signs(joined(icosphere(3, 4), moved(icosphere(3, 4), {3, 1, 0.5})), true, random);
  expect_signs(joined(two, moved(icosphere(2, 1), {1.7, 1, 1})), true, random);
  const auto found =
      signed_distance(body(two, 0.1), std::vector<Vector>{{1.4, 1, 1}, {1.75, .45, 1}}, kInfinite);
  EXPECT_NEAR(found[0].distance, -0.1, 1e-15) << "the nearest triangle is inside the other part";
  EXPECT_NEAR(found[1].distance, -0.05, 1e-15);
}

TEST(SignedDistance, Folds_DoNotTurnTheSign) {
  Random random(8);
  for (const double size : {1.0, 1e-3, 1e-6, 1e-9}) {
    for (int k = 0; k < samples(20); ++k) {
      const TriangleMesh cube = folded_cube(size * random.direction());
      const SphereTree tree = body(joined(cube, moved(box({0, 0, 0}, {9, 9, 9}), {30, 30, 30})));
      std::vector<Vector> points;
      for (int n = 0; n < 100; ++n) {
        points.push_back(Vector(10, 10, 10) + random.uniform(2 * size, 9) * random.direction());
      }
      const auto found = signed_distance(tree, points, kInfinite);
      for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_EQ(found[i].distance < 0, lies_inside(*tree.triangles(), points[i]))
            << points[i].transpose() << " size " << size;
      }
    }
  }
}

TEST(SignedDistance, SurfacesThatTouchThemselves_HaveCertainSigns) {
  Random random(9);
  const TriangleMesh cube = box({0, 0, 0}, {2, 2, 2});
  // Corners and edges at one position are welded.
  for (const Vector& by : {Vector(2, 2, 2), Vector(2, 2, 0)}) {
    expect_signs(joined(cube, moved(cube, by)), false, random);
  }
  for (const Vector& by : {Vector(2, 0, 0), Vector(2, 1, 0.5), Vector(2, 2, 1)}) {
    expect_signs(joined(cube, moved(cube, by)), true, random);
  }
  // A wall inside, of two opposite faces.
  TriangleMesh wall = cube;
  const auto first = static_cast<std::uint32_t>(wall.vertices.size());
  for (const Vector& v : {Vector(1, 0.5, 0.5), Vector(1, 1.5, 0.5), Vector(1, 1, 1.5)}) {
    wall.vertices.push_back(v);
  }
  wall.triangles.push_back({first, first + 1, first + 2});
  wall.triangles.push_back({first, first + 2, first + 1});
  expect_signs(wall, true, random);
}

// Two faces so near each other that doubles tell no difference from afar.
TEST(SignedDistance, AThinWall_HasTwoSides) {
  const TriangleMesh far_away = box({5, 5, 5}, {6, 6, 6});
  for (const double thickness : {1e-17, 1e-300, 1e-12}) {
    for (int turn = 0; turn < 3; ++turn) {
      TriangleMesh wall = box({0, 0, 0}, {1, 1, thickness});
      for (Vector& v : wall.vertices) v = Vector(v[turn], v[(turn + 1) % 3], v[(turn + 2) % 3]);
      const SphereTree tree = body(joined(wall, far_away));
      Random random(12);
      std::vector<Vector> points;
      for (int i = 0; i < samples(200); ++i) {
        const Vector p(random.uniform(-0.5, 1.5), random.uniform(-0.5, 1.5),
                       random.uniform(1e-9, 1));
        for (const double side : {-1.0, 1.0}) {
          const Vector q(p[0], p[1], side * p[2]);
          points.push_back({q[turn], q[(turn + 1) % 3], q[(turn + 2) % 3]});
        }
      }
      for (const SurfaceDistance& found : signed_distance(tree, points, kInfinite)) {
        EXPECT_TRUE(found.is_signed);
        EXPECT_GT(found.distance, 0) << thickness;
      }
    }
  }
}

TEST(SignedDistance, NestedBodies_AreInsideByWinding) {
  Random random(10);
  expect_signs(joined(icosphere(3, 4), icosphere(2, 2)), false, random);
  expect_signs(joined(icosphere(3, 4), joined(icosphere(2, 2), icosphere(1, 1))), false, random);
  expect_signs(inside_out(joined(icosphere(3, 4), inside_out(icosphere(2, 2)))), false, random);
}

// Points about every closed mesh of the data folder, dirty ones included.
TEST(SignedDistance, RealMeshes_HaveTheSignsOfSolidAngles) {
  IST_SLOW();
  if (!std::filesystem::is_directory(data_dir())) {
    IST_SKIP("no folder of real meshes at " << data_dir());
  }
  Random random(12);
  int closed = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data_dir())) {
    if (entry.path().extension() != ".stl" || entry.path().string().ends_with("bad_input"))
      continue;
    TriangleMesh mesh;
    try {
      mesh = read_mesh(entry.path());
    } catch (const Error&) {
      continue;
    }
    if (orient_outward(mesh).orientation != Orientation::kOutward) continue;
    ++closed;
    const SphereTree tree = build_tree(mesh, {.voxel_size = 2, .spheres = SpherePolicy::kSimple});
    const std::vector<Vector> points = points_about(mesh, 1500, 4, random);
    const auto found = signed_distance(tree, points, kInfinite);
    int wrong = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (std::abs(found[i].distance) < 1e-6) continue;
      wrong += (found[i].distance < 0) == lies_inside(mesh, points[i]) ? 0 : 1;
    }
    EXPECT_EQ(wrong, 0) << entry.path();
  }
  EXPECT_GE(closed, 4);
}

// The triangles of a mesh with corners of their own, as renderers store them.
TriangleMesh soup_of(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(mesh.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TEST(SignedDistance, ArraysOfSeparateTriangles_AreWelded) {
  Random random(13);
  const TriangleMesh ball = icosphere(3, 4), soup = soup_of(ball);
  const SphereTree tree = body(soup), whole = body(ball);
  EXPECT_EQ(tree.orientation(), Orientation::kOutward);
  EXPECT_EQ(tree.triangles()->vertices.size(), soup.vertices.size());
  const std::vector<Vector> points = points_about(ball, samples(200), 5, random);
  const auto found = signed_distance(tree, points, kInfinite),
             expected = signed_distance(whole, points, kInfinite);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(found[i].distance, expected[i].distance);
    EXPECT_EQ(found[i].triangle, expected[i].triangle);
  }
  // A distance for each vertex of the caller's.
  const auto map = distance_map(tree, body(box({-3, -3, -3}, {3, 3, 3})),
                                Eigen::Isometry3d::Identity(), kInfinite);
  ASSERT_EQ(map.size(), soup.vertices.size());
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector& v = soup.vertices[3 * t + k];
      for (std::size_t other = 0; other < 3 * t; other += 17) {
        if (soup.vertices[other] != v) continue;
        EXPECT_EQ(map[other].distance, map[3 * t + k].distance);
      }
    }
  }
  const SphereTree apart = build_tree(soup, {.voxel_size = 0.5, .weld = false});
  EXPECT_EQ(apart.orientation(), Orientation::kAssumed);
}

TEST(SignedDistance, IsNotANumberBeyondTheReach) {
  const SphereTree tree = body(box({-1, -1, -1}, {1, 1, 1}));
  const std::vector<Vector> points = {{0, 0, 3}, {0, 0, 2.5}, {0, 0, 1.5}, {0, 0, 0}, {0, 0, 0.5}};
  const auto found = signed_distance(tree, points, 1.5);
  EXPECT_TRUE(std::isnan(found[0].distance) && std::isnan(found[0].closest[1]));
  EXPECT_EQ(found[0].triangle, SurfaceDistance::kNoTriangle);
  EXPECT_FALSE(found[0].is_signed);
  EXPECT_EQ(found[1].distance, 1.5) << "the reach itself is within";
  EXPECT_EQ(found[2].distance, 0.5);
  EXPECT_EQ(found[3].distance, -1);
  EXPECT_EQ(found[4].distance, -0.5);
  EXPECT_EQ(found[4].closest, Vector(0, 0, 1));
}

TEST(SignedDistance, HasNoSignAtAnOpenBorder) {
  const SphereTree tree = body(open_strip(4));
  const auto found = signed_distance(
      tree, std::vector<Vector>{{1.3, 0.5, 1}, {1.3, 0.5, -1}, {-1, 0.5, -1}}, kInfinite);
  EXPECT_EQ(found[0].distance, 1);
  EXPECT_EQ(found[1].distance, -1);
  EXPECT_TRUE(found[0].is_signed && found[1].is_signed);
  EXPECT_FALSE(found[2].is_signed);
  EXPECT_NEAR(found[2].distance, std::sqrt(2), 1e-15) << "positive where there is no sign";
}

TEST(SignedDistance, HasTheSameBitsForAnyNumberOfThreads) {
  const SphereTree tree = body(make_jaw(Jaw::kLower, 1), 1);
  Random random(7);
  const std::vector<Vector> points = points_about(*tree.triangles(), 5000, 3, random);
  const auto all = signed_distance(tree, points, 2);
  const ScopedThreadLimit one(1);
  const auto single = signed_distance(tree, points, 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(std::memcmp(&all[i].distance, &single[i].distance, sizeof(double)), 0);
    EXPECT_EQ(all[i].triangle, single[i].triangle);
  }
}

// Far away all triangles are equally near, up to rounding. A point outside the box is outside the
// body.
TEST(SignedDistance, IsPositiveFarAway) {
  const SphereTree tree = body(box({-1, -1, 0}, {1, 1, 1e-3}));
  Random random(11);
  for (const double far : {1e3, 1e8, 1e14}) {
    std::vector<Vector> points;
    for (int k = 0; k < samples(50); ++k) points.push_back(far * random.direction());
    for (const SurfaceDistance& one : signed_distance(tree, points, kInfinite)) {
      EXPECT_TRUE(one.is_signed);
      EXPECT_NEAR(one.distance / far, 1, 0.01);
    }
  }
}

// Threads that ask a new tree at once make its normals once, and all wait for them.
TEST(SignedDistance, MayBeAskedFirstByManyThreads) {
  const TriangleMesh mesh = make_jaw(Jaw::kLower, 4);
  Random random(13);
  const std::vector<Vector> points = points_about(mesh, 200, 2, random);
  const auto truth = signed_distance(body(mesh, 2), points, 5);
  const SphereTree fresh = body(mesh, 2);
  std::vector<std::vector<SurfaceDistance>> found(4);
  {
    std::vector<std::jthread> threads;
    for (auto& one : found) {
      threads.emplace_back([&] { one = signed_distance(fresh, points, 5); });
    }
  }
  for (const auto& one : found) {
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(one[i].distance, truth[i].distance);
  }
}

// Closed bodies with triangles that have no area: an apex given twice, and joined; a corner on a
// ridge; and a triangle with two equal indices on an edge.
TEST(SignedDistance, IsRightBesideTrianglesWithoutAnArea) {
  TriangleMesh twice;
  twice.vertices = {{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {0, 0, 2}, {0, 0, 2}};
  twice.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 5}, {3, 0, 5},
                     {4, 2, 5}, {5, 0, 4}, {0, 3, 2}, {0, 2, 1}};
  TriangleMesh ridge;
  ridge.vertices = {{0, 0, 1}, {4, 0, 1}, {2, 0, 1}, {0, 2, 0}, {4, 2, 0}, {0, -2, 0}, {4, -2, 0}};
  ridge.triangles = {{0, 2, 3}, {2, 4, 3}, {2, 1, 4}, {0, 1, 2}, {1, 0, 5},
                     {1, 5, 6}, {3, 4, 6}, {3, 6, 5}, {0, 3, 5}, {1, 6, 4}};
  TriangleMesh needle = box({0, 0, 0}, {1, 1, 1});
  const Triangle first = needle.triangles[0];
  needle.triangles.insert(needle.triangles.begin(), {first[0], first[1], first[1]});
  Random random(17);
  for (const TriangleMesh& mesh : {twice, ridge, needle}) {
    const SphereTree tree = body(mesh);
    const std::vector<Vector> points = points_about(mesh, samples(600), 2, random);
    const auto found = signed_distance(tree, points, kInfinite);
    std::size_t known = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!found[i].is_signed) continue;
      ++known;
      ASSERT_EQ(found[i].distance < 0, lies_inside(*tree.triangles(), points[i]))
          << points[i].transpose() << " of " << mesh.vertices.size();
    }
    EXPECT_EQ(known, points.size()) << mesh.vertices.size();
  }
}

TEST(DistanceMap, MovesTheVerticesOfOneBodyToTheOther) {
  const SphereTree fixed = body(box({0, 0, 0}, {4, 4, 4}));
  const SphereTree moving = body(box({0, 0, 0}, {1, 1, 1}));
  const Eigen::Isometry3d pose(Eigen::Translation3d(1, 1, 3.5));
  const auto to_fixed = distance_map(moving, fixed, pose, 10);
  ASSERT_EQ(to_fixed.size(), 8U);
  for (std::size_t v = 0; v < 8; ++v) {
    const Vector at = pose * moving.triangles()->vertices[v];
    EXPECT_EQ(to_fixed[v].distance, at[2] - 4) << at.transpose();
    EXPECT_EQ(to_fixed[v].closest, Vector(at[0], at[1], 4));
  }
  const auto to_moving = distance_map(fixed, moving, pose.inverse(), 0.5);
  for (const SurfaceDistance& one : to_moving) EXPECT_TRUE(std::isnan(one.distance));
}

TEST(DistanceMap, RefusesTreesOfOtherUnitsAndFrames) {
  TriangleMesh mesh = box({0, 0, 0}, {1, 1, 1});
  const auto in = [&](LengthUnit unit, PatientFrame frame) {
    mesh.unit = unit;
    mesh.frame = frame;
    return build_tree(mesh);
  };
  const SphereTree mm = in(LengthUnit::kMillimetre, PatientFrame::kRas),
                   inch = in(LengthUnit::kInch, PatientFrame::kRas),
                   lps = in(LengthUnit::kMillimetre, PatientFrame::kLps),
                   bare = body(box({0, 0, 0}, {1, 1, 1}));
  const auto map = [](const SphereTree& a, const SphereTree& b) {
    return error_of(
        [&] { static_cast<void>(distance_map(a, b, Eigen::Isometry3d::Identity(), 1)); });
  };
  const auto units = map(mm, inch), frames = map(lps, mm);
  ASSERT_TRUE(units && frames);
  EXPECT_EQ(units->code(), ErrorCode::kArgumentInvalid);
  EXPECT_STREQ(
      units->what(),
      "distance map: the body is in mm, and the other body is in inch: convert one mesh to "
      "the unit of the other, and build its tree again");
  EXPECT_STREQ(
      frames->what(),
      "distance map: the body is in the frame lps, and the other body is in ras: build both "
      "in one frame");
  EXPECT_FALSE(map(mm, mm) || map(mm, bare) || map(bare, lps));
}

TEST(SignedDistance, IsTheSameWithoutVoxels) {
  Random random(5);
  for (const TriangleMesh& mesh : {icosphere(2, 1), moved(box({0, 0, 0}, {4, 1, 2}), {90, 0, 7})}) {
    const SphereTree alone = build_tree(mesh), voxels = body(mesh);
    const std::vector<Vector> points = points_about(mesh, samples(600), 2, random);
    const auto found = signed_distance(alone, points, kInfinite),
               wanted = signed_distance(voxels, points, kInfinite);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_NEAR(found[i].distance, wanted[i].distance, 1e-13) << points[i].transpose();
      ASSERT_EQ(found[i].is_signed, wanted[i].is_signed);
    }
  }
}

TEST(SignedDistance, RefusesWhatIsNoQuestion) {
  const SphereTree tree = body(box({0, 0, 0}, {1, 1, 1}));
  const std::vector<Vector> fine = {{0, 0, 0}};
  for (const double reach : {0.0, -1.0, std::nan(""), -kInfinite}) {
    EXPECT_EQ(error_name([&] { static_cast<void>(signed_distance(tree, fine, reach)); }),
              "argument-invalid");
  }
  for (const double bad : {std::nan(""), kInfinite, -2e30}) {
    const std::vector<Vector> points = {{0, 0, 0}, {0, bad, 0}};
    const auto error = error_of([&] { static_cast<void>(signed_distance(tree, points, 1)); });
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code(), ErrorCode::kArgumentInvalid);
    EXPECT_NE(std::string(error->what()).find("point 1"), std::string::npos) << error->what();
  }
  const SphereTree bare =
      build_tree(box({0, 0, 0}, {1, 1, 1}), {.voxel_size = 1, .keep_triangles = false});
  EXPECT_EQ(error_name([&] { static_cast<void>(signed_distance(bare, fine, 1)); }),
            "triangles-missing");
  Eigen::Isometry3d sheared = Eigen::Isometry3d::Identity();
  sheared(0, 1) = 0.5;
  EXPECT_EQ(error_name([&] { static_cast<void>(distance_map(tree, tree, sheared, 1)); }),
            "pose-invalid");
  EXPECT_EQ(error_name([&] {
              static_cast<void>(distance_map(tree, bare, Eigen::Isometry3d::Identity(), 1));
            }),
            "triangles-missing");
  EXPECT_TRUE(signed_distance(tree, {}, 1).empty());
}

}  // namespace
}  // namespace ist::test
