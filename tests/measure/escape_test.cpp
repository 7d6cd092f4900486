#include "ist/measure/escape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "ist/measure/penetration.h"
#include "ist/models/models.h"
#include "measure/body_pair.h"
#include "simd/targets.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/random.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;
using Pose = Eigen::Isometry3d;
using EscapeStatus = Escape::Status;

// The largest way of a vertex.
double way_between(const TriangleMesh& mesh, const Pose& from, const Pose& to) {
  double most = 0;
  for (const Vector& v : mesh.vertices) most = std::max(most, (to * v - from * v).norm());
  return most;
}

// What every answer promises.
void expect_free(BodyPair& bodies, const Pose& pose, const Escape& found) {
  ASSERT_EQ(found.status, EscapeStatus::kFound);
  const Pose free = found.pose();
  EXPECT_EQ(bodies.query.intersects(free).answer, Answer::kNo);
  EXPECT_EQ(bodies.query.inside(free).inside, Inside::kNone);
  EXPECT_LE(found.lower, found.upper);
  const double way = way_between(*bodies.moving.triangles(), pose, free);
  EXPECT_GE(found.upper, way);
  EXPECT_LE(found.upper, way * (1 + 1e-9) + 1e-9);
  EXPECT_TRUE((found.motion() * pose).isApprox(free, 1e-12));
  const Eigen::Matrix3d rotation = free.linear();
  EXPECT_TRUE((rotation.transpose() * rotation).isIdentity(1e-14));
}

// Every triangle cut in four.
TriangleMesh quartered(const TriangleMesh& mesh) {
  TriangleMesh cut;
  for (const Triangle& t : mesh.triangles) {
    Vector p[6];
    for (std::size_t i = 0; i < 3; ++i) p[i] = mesh.vertices[t[i]];
    for (std::size_t i = 0; i < 3; ++i) p[3 + i] = 0.5 * (p[i] + p[(i + 1) % 3]);
    const auto first = static_cast<std::uint32_t>(cut.vertices.size());
    cut.vertices.insert(cut.vertices.end(), p, p + 6);
    constexpr std::uint32_t kParts[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
    for (const auto& [a, b, c] : kParts) {
      cut.triangles.push_back({first + a, first + b, first + c});
    }
  }
  return cut;  // build_tree() welds it
}

// The shortest translation that parts two convex bodies: the least overlap along a normal of a
// face, or along a normal of two edges. No other rigid motion is shorter: a plane parts the bodies
// after it, and the point that was deepest behind the plane has gone as far.
double convex_escape(const TriangleMesh& fixed, TriangleMesh moving, const Pose& pose) {
  for (Vector& v : moving.vertices) v = pose * v;
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](const Vector& along) {
    if (!(along.norm() > 1e-9)) return;
    const Vector n = along.normalized();
    double high = -HUGE_VAL, low = HUGE_VAL;
    for (const Vector& v : fixed.vertices) high = std::max(high, n.dot(v));
    for (const Vector& v : moving.vertices) low = std::min(low, n.dot(v));
    least = std::min(least, high - low);
  };
  const auto edges = [](const TriangleMesh& mesh) {
    std::vector<Vector> all;
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (t[i] < t[(i + 1) % 3]) {
          all.push_back(mesh.vertices[t[(i + 1) % 3]] - mesh.vertices[t[i]]);
        }
      }
    }
    return all;
  };
  const auto normal = [](const TriangleMesh& mesh, const Triangle& t) -> Vector {
    return (mesh.vertices[t[1]] - mesh.vertices[t[0]])
        .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
  };
  for (const Triangle& t : fixed.triangles) look(normal(fixed, t));
  for (const Triangle& t : moving.triangles) look(-normal(moving, t));
  for (const Vector& a : edges(fixed)) {
    for (const Vector& b : edges(moving)) {
      look(a.cross(b));
      look(b.cross(a));
    }
  }
  return least;
}

TEST(Escape, OfCrossedBarsIsTheirOverlap) {
  // The middle of an edge is 0.5 from both sides of the other bar, and the bars overlap by 1.5.
  TriangleMesh a = box({-5, -0.5, 0}, {5, 0.5, 3}), b = box({-0.5, -5, 1.5}, {0.5, 5, 4.5});
  for (const std::size_t triangles : {12U, 48U, 192U}) {
    ASSERT_EQ(a.triangles.size(), triangles);
    BodyPair bars(a, b, 0);
    const Penetration depth = penetration(bars.query, Pose::Identity(), 1e-4);
    EXPECT_NEAR(depth.lower, 0.5, 1e-4);
    const Escape found = escape(bars.query, Pose::Identity(), {.tolerance = 1e-4});
    expect_free(bars, Pose::Identity(), found);
    EXPECT_LE(found.lower, 0.5);
    EXPECT_NEAR(found.lower, 0.5, 1e-4);
    EXPECT_GT(found.upper, 1.5);
    EXPECT_LE(found.upper, 1.5 + 1e-4);
    a = quartered(a);
    b = quartered(b);
  }
}

