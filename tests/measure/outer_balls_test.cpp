#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ist/base/parallel.h"
#include "ist/measure/outer_ball_builder.h"
#include "ist/measure/penetration.h"
#include "ist/measure/signed_distance.h"
#include "ist/tree/tree_parts.h"
#include "query/query_cases.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/shapes.h"
#include "support/tree_file.h"

// Outer balls against brute force in long double, and the answers with them against the answers
// without them.
namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;
using Long = Eigen::Matrix<long double, 3, 1>;

constexpr std::uint64_t kAnyMemory = std::uint64_t{1} << 40;

OuterBalls balls_of_body(const SphereTree& tree) {
  return make_outer_balls(tree, kAnyMemory, nullptr);
}

// The square of the distance of a point from a segment.
long double square_to_segment(const Long& a, const Long& b, const Long& p) {
  const Long edge = b - a, from = p - a;
  const long double length = edge.squaredNorm();
  const long double part = length > 0 ? std::clamp(edge.dot(from) / length, 0.0L, 1.0L) : 0.0L;
  return (from - part * edge).squaredNorm();
}

// The least square over the edges, and over the plane if the point's foot lies in the triangle.
long double square_to_triangle(const std::array<Long, 3>& t, const Long& p) {
  long double least = HUGE_VALL;
  const Long normal = (t[1] - t[0]).cross(t[2] - t[0]);
  bool is_over = normal.squaredNorm() > 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Long &a = t[k], &b = t[(k + 1) % 3];
    least = std::min(least, square_to_segment(a, b, p));
    is_over = is_over && (b - a).cross(p - a).dot(normal) >= 0;
  }
  if (!is_over) return least;
  const long double height = (p - t[0]).dot(normal);
  return std::min(least, height * height / normal.squaredNorm());
}

// The solid angle of a triangle: A. Van Oosterom, J. Strackee, The solid angle of a plane triangle,
// 1983.
long double solid_angle(const std::array<Long, 3>& t, const Long& p) {
  const Long a = t[0] - p, b = t[1] - p, c = t[2] - p;
  const long double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)),
                        la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

struct Case {
  const char* name;
  TriangleMesh mesh;
};

TriangleMesh scaled_body(TriangleMesh mesh, double by) {
  for (Vector& v : mesh.vertices) v *= by;
  return mesh;
}

std::vector<Case> bodies() {
  return {{"ball", icosphere(2, 2)},
          {"torus", torus(3, 1, 18, 9)},
          {"box", box({-2, -1, -1}, {2, 1, 1})},
          {"thin box", box({0, 0, 0}, {1, 1, 1e-4})},
          {"plate with holes", plate_with_holes(2)},
          {"tube", tube(1, 2, 1.5, 0.7)},
          {"needles", cylinder(25, 1, 40)},
          {"far from the origin", moved(icosphere(2, 1), {1000, -2000, 500})},
          {"crossing itself", joined(icosphere(2, 2), moved(icosphere(2, 2), {1, 0.5, 0}))},
          {"a ball in a ball", joined(icosphere(2, 2), inside_out(icosphere(2, 1)))},
          {"inside out", inside_out(torus(3, 1, 12, 9))},
          {"tiny", scaled_body(icosphere(2, 0.6), 1e-12)},
          {"huge", scaled_body(icosphere(2, 0.4), 1e15)}};
}

