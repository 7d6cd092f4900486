#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

#include "ist/mesh/mesh.h"
#include "ist/models/models.h"
#include "ist/query/query.h"
#include "ist/scene.h"
#include "ist/tree/sphere_tree.h"
#include "support/effort.h"
#include "support/errors.h"

namespace ist::test {
namespace {

using Kind = BuiltInShape::Kind;

const Eigen::Vector3d kCondyle(49.2, 33.5, 74);  // of the right one, in the jaws' frame; mm

void expect_round_the_origin(const MeshReport& report, const Eigen::Vector3d& size) {
  EXPECT_LT((report.box_max + report.box_min).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((report.box_max - report.box_min - size).cwiseAbs().maxCoeff(), 1e-2);
}

// How far triangles come from the surface of that radius round the origin, in parts of it, at their
// centres and the middles of their edges.
double largest_depth(const TriangleMesh& mesh, double radius, const Eigen::Vector3d& across) {
  double depth = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
    for (const Eigen::Vector3d& at : {Eigen::Vector3d((a + b + c) / 3),
                                      Eigen::Vector3d((a + b) / 2), Eigen::Vector3d((b + c) / 2)}) {
      depth = std::max(depth, 1 - at.cwiseProduct(across).norm() / radius);
    }
  }
  return depth;
}

TEST(SceneShape, IsABoxRoundTheOrigin) {
  const TriangleMesh mesh = make_shape({.kind = Kind::kBox, .size = {4, 3, 2}});
  const MeshReport report = check_mesh(mesh);
  EXPECT_EQ(report.triangles, 12u);
  EXPECT_EQ(report.box_min, Eigen::Vector3d(-2, -1.5, -1));
  EXPECT_EQ(report.box_max, Eigen::Vector3d(2, 1.5, 1));
  EXPECT_NEAR(report.signed_volume, 24, 1e-12);
}

TEST(SceneShape, IsASphereRoundTheOriginAsCloseAsIsPromised) {
  const TriangleMesh mesh = make_shape({.kind = Kind::kSphere, .radius = 5});
  EXPECT_EQ(mesh.triangles.size(), 20480u);
  const MeshReport report = check_mesh(mesh);
  expect_round_the_origin(report, {10, 10, 10});
  EXPECT_NEAR(report.signed_volume, 4 * M_PI / 3 * 125, 0.5);
  for (const Eigen::Vector3d& vertex : mesh.vertices) EXPECT_NEAR(vertex.norm(), 5, 1e-14);
  const double depth = largest_depth(mesh, 5, {1, 1, 1});
  EXPECT_LT(depth, 3e-4);
  EXPECT_GT(depth, 1e-4) << "the promise may be sharper";
}

TEST(SceneShape, IsACylinderRoundTheOriginAsCloseAsIsPromised) {
  const TriangleMesh mesh = make_shape({.kind = Kind::kCylinder, .radius = 2, .height = 6});
  EXPECT_EQ(mesh.triangles.size(), 1024u);
  const MeshReport report = check_mesh(mesh);
  expect_round_the_origin(report, {4, 4, 6});
  EXPECT_NEAR(report.signed_volume, M_PI * 4 * 6, 0.02);
  TriangleMesh sides{mesh.vertices, {}};
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]],
                          &c = mesh.vertices[t[2]];
    if (a.z() != b.z() || b.z() != c.z()) sides.triangles.push_back(t);
  }
  EXPECT_EQ(sides.triangles.size(), 512u);
  EXPECT_LT(largest_depth(sides, 2, {1, 1, 0}), 3e-4);
}

TEST(SceneShape, IsAJawOfItsSeed) {
  const TriangleMesh mesh = make_shape({.kind = Kind::kLowerJaw, .seed = 3});
  const TriangleMesh jaw = make_jaw(Jaw::kLower, 3);
  EXPECT_EQ(mesh.vertices, jaw.vertices);
  EXPECT_EQ(mesh.triangles, jaw.triangles);
  EXPECT_NE(make_shape({.kind = Kind::kUpperJaw, .seed = 3}).triangles.size(),
            jaw.triangles.size());
}