TEST(Escape, OfSpheresIsTheirOverlap) {
  const TriangleMesh a = icosphere(4, 4), b = icosphere(4, 2);
  BodyPair spheres(a, b, 0);
  constexpr double kFacets = 0.01;
  for (const double apart : {5.9, 5.0, 4.0, 2.5}) {
    const Pose pose = place(apart * Vector(0.6, 0, 0.8));
    const Escape found = escape(spheres.query, pose);
    expect_free(spheres, pose, found);
    EXPECT_NEAR(found.upper, 6 - apart, kFacets) << apart;
    EXPECT_NEAR(found.lower, 6 - apart, kFacets) << apart;
  }
  // Wholly inside: the depth is the farthest point's, the escape takes the body's width more.
  const Pose inside = place({0.5, 0, 0});
  const Escape found = escape(spheres.query, inside);
  expect_free(spheres, inside, found);
  EXPECT_NEAR(found.upper, 5.5, kFacets);
}

TEST(Escape, OfABoxInAPlaneIsItsDepthThere) {
  const TriangleMesh ground = box({-50, -50, -20}, {50, 50, 0}),
                     stone = box({-1, -2, -3}, {1, 2, 3});
  BodyPair bodies(ground, stone, 0);
  Random random(3);
  for (int i = 0; i < samples(10); ++i) {
    Pose pose = Pose::Identity();
    pose.linear() = random.rotation();
    double low = 0;
    for (const Vector& v : stone.vertices) low = std::min(low, (pose * v)[2]);
    const double depth = random.uniform(0.01, 1.5);
    pose.translation() = Vector(random.uniform(-9, 9), random.uniform(-9, 9), -low - depth);
    const Escape found = escape(bodies.query, pose, {.tolerance = 1e-4});
    expect_free(bodies, pose, found);
    EXPECT_GE(found.upper, depth);
    EXPECT_LE(found.upper, depth + 1e-4);
    EXPECT_NEAR(found.lower, depth, 1e-4);
  }
}

TEST(Escape, OfConvexBodiesIsNoShorterThanTheirLeastOverlap) {
  const TriangleMesh shapes[] = {box({-2, -1, -1}, {2, 1, 1}), icosphere(0, 1.5), icosphere(1, 2),
                                 box({-0.2, -3, -1}, {0.2, 3, 1})};
  Random random(17);
  int asked = 0, least = 0;
  for (const TriangleMesh& a : shapes) {
    for (const TriangleMesh& b : shapes) {
      BodyPair bodies(a, b, 0);
      for (int i = 0; i < samples(5); ++i) {
        Pose pose = Pose::Identity();
        pose.linear() = random.rotation();
        pose.translation() = random.uniform(0, 3) * random.direction();
        const Escape found = escape(bodies.query, pose, {.tolerance = 1e-4});
        const double wanted = convex_escape(a, b, pose);
        if (wanted < 0) {
          EXPECT_EQ(found.status, EscapeStatus::kNotNeeded);
          EXPECT_EQ(found.upper, 0);
          continue;
        }
        expect_free(bodies, pose, found);
        EXPECT_LE(found.lower, wanted + 1e-9);
        EXPECT_GE(found.upper, wanted - 1e-9);
        ++asked;
        if (found.upper <= 1.01 * wanted + 1e-3) ++least;
      }
    }
  }
  EXPECT_GE(least, 0.8 * asked) << "of " << asked << ", to 1 %";
}

TEST(Escape, LeadsOutOfABodyWhollyInside) {
  BodyPair bodies(box({0, 0, 0}, {4, 4, 4}), box({0, 0, 0}, {1, 1, 1}), 0);
  const Pose pose = place({1.5, 1.25, 0.5});
  const Escape found = escape(bodies.query, pose, {.tolerance = 1e-4});
  expect_free(bodies, pose, found);
  EXPECT_NEAR(found.lower, 1.5, 1e-4) << "the depth of the far face";
  EXPECT_GE(found.upper, 1.5);
  EXPECT_LE(found.upper, 1.5 + 1e-4);
  // The fixed body inside the moving one.
  BodyPair turned(box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0}, {4, 4, 4}), 0);
  const Pose around = place({-1.5, -1.25, -0.5});
  const Escape back = escape(turned.query, around, {.tolerance = 1e-4});
  expect_free(turned, around, back);
  EXPECT_NEAR(back.upper, 1.5, 1e-4);
  EXPECT_GT(back.translation[2], 1.4);
}