TEST(OuterBalls, AreEmptyAndOutside) {
  for (const Case& one : bodies()) {
    const SphereTree tree = build_tree(one.mesh);
    const OuterBalls field = balls_of_body(tree);
    const TriangleMesh& mesh = *tree.triangles();
    std::vector<std::array<Long, 3>> triangles;
    for (const Triangle& t : mesh.triangles) {
      triangles.push_back({mesh.vertices[t[0]].cast<long double>(),
                           mesh.vertices[t[1]].cast<long double>(),
                           mesh.vertices[t[2]].cast<long double>()});
    }
    ASSERT_FALSE(field.balls.empty());
    Random random(5);
    for (int i = 0; i < samples(400); ++i) {
      const OuterBall& ball = field.balls[random.below(field.balls.size())];
      const Long centre = field.middle.cast<long double>() +
                          static_cast<long double>(field.unit) * Long(ball.x(), ball.y(), ball.z());
      long double square = HUGE_VALL, angle = 0;
      for (const auto& t : triangles) {
        square = std::min(square, square_to_triangle(t, centre));
        angle += solid_angle(t, centre);
      }
      const long double radius = static_cast<long double>(field.unit) * ball.radius();
      ASSERT_GE(square, radius * radius) << one.name;
      ASSERT_LT(std::abs(angle), 2 * std::numbers::pi_v<long double>) << one.name << ": inside";
    }
  }
}

TEST(OuterBalls, BoundTheDepthOfAnyPoint) {
  for (const Case& one : bodies()) {
    const SphereTree tree = build_tree(one.mesh);
    const OuterBalls field = balls_of_body(tree);
    const double size = 2 * tree.bounding_radius(), rounding = 0x1p-36 * size;
    Random random(7);
    std::vector<Vector> points;
    for (int i = 0; i < samples(3000); ++i) {
      const auto& v = tree.triangles()->vertices;
      points.push_back(v[random.below(v.size())] +
                       std::pow(2.0, -random.uniform(0, 12)) * size * random.direction());
    }
    std::erase_if(points, [](const Vector& p) { return p.cwiseAbs().maxCoeff() > 1e15; });
    const auto distances = signed_distance(tree, points, HUGE_VAL);
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double slack = field.bound_at(points[i]) + distances[i].distance;
      ASSERT_GE(slack, -rounding) << one.name << ' ' << points[i].transpose();
      least = std::min(least, slack);
    }
    EXPECT_LT(least, 0.05 * size) << one.name << ": the bounds are of no use";
  }
}

TEST(OuterBalls, AreTheSameForAnyNumberOfThreads) {
  const SphereTree tree = build_tree(torus(3, 1, 60, 30));
  std::optional<OuterBalls> first;
  for (const std::size_t threads : {std::size_t{1}, std::size_t{4}}) {
    const ScopedThreadLimit limit(threads);
    OuterBalls field = balls_of_body(tree);
    if (first) {
      EXPECT_EQ(field.first, first->first);
      EXPECT_EQ(field.balls, first->balls);
      EXPECT_EQ(field.unit, first->unit);
    }
    first = std::move(field);
  }
}

TEST(OuterBalls, TakeThePromisedMemory) {
  for (const Case& one : bodies()) {
    const SphereTree tree = build_tree(one.mesh);
    const OuterBalls field = balls_of_body(tree);
    const std::uint64_t bytes = 4 * field.first.size() + 8 * field.balls.size();
    EXPECT_LE(bytes, std::max<std::uint64_t>(28 * tree.triangles()->triangles.size(), 1 << 20))
        << one.name;
    EXPECT_LE(double{field.cell} * field.unit, 2 * tree.bounding_radius() / 16) << one.name;
  }
}

TEST(OuterBalls, EndWithTheirProgress) {
  const SphereTree tree = build_tree(torus(3, 1, 60, 30));
  for (const unsigned stage : {1U, 2U, 3U}) {
    Progress progress;
    progress.watch([&] {
      if (progress.stages() == stage) progress.stop();
    });
    EXPECT_EQ(error_name([&] { prepare_depth(tree, kAnyMemory, &progress); }), "cancelled")
        << stage;
    EXPECT_FALSE(is_prepared_for_depth(tree));
  }
  Progress progress;
  prepare_depth(tree, kAnyMemory, &progress);
  EXPECT_TRUE(is_prepared_for_depth(tree));
  EXPECT_EQ(progress.fraction(), 1);
}

