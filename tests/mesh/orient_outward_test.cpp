
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>

#include "ist/mesh/mesh.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist {
namespace {

const TriangleMesh kBall = test::icosphere(1, 1);

// Orients the mesh, which must come out as expected.
void expect_oriented(TriangleMesh mesh, const TriangleMesh& expected, Orientation orientation,
                     std::size_t turned) {
  const OrientationResult result = orient_outward(mesh);
  EXPECT_EQ(mesh.triangles, expected.triangles);
  EXPECT_EQ(result.orientation, orientation);
  EXPECT_EQ(result.turned_components, turned);
}

TEST(OrientOutward, TurnsWhatIsInsideOut) {
  expect_oriented(kBall, kBall, Orientation::kOutward, 0);
  expect_oriented(test::inside_out(kBall), kBall, Orientation::kOutward, 1);
  const TriangleMesh far = test::moved(kBall, {10, 0, 0});
  expect_oriented(test::joined(test::inside_out(kBall), far), test::joined(kBall, far),
                  Orientation::kOutward, 1);
}

TEST(OrientOutward, LeavesCavities) {
  const TriangleMesh shell = test::joined(test::icosphere(1, 5), test::inside_out(kBall));
  expect_oriented(shell, shell, Orientation::kOutward, 0);
  // A stone in the cavity of a shell is right as it is, too.
  const TriangleMesh stone = test::joined(shell, test::icosphere(0, 0.1));
  expect_oriented(stone, stone, Orientation::kOutward, 0);
  // A solid in a solid is right as it is, too.
  const TriangleMesh solids = test::joined(test::icosphere(1, 5), kBall);
  expect_oriented(solids, solids, Orientation::kOutward, 0);
}

TEST(OrientOutward, TurnsWhatLiesInATurnedComponent) {
  const TriangleMesh shell = test::joined(test::icosphere(1, 5), test::inside_out(kBall));
  const TriangleMesh stone = test::joined(shell, test::icosphere(0, 0.1));
  const TriangleMesh solids = test::joined(test::icosphere(1, 5), kBall);
  for (const TriangleMesh& mesh : {shell, stone, solids}) {
    const std::size_t parts = check_mesh(mesh).components;
    expect_oriented(test::inside_out(mesh), mesh, Orientation::kOutward, parts);
    // Beside a body that is right, and after it in the file.
    const TriangleMesh other = test::moved(shell, {20, 0, 0});
    expect_oriented(test::joined(other, test::inside_out(mesh)), test::joined(other, mesh),
                    Orientation::kOutward, parts);
  }
  // An open part inside is turned with the rest.
  const TriangleMesh strip = test::moved(test::open_strip(2), {2, 0, 0});
  expect_oriented(test::inside_out(test::joined(shell, strip)), test::joined(shell, strip),
                  Orientation::kAssumed, 3);
}

// A hole through a cube, flush with two faces, and an octahedron whose corners lie on the faces.
TEST(OrientOutward, ACavityMayHaveAllItsVerticesOnTheShell) {
  const TriangleMesh cube = test::box({0, 0, 0}, {2, 2, 2});
  TriangleMesh octahedron{
      {{2, 1, 1}, {0, 1, 1}, {1, 2, 1}, {1, 0, 1}, {1, 1, 2}, {1, 1, 0}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (const TriangleMesh& solid : {test::box({0, 0.5, 0.5}, {2, 1.5, 1.5}), octahedron}) {
    TriangleMesh holed = test::joined(cube, test::inside_out(solid));
    expect_oriented(holed, holed, Orientation::kOutward, 0);
    expect_oriented(test::inside_out(holed), holed, Orientation::kOutward, 2);
    const TriangleMesh filled = test::joined(cube, solid);
    expect_oriented(filled, filled, Orientation::kOutward, 0);
    expect_oriented(test::inside_out(filled), filled, Orientation::kOutward, 2);
    // Beside the shell, with a face on it, it is a body that is inside out.
    const TriangleMesh beside = test::joined(cube, test::moved(solid, {2, 0, 0}));
    expect_oriented(test::joined(cube, test::moved(test::inside_out(solid), {2, 0, 0})), beside,
                    Orientation::kOutward, 1);
    for (Eigen::Vector3d& v : holed.vertices) v = turn * v;  // off the surface by rounding
    expect_oriented(holed, holed, Orientation::kOutward, 0);
  }
}

TEST(OrientOutward, APartThatSticksOut_IsNoCavity) {
  const TriangleMesh bar = test::box({-1, -1, -1}, {9, 1, 1});
  const TriangleMesh two = test::joined(test::icosphere(1, 5), bar);
  expect_oriented(test::joined(test::icosphere(1, 5), test::inside_out(bar)), two,
                  Orientation::kOutward, 1);
  // Its box lies in the other's box.
  const TriangleMesh tilted =
      test::joined(test::box({-5, -5, -5}, {5, 5, 5}), test::moved(kBall, {4.5, 0, 0}));
  expect_oriented(tilted, tilted, Orientation::kOutward, 0);
}

TEST(OrientOutward, ManyCavities_TakeNoTimeForEachTriangleOfTheShell) {
  TriangleMesh mesh = test::icosphere(5, 50);
  const TriangleMesh cavity = test::inside_out(test::icosphere(0, 0.5));
  std::size_t cavities = 0;
  for (int x = -8; x <= 8; ++x) {
    for (int y = -8; y <= 8; ++y) {
      for (int z = -8; z <= 8; ++z, ++cavities) {
        const TriangleMesh there = test::moved(cavity, {3.0 * x, 3.0 * y, 3.0 * z});
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), there.vertices.begin(), there.vertices.end());
        for (const Triangle& t : there.triangles) {
          mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        }
      }
    }
  }
  expect_oriented(mesh, mesh, Orientation::kOutward, 0);
  expect_oriented(test::inside_out(mesh), mesh, Orientation::kOutward, cavities + 1);
}

TEST(OrientOutward, EndsIfAskedTo) {
  const TriangleMesh mesh =
      test::inside_out(test::joined(test::icosphere(3, 5), test::inside_out(kBall)));
  TriangleMesh copy = mesh;
  Progress progress;
  progress.stop();
  EXPECT_THROW(static_cast<void>(orient_outward(copy, &progress)), Error);
  EXPECT_EQ(copy.triangles, mesh.triangles);
}

TEST(OrientOutward, IsNotFooledByABoxRoundTheOther) {
  // The ball lies in the bounding box of the ring of boxes and of each diagonal bar, but outside.
  TriangleMesh bar = test::box({-10, -1, -1}, {10, 1, 1});
  for (Eigen::Vector3d& v : bar.vertices) v = Eigen::Vector3d(v.x() - v.y(), v.x() + v.y(), v.z());
  const TriangleMesh small = test::moved(test::icosphere(0, 0.5), {5, -5, 0});
  expect_oriented(test::joined(bar, test::inside_out(small)), test::joined(bar, small),
                  Orientation::kOutward, 1);
}

TEST(OrientOutward, NeitherUnitNorPlaceMatters) {
  for (const double s : {1e-12, 1.0, 1e15}) {
    for (const double place : {0.0, 1e3, 1e6}) {
      TriangleMesh shell = test::joined(test::icosphere(1, 5), test::inside_out(kBall));
      shell = test::moved(shell, {place, -place, place});
      for (Eigen::Vector3d& v : shell.vertices) v *= s;
      expect_oriented(shell, shell, Orientation::kOutward, 0);
      expect_oriented(test::inside_out(shell), shell, Orientation::kOutward, 2);
    }
  }
}

TEST(OrientOutward, RaysMayMeetEdges) {
  // Cubes on a lattice, one in the other: their centres and corners line up with the edges.
  for (const double x : {-1.0, 0.0, 1.0}) {
    const TriangleMesh outer = test::box({-4, -4, -4}, {4, 4, 4});
    const TriangleMesh cavity =
        test::inside_out(test::box({x - 1, x - 1, x - 1}, {x + 1, x + 1, x + 1}));
    const TriangleMesh both = test::joined(outer, cavity);
    expect_oriented(both, both, Orientation::kOutward, 0);
  }
}

TEST(OrientOutward, AssumesWhereItCannotTell) {
  const TriangleMesh strip = test::open_strip(3);
  expect_oriented(strip, strip, Orientation::kAssumed, 0);
  expect_oriented({}, {}, Orientation::kAssumed, 0);

  TriangleMesh one_turned = test::inside_out(kBall);
  std::swap(one_turned.triangles[0][1], one_turned.triangles[0][2]);
  expect_oriented(one_turned, one_turned, Orientation::kAssumed, 0);

  TriangleMesh twice = test::inside_out(kBall);
  twice.triangles.push_back(twice.triangles[0]);
  expect_oriented(twice, twice, Orientation::kAssumed, 0);

  // Two sheets back to back hold no volume.
  TriangleMesh sheet = test::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  sheet.triangles.push_back({0, 2, 1});
  expect_oriented(sheet, sheet, Orientation::kAssumed, 0);

  // Beside a body that holds some, they change nothing.
  expect_oriented(test::joined(kBall, sheet), test::joined(kBall, sheet), Orientation::kOutward, 0);

  // What is closed is turned all the same.
  const TriangleMesh far = test::moved(strip, {9, 0, 0});
  expect_oriented(test::joined(test::inside_out(kBall), far), test::joined(kBall, far),
                  Orientation::kAssumed, 1);
}

TEST(OrientOutward, BelievesTheCavitiesOfADirtyShell) {
  // One triangle is there twice, so that the shell is not closed; its cavity must stay a cavity.
  TriangleMesh shell = test::icosphere(1, 5);
  shell.triangles.push_back(shell.triangles[0]);
  const TriangleMesh dirty = test::joined(shell, test::inside_out(kBall));
  expect_oriented(dirty, dirty, Orientation::kAssumed, 0);
}

TEST(OrientOutward, TrianglesWithEqualIndicesHaveNoSay) {
  TriangleMesh mesh = test::inside_out(kBall);
  mesh.triangles.push_back({3, 3, 4});
  TriangleMesh expected = kBall;
  expected.triangles.push_back({3, 3, 4});
  expect_oriented(mesh, expected, Orientation::kOutward, 1);
}

TEST(OrientOutward, LeavesTheJawsAsTheyAre) {
  if (!std::filesystem::is_directory(test::data_dir()))
    IST_SKIP("no folder of real meshes at " << test::data_dir());
  for (const char* name :
       {"human_mandible.stl", "human_maxilla.stl", "spl_mandible.stl", "spl_cranium_face.stl"}) {
    const TriangleMesh mesh = read_mesh(test::data_dir() / name);
    expect_oriented(mesh, mesh, Orientation::kOutward, 0);
    TriangleMesh wrong = test::inside_out(mesh);
    EXPECT_EQ(orient_outward(wrong).turned_components, 1u) << name;
    EXPECT_EQ(check_mesh(wrong).signed_volume, check_mesh(mesh).signed_volume) << name;
  }
}

}  // namespace
}  // namespace ist