// A piece of a body may be inside while the rest of it is outside.
TEST(Escape, FreesEachPieceOfABody) {
  const TriangleMesh pieces = joined(box({0, 0, 0}, {1, 1, 1}), box({9, 0, 0}, {10, 1, 1}));
  BodyPair bodies(box({-2, -2, -2}, {3, 3, 3}), pieces, 0);
  const Escape found = escape(bodies.query, Pose::Identity(), {.tolerance = 1e-4});
  ASSERT_EQ(found.status, EscapeStatus::kFound);
  EXPECT_NEAR(found.upper, 3, 1e-4);
  BodyPair piece(box({-2, -2, -2}, {3, 3, 3}), box({0, 0, 0}, {1, 1, 1}), 0);
  EXPECT_EQ(piece.query.inside(found.pose()).inside, Inside::kNone);
}

TEST(Escape, OfOpenBodiesHasNoLowerBound) {
  // A strip through a box, and a strip through a strip.
  TriangleMesh strip = open_strip(4);
  BodyPair box_and_strip(box({0, -1, -0.25}, {8, 3, 2}), strip, 0);
  const Escape found = escape(box_and_strip.query, Pose::Identity(), {.tolerance = 1e-4});
  ASSERT_EQ(found.status, EscapeStatus::kFound);
  EXPECT_EQ(found.lower, 0);
  EXPECT_EQ(box_and_strip.query.intersects(found.pose()).answer, Answer::kNo);
  BodyPair strips(strip, strip, 0);
  Pose crossed = place({1.5, 0.25, -0.45});
  crossed.linear() = Eigen::AngleAxisd(1.2, Vector(1, 0, 0)).toRotationMatrix();
  const Escape apart = escape(strips.query, crossed, {.tolerance = 1e-4});
  ASSERT_EQ(apart.status, EscapeStatus::kFound);
  EXPECT_EQ(apart.lower, 0);
  EXPECT_GT(apart.upper, 0);
  EXPECT_LE(apart.upper, 0.5) << "0.45 of the strip lie below the other one";
  EXPECT_EQ(strips.query.intersects(apart.pose()).answer, Answer::kNo);
}

TEST(Escape, IsNotNeededByFreeBodies) {
  BodyPair bodies(torus(8, 2, 40, 20), icosphere(3, 1), 0);
  for (const Vector& at : {Vector(0, 0, 0), Vector(0, 0, 30), Vector(1e9, 0, 0)}) {
    const Escape found = escape(bodies.query, place(at));
    EXPECT_EQ(found.status, EscapeStatus::kNotNeeded);
    EXPECT_EQ(found.lower, 0);
    EXPECT_EQ(found.upper, 0);
    EXPECT_TRUE(found.motion().matrix().isIdentity(0));
    EXPECT_EQ(found.pose().translation(), at);
    EXPECT_EQ(found.verdicts, 1U);
  }
}

TEST(Escape, IsNoLongerThanAsked) {
  BodyPair bars(box({-5, -0.5, 0}, {5, 0.5, 3}), box({-0.5, -5, 1.5}, {0.5, 5, 4.5}), 0);
  for (const double longest : {0.0, 0.4, 0.6, 1.4}) {
    const Escape found =
        escape(bars.query, Pose::Identity(), {.tolerance = 1e-4, .longest = longest});
    EXPECT_EQ(found.status, EscapeStatus::kNotFound) << longest;
    EXPECT_NEAR(found.lower, 0.5, 1e-4);
    EXPECT_EQ(found.upper, HUGE_VAL);
    EXPECT_TRUE(found.motion().matrix().isIdentity(0));
    EXPECT_TRUE(found.pose().matrix().isIdentity(0));
  }
  const Escape found = escape(bars.query, Pose::Identity(), {.tolerance = 1e-4, .longest = 1.6});
  EXPECT_EQ(found.status, EscapeStatus::kFound);
  EXPECT_LE(found.upper, 1.6);
}

TEST(Escape, EndsWhenItsCallerSaysSo) {
  BodyPair bars(box({-5, -0.5, 0}, {5, 0.5, 3}), box({-0.5, -5, 1.5}, {0.5, 5, 4.5}), 0);
  double last = -1;
  const Escape whole = escape(bars.query, Pose::Identity(), {.proceed = [&](double part) {
                                EXPECT_GE(part, last);
                                EXPECT_LE(part, 1);
                                last = part;
                                return true;
                              }});
  bool is_found = false;
  for (const std::uint64_t most : {0U, 1U, 5U, 40U, 100U, 300U}) {
    std::uint64_t asked = 0;
    const Escape some =
        escape(bars.query, Pose::Identity(), {.proceed = [&](double) { return asked++ < most; }});
    EXPECT_LE(some.verdicts, most);
    if (some.status == EscapeStatus::kFound) {
      is_found = true;
      expect_free(bars, Pose::Identity(), some);
      EXPECT_GE(some.upper, whole.upper);
    } else {
      EXPECT_FALSE(is_found) << "a motion that was found is kept";
      EXPECT_EQ(some.status, EscapeStatus::kUnknown);
      EXPECT_EQ(some.upper, HUGE_VAL);
      EXPECT_TRUE(some.pose().matrix().isIdentity(0));
    }
  }
  EXPECT_TRUE(is_found);
}