TEST(OuterBalls, ThatDoNotFitTheMemoryLeaveTheTreeAsItWas) {
  const SphereTree tree = build_tree(icosphere(3, 1));
  EXPECT_EQ(error_name([&] { prepare_depth(tree, 100); }), "memory-limit");
  EXPECT_FALSE(is_prepared_for_depth(tree));
  prepare_depth(tree, 20'000);
  EXPECT_TRUE(is_prepared_for_depth(tree));
}

TEST(OuterBalls, NeedTriangles) {
  const SphereTree tree = build_tree(icosphere(1, 1), {.voxel_size = 0.2, .keep_triangles = false});
  EXPECT_EQ(error_name([&] { prepare_depth(tree); }), "triangles-missing");
  EXPECT_FALSE(is_prepared_for_depth(tree));
}

TEST(OuterBalls, AreKeptOnceByAllCopiesOfATree) {
  const SphereTree tree = build_tree(icosphere(2, 1)), copy = tree;
  const std::uint64_t before = tree.bytes();
  prepare_depth(copy);
  EXPECT_TRUE(is_prepared_for_depth(tree));
  EXPECT_GT(tree.bytes(), before);
  const OuterBalls* balls = parts_of(tree).triangles->outer_balls();
  prepare_depth(tree);
  EXPECT_EQ(parts_of(tree).triangles->outer_balls(), balls);
}

TEST(OuterBalls, AreSavedWithTheTree) {
  for (const double voxel_size : {0.0, 0.3}) {
    const SphereTree tree = build_tree(torus(3, 1, 30, 15), {.voxel_size = voxel_size});
    const std::string bare = file_of(tree);
    prepare_depth(tree);
    const std::string file = file_of(tree);
    EXPECT_GT(file.size(), bare.size());
    EXPECT_FALSE(is_prepared_for_depth(tree_of_bytes(bare)));
    const SphereTree read = tree_of_bytes(file);
    ASSERT_TRUE(is_prepared_for_depth(read));
    const OuterBalls &was = *parts_of(tree).triangles->outer_balls(),
                     &is = *parts_of(read).triangles->outer_balls();
    EXPECT_EQ(is.balls, was.balls);
    EXPECT_EQ(is.first, was.first);
    EXPECT_EQ(is.half, was.half);
    EXPECT_EQ(file_of(read), file);
  }
}

// Each damaged number of the balls' section is found, though the checksum is right.
TEST(OuterBalls, ThatAreDamagedInAFileAreRefused) {
  const SphereTree tree = build_tree(icosphere(1, 1));
  const std::size_t begin = file_of(tree).size();
  prepare_depth(tree);
  const std::string whole = file_of(tree);
  const auto with = [&](std::size_t at, auto value) {
    std::string bytes = whole;
    std::memcpy(bytes.data() + begin + at, &value, sizeof(value));
    seal(bytes);
    return error_name([&] { static_cast<void>(tree_of_bytes(bytes)); });
  };
  EXPECT_EQ(with(0, std::nan("")), "tree-corrupt");
  EXPECT_EQ(with(24, 0.75), "tree-corrupt");
  EXPECT_EQ(with(24, 0.0), "tree-corrupt");
  EXPECT_EQ(with(32, 0.0F), "tree-corrupt");
  EXPECT_EQ(with(36, -1.0F), "tree-corrupt");
  EXPECT_EQ(with(48, 0U), "tree-corrupt");
  EXPECT_NE(with(48, 0xFFFFFFFFU), "none");
  EXPECT_NE(with(60, 0xFFFFFFFFU), "none");
  EXPECT_EQ(with(64, -2), "tree-corrupt");
  EXPECT_EQ(with(64, 3), "tree-corrupt");
  for (const std::size_t cut : {1U, 8U, 70U}) {
    std::string bytes = whole.substr(0, whole.size() - cut);
    seal(bytes);
    EXPECT_NE(error_name([&] { static_cast<void>(tree_of_bytes(bytes)); }), "none") << cut;
  }
}

void expect_same(const std::vector<SurfaceDistance>& a, const std::vector<SurfaceDistance>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].triangle, b[i].triangle);
    ASSERT_EQ(std::isnan(a[i].distance), std::isnan(b[i].distance));
    if (!std::isnan(a[i].distance)) {
      ASSERT_EQ(a[i].distance, b[i].distance);
    }
    ASSERT_EQ(a[i].is_signed, b[i].is_signed);
  }
}