TEST(SceneShape, IsTheSplintOfItsSeedAndOpening) {
  const TriangleMesh mesh = make_shape({.kind = Kind::kSplint, .seed = 3, .opening = 4.5});
  const TriangleMesh splint = make_splint(3, 4.5);
  EXPECT_EQ(mesh.vertices, splint.vertices);
  EXPECT_EQ(mesh.triangles, splint.triangles);
}

TEST(SceneShape, IsAFossaOverTheOrigin) {
  const TriangleMesh mesh = make_shape({.kind = Kind::kFossa, .radius = 7, .thickness = 2});
  EXPECT_EQ(mesh.triangles.size(), 16384u);
  const MeshReport report = check_mesh(mesh);
  EXPECT_EQ(report.box_min, Eigen::Vector3d(-9, -9, 0));
  EXPECT_EQ(report.box_max, Eigen::Vector3d(9, 9, 9));
  EXPECT_NEAR(report.signed_volume, 2 * M_PI / 3 * (729 - 343), 2);
}

TEST(SceneShape, IsAFossaInWhichACondyleTurns) {
  IST_SLOW();
  // Where the fossae of a scene stand: round the condyles, which turn in them.
  TriangleMesh fossae = make_shape({.kind = Kind::kFossa, .radius = 7, .thickness = 2});
  TriangleMesh left = fossae;
  for (Eigen::Vector3d& v : fossae.vertices) v += kCondyle;
  for (Eigen::Vector3d& v : left.vertices)
    v += Eigen::Vector3d(-kCondyle.x(), kCondyle.y(), kCondyle.z());
  const auto right = static_cast<std::uint32_t>(fossae.vertices.size());
  fossae.vertices.insert(fossae.vertices.end(), left.vertices.begin(), left.vertices.end());
  for (const auto& [a, b, c] : left.triangles)
    fossae.triangles.push_back({right + a, right + b, right + c});
  const SphereTree fixed = build_tree(fossae, {.voxel_size = 1});
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const SphereTree moving = build_tree(make_jaw(Jaw::kLower, seed), {.voxel_size = 1});
    Query query(fixed, moving);
    for (const double turn : {-0.02, 0.0, 0.1, 0.2, 0.4}) {
      const Eigen::Isometry3d pose = Eigen::Translation3d(kCondyle) *
                                     Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitX()) *
                                     Eigen::Translation3d(-kCondyle);
      const double distance = query.distance(pose, 0).distance.lower;
      EXPECT_GT(distance, 0.4) << turn;
      EXPECT_LT(distance, 0.5) << turn;
    }
  }
}

TEST(SceneShape, IsClosedAndFacesOutwardWhateverItIs) {
  for (const Kind kind : {Kind::kUpperJaw, Kind::kLowerJaw, Kind::kBox, Kind::kSphere,
                          Kind::kCylinder, Kind::kSplint, Kind::kFossa}) {
    const MeshReport report = check_mesh(make_shape({.kind = kind}));
    EXPECT_TRUE(report.closed && report.consistent) << static_cast<int>(kind);
    EXPECT_EQ(report.components, 1u) << static_cast<int>(kind);
    EXPECT_EQ(report.degenerate_triangles, 0u) << static_cast<int>(kind);
    EXPECT_GT(report.signed_volume, 0) << static_cast<int>(kind);
  }
}

TEST(MakeShape, RefusesLengthsOutOfRange) {
  using Kind = BuiltInShape::Kind;
  for (const double length : {0.0, -1.0, 1e13, std::nan("")}) {
    for (const BuiltInShape& shape : {BuiltInShape{.size = {1, length, 1}},
                                      BuiltInShape{.kind = Kind::kSphere, .radius = length},
                                      BuiltInShape{.kind = Kind::kCylinder, .height = length},
                                      BuiltInShape{.kind = Kind::kFossa, .radius = length},
                                      BuiltInShape{.kind = Kind::kFossa, .thickness = length},
                                      BuiltInShape{.kind = Kind::kSplint, .opening = -1},
                                      BuiltInShape{.kind = Kind::kSplint, .opening = 1}}) {
      const std::optional<Error> error = error_of([&] { static_cast<void>(make_shape(shape)); });
      ASSERT_TRUE(error) << length;
      EXPECT_EQ(error->code(), ErrorCode::kArgumentInvalid);
    }
  }
}

}  // namespace
}  // namespace ist::test