TEST(Escape, OfJawsFreesThem) {
  BodyPair jaws(make_jaw(Jaw::kUpper, 1), make_jaw(Jaw::kLower, 1), 0);
  Random random(7);
  for (int i = 0; i < samples(10); ++i) {
    Pose pose = place(random.uniform(0, 0.5) * random.direction());
    pose.linear() =
        Eigen::AngleAxisd(random.uniform(0, 0.02), random.direction()).toRotationMatrix();
    const Escape found = escape(jaws.query, pose, {.tolerance = 0.01});
    if (found.status == EscapeStatus::kNotNeeded) continue;
    expect_free(jaws, pose, found);
    EXPECT_GT(found.lower, 0);
    EXPECT_LE(found.upper, 1.5 * found.lower) << "jaws leave each other by little more than depth";
  }
}

TEST(Escape, OfRealJawsFreesThem) {
  IST_SLOW();
  const std::filesystem::path folder = data_dir();
  if (!std::filesystem::exists(folder)) IST_SKIP("no real meshes at " << folder);
  BodyPair jaws(read_mesh(folder / "human_maxilla.stl"), read_mesh(folder / "human_mandible.stl"),
                0);
  for (const double dz : {0.0, -0.5, -1.0}) {
    const Escape found = escape(jaws.query, place({0, 0, dz}));
    expect_free(jaws, place({0, 0, dz}), found);
    EXPECT_LE(found.upper, 1.2 * found.lower) << dz;
  }
}

TEST(Escape, HasTheSameBitsOnEveryTargetAndAfterOtherQuestions) {
  const SphereTree fixed = build_tree(torus(3, 1, 18, 9)), moving = build_tree(icosphere(3, 2));
  Pose pose = place({1.9, 0.4, 0.7});
  Query best(fixed, moving);
  const Escape truth = escape(best, pose);
  ASSERT_EQ(truth.status, EscapeStatus::kFound);
  for (const std::string& target : all_targets()) {
    Query query(fixed, moving, {.target = target});
    EXPECT_EQ(query.intersects(place({5, 1, 0})).status, QueryStatus::kDone);
    const Escape found = escape(query, pose);
    EXPECT_EQ(found.upper, truth.upper) << target;
    EXPECT_EQ(found.pose().matrix(), truth.pose().matrix()) << target;
    EXPECT_EQ(found.verdicts, truth.verdicts) << target;
  }
}

TEST(Escape, WorksInEveryUnit) {
  for (const double size : {1e-12, 1e-3, 1e6, 9e13}) {
    BodyPair bars(box(size * Vector(-5, -0.5, 0), size * Vector(5, 0.5, 3)),
                  box(size * Vector(-0.5, -5, 1.5), size * Vector(0.5, 5, 4.5)), 0);
    const Escape found = escape(bars.query, Pose::Identity());
    ASSERT_EQ(found.status, EscapeStatus::kFound) << size;
    EXPECT_GE(found.upper, 1.5 * size);
    EXPECT_LE(found.upper, 1.501 * size);
    EXPECT_NEAR(found.lower, 0.5 * size, 1e-3 * size);
    EXPECT_EQ(bars.query.intersects(found.pose()).answer, Answer::kNo);
  }
}

TEST(Escape, RefusesWhatIsNoQuestion) {
  BodyPair bodies(icosphere(1, 2), icosphere(1, 2), 0);
  for (const double bad : {-1.0, std::nan("")}) {
    EXPECT_EQ(error_name([&] { (void)escape(bodies.query, Pose::Identity(), {.tolerance = bad}); }),
              to_string(ErrorCode::kArgumentInvalid));
    EXPECT_EQ(error_name([&] { (void)escape(bodies.query, Pose::Identity(), {.longest = bad}); }),
              to_string(ErrorCode::kArgumentInvalid));
  }
  Pose mirrored = Pose::Identity();
  mirrored.linear()(0, 0) = -1;
  EXPECT_EQ(escape(bodies.query, mirrored).status, EscapeStatus::kInvalidPose);
  EXPECT_STREQ(to_string(EscapeStatus::kNotNeeded), "not-needed");
  EXPECT_STREQ(to_string(EscapeStatus::kBusy), "busy");
}

}  // namespace
}  // namespace ist::test