TEST(OuterBalls, AreMadeForManyDepthsOfClosedBodies) {
  const TriangleMesh ball = icosphere(4, 1);  // 5,120 triangles
  const SphereTree fixed = build_tree(ball), moving = build_tree(ball),
                   open = build_tree(open_strip(3));
  EXPECT_FALSE(prepare_depth_for(99, fixed, moving));
  EXPECT_FALSE(is_prepared_for_depth(fixed));
  EXPECT_FALSE(prepare_depth_for(1'000'000, fixed, open));
  EXPECT_FALSE(is_prepared_for_depth(fixed) || is_prepared_for_depth(open));
  EXPECT_TRUE(prepare_depth_for(100, fixed, moving));
  EXPECT_TRUE(is_prepared_for_depth(fixed) && is_prepared_for_depth(moving));
  EXPECT_TRUE(prepare_depth_for(1, fixed, moving)) << "both have them already";
}

// Open bodies too: only the emptiness of balls counts.
TEST(OuterBalls, LeaveDistanceMapsAsTheyWere) {
  std::vector<Case> all = bodies();
  all.push_back({"open", open_strip(9)});
  for (const Case& one : all) {
    const SphereTree tree = build_tree(one.mesh), prepared = build_tree(one.mesh);
    prepare_depth(prepared);
    const double size = tree.bounding_radius();
    Random random(11);
    std::vector<Vector> points;
    for (int i = 0; i < samples(2000); ++i) {
      points.push_back(tree.origin() + random.uniform(0, 1.5) * size * random.direction());
    }
    std::erase_if(points, [](const Vector& p) { return p.cwiseAbs().maxCoeff() > 1e15; });
    for (const double reach : {1e-9, 0.01, 0.1, 1.0, HUGE_VAL}) {
      expect_same(signed_distance(prepared, points, reach * size),
                  signed_distance(tree, points, reach * size));
    }
  }
}

TEST(OuterBalls, OfTheRealJawsBoundTheDepthAndFitTheirMemory) {
  IST_SLOW();
  const std::filesystem::path folder = data_dir();
  if (!std::filesystem::exists(folder)) IST_SKIP("no real meshes at " << folder);
  for (const char* name : {"human_maxilla.stl", "human_mandible.stl"}) {
    const SphereTree tree = build_tree(read_mesh(folder / name));
    const OuterBalls field = balls_of_body(tree);
    const TriangleMesh& mesh = *tree.triangles();
    EXPECT_LE(4 * field.first.size() + 8 * field.balls.size(), 30 * mesh.triangles.size());
    Random random(13);
    std::vector<Vector> points;
    for (int i = 0; i < samples(100'000); ++i) {
      points.push_back(mesh.vertices[random.below(mesh.vertices.size())] +
                       random.uniform(0, 3) * random.direction());
    }
    const auto distances = signed_distance(tree, points, HUGE_VAL);
    std::vector<double> slack;
    for (std::size_t i = 0; i < points.size(); ++i) {
      slack.push_back(field.bound_at(points[i]) + distances[i].distance);
      ASSERT_GE(slack.back(), -1e-9) << name << ' ' << points[i].transpose();
    }
    std::nth_element(slack.begin(), slack.begin() + std::ssize(slack) / 2, slack.end());
    EXPECT_LT(slack[slack.size() / 2], 0.1) << name;
  }
}

}  // namespace
}  // namespace ist::test
