#include "ist/measure/first_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ist/models/models.h"
#include "measure/body_pair.h"
#include "query/query_cases.h"
#include "simd/targets.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;
using Pose = Eigen::Isometry3d;
using ContactStatus = FirstContact::Status;

// The height at which a cube of edge 1 rests on a cube of edge 4, but for a gap less than rounding.
constexpr double kRest = 2.5 + 0x1p-50;

// The interval is as narrow as was asked for, and at its end triangles intersect, or have passed
// through each other.
void expect_contact(BodyPair& pair, const Motion& motion, double tolerance,
                    const FirstContact& found) {
  EXPECT_EQ(found.status, ContactStatus::kContact) << to_string(found.status);
  EXPECT_TRUE(found.passes || pair.meet(motion.at(found.upper)));
  EXPECT_LE(found.lower, found.upper);
  ASSERT_TRUE(found.triangles.has_value());
  ASSERT_TRUE(found.place.has_value());
  EXPECT_GE(found.place->distance, found.distance.lower);
  EXPECT_LE(found.place->distance, found.distance.upper);
  EXPECT_NEAR(found.normal.norm(), 1, 1e-15);
  if (found.grazed) return;
  const double way = motion.longest_way(pair.moving.triangles()->vertices);
  EXPECT_LE((found.upper - found.lower) * way, std::max(tolerance, found.narrowest) * 1.0001);
  EXPECT_FALSE(pair.meet(motion.at(found.lower)));
}

TEST(FirstContact, OfBoxesIsWhereTheirFacesMeet) {
  BodyPair pair(box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0}, {1, 1, 1}));
  const Motion motion = Motion::between(place({0.3, 0.2, 4}), place({0.3, 0.2, -2}));
  for (const double tolerance : {0.1, 1e-3, 1e-6, 1e-9}) {
    const FirstContact found = first_contact(pair.query, motion, tolerance);
    expect_contact(pair, motion, tolerance, found);
    EXPECT_LE(found.lower, 0.5);
    EXPECT_GE(found.upper, 0.5);
    EXPECT_LT(found.distances, 20U);
  }
  // Less than arithmetic can give: as little as it can.
  const FirstContact least = first_contact(pair.query, motion, 0);
  expect_contact(pair, motion, least.narrowest, least);
  EXPECT_LT(least.narrowest, 1e-5);
}

// A ball comes down on a plate: its lowest vertex meets the point below it.
TEST(FirstContact, BallOnPlate_HasPlaceAndNormal) {
  Random random(19);
  BodyPair pair(box({-3, -3, -1}, {3, 3, 0}), icosphere(3, 1));
  for (int i = 0; i < samples(10); ++i) {
    Pose from = place({0.3, -0.4, 4}), to = place({0.2, 0.1, 0.2});
    from.linear() = to.linear() = random.rotation();
    const Motion motion = Motion::between(from, to);
    const FirstContact found = first_contact(pair.query, motion, 1e-9);
    expect_contact(pair, motion, 1e-9, found);
    const Pose free = motion.at(found.lower);
    Vector lowest(0, 0, 9);
    for (const Vector& vertex : pair.moving.triangles()->vertices) {
      if ((free * vertex)[2] < lowest[2]) lowest = free * vertex;
    }
    EXPECT_LT((found.place->moving_point - lowest).norm(), 1e-14);
    EXPECT_LT((found.place->fixed_point - Vector(lowest[0], lowest[1], 0)).norm(), 1e-14);
    EXPECT_NEAR(found.place->distance, lowest[2], 1e-14);
    EXPECT_EQ(found.place->fixed_part, TrianglePart::kFace);
    EXPECT_LE(found.place->moving_part, TrianglePart::kCorner2);
    EXPECT_LT((found.normal - Vector(0, 0, 1)).norm(), 1e-5);
  }
}

// The closest points of two crossing edges lie inside both.
TEST(FirstContact, CrossingEdges_HavePlaceAndNormal) {
  Pose from = place({0, 0, 5}), to = place({0, 0, 1});
  from.linear() = to.linear() = (Eigen::AngleAxisd(std::numbers::pi / 2, Vector::UnitZ()) *
                                 Eigen::AngleAxisd(std::numbers::pi / 4, Vector::UnitX()))
                                    .toRotationMatrix();
  const TriangleMesh bar = box({-3, -1, -1}, {3, 1, 1});
  // The fixed bar stands on an edge as well, along x.
  TriangleMesh stands = bar;
  for (Vector& vertex : stands.vertices) {
    vertex = Eigen::AngleAxisd(std::numbers::pi / 4, Vector::UnitX()) * vertex;
  }
  BodyPair pair(stands, bar);
  const Motion motion = Motion::between(from, to);
  const FirstContact found = first_contact(pair.query, motion, 1e-9);
  expect_contact(pair, motion, 1e-9, found);
  EXPECT_LT((found.place->fixed_point - Vector(0, 0, std::numbers::sqrt2)).norm(), 1e-12);
  EXPECT_LT((found.place->moving_point - Vector(0, 0, std::numbers::sqrt2 + found.place->distance))
                .norm(),
            1e-12);
  EXPECT_GE(found.place->fixed_part, TrianglePart::kEdge0);
  EXPECT_LE(found.place->fixed_part, TrianglePart::kEdge2);
  EXPECT_LT((found.normal - Vector(0, 0, 1)).norm(), 1e-5);
}

TEST(FirstContact, TouchingAtStart_HasACommonPoint) {
  BodyPair pair(box({0, 0, 0}, {2, 2, 2}), icosphere(2, 1));
  const FirstContact found = first_contact(pair.query, place({1, 1, 2.5}), place({1, 1, 9}), 1e-3);
  ASSERT_EQ(found.status, ContactStatus::kTouchesAtStart);
  ASSERT_TRUE(found.place.has_value());
  EXPECT_EQ(found.place->triangles, *found.triangles);
  EXPECT_EQ(found.place->distance, 0);
  EXPECT_LT((found.place->fixed_point - found.place->moving_point).norm(), 1e-14);
  EXPECT_NEAR(found.place->fixed_point[2], 2, 1e-14);
  EXPECT_LE((found.place->fixed_point - Vector(1, 1, 2.5)).norm(), 1);
  EXPECT_EQ(found.normal, Vector(0, 0, 0));
}

TEST(FirstContact, WithoutAContact_HasNoPlace) {
  BodyPair pair(box({-2, -2, -2}, {2, 2, 2}), box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
  const auto expect_none = [&](const FirstContact& found, ContactStatus status) {
    EXPECT_EQ(found.status, status) << to_string(found.status);
    EXPECT_FALSE(found.place.has_value());
    EXPECT_EQ(found.normal, Vector(0, 0, 0));
  };
  const auto along = [&](const Vector& from, const Vector& to) {
    return first_contact(pair.query, place(from), place(to), 1e-3);
  };
  expect_none(along({0, 0, 9}, {0, 9, 9}), ContactStatus::kNone);
  expect_none(along({0, 0, kRest}, {0.001, 0, kRest}), ContactStatus::kGrazing);
  expect_none(along({0, 0, 0}, {0, 0, 9}), ContactStatus::kInsideAtStart);
  expect_none(
      first_contact(pair.query, place({0, 0, 9}), place({0, 0, 0}), 1e-3, {.budget = {.tests = 1}}),
      ContactStatus::kStopped);
}

TEST(FirstContact, IsTheSameWithoutVoxels) {
  const TriangleMesh a = icosphere(3, 2), b = box({-1, -1, -1}, {1, 1, 1});
  BodyPair voxels(a, b), alone(a, b, 0);
  const Motion motion = Motion::between(place({0.3, 0.2, 9}), place({0.3, 0.2, -2}));
  const FirstContact found = first_contact(alone.query, motion, 1e-6),
                     wanted = first_contact(voxels.query, motion, 1e-6);
  expect_contact(alone, motion, 1e-6, found);
  EXPECT_NEAR(found.lower, wanted.lower, 2e-6);
  EXPECT_NEAR(found.upper, wanted.upper, 2e-6);
  EXPECT_EQ(found.triangles, wanted.triangles);
}

TEST(FirstContact, SaysHowFarThePosesWere) {
  BodyPair pair(box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0}, {1, 1, 1}));
  Pose from = place({0.3, 0.2, 4}), to = place({0.3, 0.2, -2});
  EXPECT_EQ(first_contact(pair.query, from, to, 0.1).rotation_error, 0);
  from(0, 1) = 2e-4;
  EXPECT_EQ(first_contact(pair.query, from, to, 0.1).rotation_error, 2e-4);
  to(1, 0) = 3e-4;
  EXPECT_EQ(first_contact(pair.query, from, to, 0.1).rotation_error, 3e-4);
}

TEST(FirstContact, HasAStatusForEveryEnd) {
  IST_SLOW();
  BodyPair pair(box({-2, -2, -2}, {2, 2, 2}), box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
  const auto status = [&](const Vector& from, const Vector& until) {
    const FirstContact found = first_contact(pair.query, place(from), place(until), 1e-3);
    return std::string(to_string(found.status));
  };
  EXPECT_EQ(status({0, 0, 2}, {0, 0, 9}), "touches-at-start");
  EXPECT_EQ(status({0, 0, 2.5}, {0, 0, 9}), "touches-at-start") << "faces on each other";
  EXPECT_EQ(status({0, 0, 0}, {0, 0, 9}), "inside-at-start");
  EXPECT_EQ(status({0, 0, 9}, {0, 9, 9}), "none");
  EXPECT_EQ(status({0, 0, 9}, {0, 0, 9}), "none") << "a motion that is none";
  EXPECT_EQ(status({0, 0, 9}, {0, 0, 2.5}), "contact") << "at the last pose";
  EXPECT_EQ(status({-9, 0, kRest}, {9, 0, kRest}), "grazing");
  EXPECT_EQ(status({-9, 0, 2.50001}, {9, 0, 2.50001}), "none") << "the gap is more than rounding";
  EXPECT_EQ(status({0, 0, 9}, {0, 0, 2.50001}), "none") << "just not at the last pose";
  const FirstContact none = first_contact(pair.query, place({0, 0, 9}), place({0, 9, 9}), 1e-3);
  EXPECT_EQ(none.lower, 1);
  EXPECT_EQ(none.upper, 1);
}

// Along a face, nearer to it than rounding, and then against a step.
TEST(FirstContact, SaysWhereItGrazedBeforeTheContact) {
  IST_SLOW();
  BodyPair pair(joined(box({-9, -2, -2}, {9, 2, 0}), box({5, -2, 0.5}, {9, 2, 2})),
                box({-1, -1, 0}, {1, 1, 1}));
  const auto along = [](double gap) {
    return Motion::between(place({-8, 0, gap}), place({8, 0, gap}));
  };
  const Motion motion = along(1e-13);
  const FirstContact found = first_contact(pair.query, motion, 0.01);
  expect_contact(pair, motion, 0.01, found);
  EXPECT_TRUE(found.grazed);
  EXPECT_LE(found.lower, 1e-3);
  EXPECT_NEAR(found.upper, 0.75, 1e-3);
  // No gap beyond rounding grazes, whatever the tolerance.
  for (const double gap : {1e-10, 1e-4}) {
    const FirstContact sharp = first_contact(pair.query, along(gap), 0.01);
    expect_contact(pair, along(gap), 0.01, sharp);
    EXPECT_FALSE(sharp.grazed) << gap;
    EXPECT_NEAR(sharp.lower, 0.75, 1e-3);
  }
}

// A plate rests on two others, one after the other: it may have met either.
TEST(FirstContact, GrazesFromTheFirstPlaceToTheLast) {
  BodyPair pair(joined(box({-5, -1, -1}, {-3, 1, 0}), box({3, -1, -1}, {5, 1, 0})),
                box({-0.5, -0.5, 0}, {0.5, 0.5, 1}));
  const FirstContact found =
      first_contact(pair.query, place({-8, 0, 1e-14}), place({8, 0, 1e-14}), 1e-2);
  EXPECT_EQ(found.status, ContactStatus::kGrazing);
  EXPECT_NEAR(found.lower, (8 - 5.5) / 16, 1e-2);
  EXPECT_NEAR(found.upper, (8 + 5.5) / 16, 1e-2);
}

// Far more triangles are near each other than one list holds, along the whole way.
TEST(FirstContact, ManyNearTriangles_TakeLongerLists) {
  constexpr std::uint32_t kSquares = 120;
  TriangleMesh sheet;
  for (std::uint32_t i = 0; i <= kSquares; ++i) {
    for (std::uint32_t j = 0; j <= kSquares; ++j) {
      sheet.vertices.emplace_back(0.1 * i, 0.1 * j, 0.01 * ((i * 7 + j * 3) % 5));
      if (i == kSquares || j == kSquares) continue;
      const std::uint32_t at = i * (kSquares + 1) + j, next = at + kSquares + 1;
      sheet.triangles.push_back({at, next, at + 1});
      sheet.triangles.push_back({next, next + 1, at + 1});
    }
  }
  BodyPair pair(sheet, sheet, 0);
  const Motion closing = Motion::between(place({0.02, 0.03, 0.2}), place({0.02, 0.03, -0.2}));
  expect_contact(pair, closing, 1e-6, first_contact(pair.query, closing, 1e-6));
  const FirstContact along =
      first_contact(pair.query, place({0.02, 0.03, 0.05}), place({0.52, 0.03, 0.05}), 1e-6);
  EXPECT_EQ(along.status, ContactStatus::kNone) << to_string(along.status);
}

// A corner or an edge goes through a face without thickness between two poses in double.
TEST(FirstContact, ThinnerThanRounding_Passes) {
  const TriangleMesh face = triangle({-1, -1, 0.1}, {1, -1, 0.2}, {0, 1, 0.15});
  const TriangleMesh edge = triangle({0.1, 0.2, 0}, {0.1, 0.2, 0}, {5, 0.1, 0.03});
  BodyPair pair(face, edge, 0);
  const Motion motion = Motion::between(place({0, 0, 3}), place({0, 0, -3}));
  const FirstContact found = first_contact(pair.query, motion, 1e-6);
  expect_contact(pair, motion, 1e-6, found);
  EXPECT_FALSE(found.grazed);
  // Beside it, nothing passes through.
  const FirstContact beside =
      first_contact(pair.query, place({1.2, 0, 3}), place({1.2, 0, -3}), 1e-6);
  EXPECT_EQ(beside.status, ContactStatus::kNone);
}

TEST(FirstContact, PassesThroughNothingHoweverThin) {
  for (const double thick : {1e-2, 1e-5, 1e-8}) {
    BodyPair plate(box({-5, -5, 0}, {5, 5, thick}), box({0, 0, 0}, {1, 1, thick}));
    const Motion motion = Motion::between(place({0.1, 0.2, 500}), place({0.3, -0.2, -700}));
    const FirstContact found = first_contact(plate.query, motion, 1e-3);
    expect_contact(plate, motion, 1e-3, found);
    EXPECT_NEAR(motion.at(found.lower).translation()[2], 0, 1e-3 + thick) << thick;
    EXPECT_NEAR(motion.at(found.upper).translation()[2], 0, 1e-3 + thick) << thick;
  }
}

// A needle goes down between two teeth that are 0.02 apart, and beside it into one.
TEST(FirstContact, OfANeedleBetweenTeeth) {
  BodyPair pair(joined(box({-4, -2, 0}, {-0.01, 2, 3}), box({0.01, -2, 0}, {4, 2, 3})),
                box({-0.005, -0.005, 0}, {0.005, 0.005, 8}));
  const auto down = [&](double x) {
    return first_contact(pair.query, place({x, 0.3, 5}), place({x, 0.3, -9}), 1e-3).status;
  };
  EXPECT_EQ(down(0), ContactStatus::kNone);
  EXPECT_EQ(down(0.004), ContactStatus::kNone);
  EXPECT_EQ(down(0.006), ContactStatus::kContact);
  EXPECT_EQ(down(-1), ContactStatus::kContact);
}

TEST(FirstContact, AlongAScrewOfMoreThanATurn) {
  // A rod that turns about z meets a post from behind: after 350 degrees less their widths.
  BodyPair pair(box({-0.1, 4, -5}, {0.1, 4.2, 50}), box({0, -0.05, -0.05}, {5, 0.05, 0.05}));
  const Motion motion =
      Motion::screw(place({0, 0, 0}), {0, 0, 0}, {0, 0, 1}, -4 * std::numbers::pi, 20);
  const FirstContact found = first_contact(pair.query, motion, 1e-4);
  expect_contact(pair, motion, 1e-4, found);
  EXPECT_NEAR(found.upper * 4 * std::numbers::pi, 1.5 * std::numbers::pi, 0.05)
      << "it is at 12 o'clock after three quarters";
  // The shortest way there, half a turn at most, goes the other way round.
  const FirstContact shortest = first_contact(pair.query, place({0, 0, 0}), motion.at(0.4), 1e-4);
  EXPECT_NE(shortest.status, ContactStatus::kContact) << "at 72 degrees it is past nothing";
}

// The middle of the rod stays. The ends alone move, and pass the post early on the way.
TEST(FirstContact, OfARodThatTurnsAboutItsMiddle) {
  const Vector post(5 * std::cos(0.1), 5 * std::sin(0.1), 0), half(0.01, 0.01, 1);
  BodyPair pair(box(post - half, post + half), box({-5.2, -0.01, -0.01}, {5.2, 0.01, 0.01}), 0);
  const Motion motion = Motion::screw(place({0, 0, 0}), {0, 0, 0}, {0, 0, 1}, 1.5, 0);
  const FirstContact found = first_contact(pair.query, motion, 1e-6);
  expect_contact(pair, motion, 1e-6, found);
  EXPECT_NEAR(found.upper * 1.5, 0.1, 0.01);
}

TEST(FirstContact, IsNoLaterThanAnyOfManySamples) {
  Random random(83);
  int contacts = 0;
  for (int i = 0; i < samples(60); ++i) {
    BodyPair pair(random_mesh(random), random_mesh(random));
    Pose from = Pose::Identity(), until = Pose::Identity();
    from.linear() = random.rotation();
    const Eigen::AngleAxisd turn(i % 3 == 0 ? 0 : 0.3, random.direction());
    until.linear() = turn.toRotationMatrix() * from.linear();
    // A vertex of each would meet half way.
    const auto any = [&](const SphereTree& tree) {
      const auto& vertices = tree.triangles()->vertices;
      return vertices[random.below(vertices.size())];
    };
    const Vector there = any(pair.fixed), mine = any(pair.moving), way = 9 * random.direction();
    from.translation() = there - from.linear() * mine + way;
    until.translation() = there - until.linear() * mine - way;
    const Motion motion = i % 2 == 0
                              ? Motion::between(from, until)
                              : Motion::screw(from, random.point(-2, 2), random.direction(),
                                              random.uniform(-9, 9), random.uniform(-20, 20));
    const FirstContact found = first_contact(pair.query, motion, 1e-3);
    if (found.status == ContactStatus::kContact) {
      expect_contact(pair, motion, 1e-3, found);
      ++contacts;
    }
    constexpr int kSamples = 1000;
    for (int k = 0; k <= kSamples; ++k) {
      const double at = static_cast<double>(k) / kSamples;
      if (at >= found.lower && (found.status == ContactStatus::kContact || at <= found.upper))
        continue;
      EXPECT_FALSE(pair.meet(motion.at(at))) << i << ' ' << at << ' ' << to_string(found.status);
    }
  }
  EXPECT_GT(contacts, samples(15));
}

TEST(FirstContact, OfClosingJawsTakesFewDistances) {
  BodyPair jaws(make_jaw(Jaw::kUpper, 1), make_jaw(Jaw::kLower, 1), 1);
  const Motion motion = Motion::between(place({0, 0, -7}), place({0, 0, 0}));
  const FirstContact found = first_contact(jaws.query, motion, 1e-3);
  expect_contact(jaws, motion, 1e-3, found);
  EXPECT_LT(found.distances, 40U);
  EXPECT_LE(found.distance.lower, found.distance.upper);
  EXPECT_LE(found.distance.lower, 1e-3);
}

TEST(FirstContact, HasTheSameBitsOnEveryTargetWhateverWasAskedBefore) {
  const SphereTree fixed = build_tree(torus(3, 1, 18, 9), {.voxel_size = 0.5});
  const SphereTree moving = build_tree(icosphere(2, 1), {.voxel_size = 0.5});
  Query best(fixed, moving);
  const Motion motion = Motion::screw(place({8, 1, 0}), {0, 2, 0}, {0, 1, 1}, 5, -3);
  const FirstContact truth = first_contact(best, motion, 1e-4);
  for (const std::string& target : all_targets()) {
    Query query(fixed, moving, {.target = target});
    static_cast<void>(query.distance(place({4, 0, 0}), 0.1));
    const FirstContact found = first_contact(query, motion, 1e-4);
    EXPECT_EQ(found.status, truth.status);
    EXPECT_EQ(found.lower, truth.lower) << target;
    EXPECT_EQ(found.upper, truth.upper) << target;
    EXPECT_EQ(found.distances, truth.distances);
    EXPECT_EQ(found.normal, truth.normal);
    ASSERT_EQ(found.place.has_value(), truth.place.has_value());
    if (!truth.place) continue;
    EXPECT_EQ(found.place->triangles, truth.place->triangles) << target;
    EXPECT_EQ(found.place->fixed_point, truth.place->fixed_point) << target;
    EXPECT_EQ(found.place->moving_point, truth.place->moving_point) << target;
  }
}

// How far a convex body that holds the origin reaches along a direction.
double reach_of(const TriangleMesh& convex, const Vector& direction) {
  double least = HUGE_VAL;
  for (const auto& [a, b, c] : convex.triangles) {
    const Vector& corner = convex.vertices[a];
    const Vector normal = (convex.vertices[b] - corner).cross(convex.vertices[c] - corner);
    const double along = normal.dot(direction);
    if (along > 0) least = std::min(least, normal.dot(corner) / along);
  }
  return least;
}

// A ball comes along the diagonal of a cube: the cube's corner is the first to meet it.
TEST(FirstContact, EndsWhereItIsTold) {
  const TriangleMesh ball = icosphere(3, 1);
  BodyPair pair(box({0, 0, 0}, {1, 1, 1}), ball);
  const Vector start(5, 5, 5), corner(1, 1, 1);
  const Motion motion = Motion::between(place(start), place({0, 0, 0}));
  const double reach = reach_of(ball, -corner.normalized());
  const double meets = ((start - corner).norm() - reach) / start.norm();
  double last = -1;
  const FirstContact stopped =
      first_contact(pair.query, motion, 1e-6, {.proceed = [&](double part) {
                      EXPECT_GT(part, last);
                      last = part;
                      return part < 0.3;
                    }});
  EXPECT_EQ(stopped.status, ContactStatus::kStopped);
  EXPECT_GE(stopped.lower, 0.3);
  EXPECT_LE(stopped.lower, meets);
  EXPECT_EQ(stopped.upper, 1);
  const FirstContact one = first_contact(pair.query, motion, 1e-6, {.budget = {.tests = 1}});
  EXPECT_EQ(one.status, ContactStatus::kStopped);
  EXPECT_EQ(one.distances, 1U);
  EXPECT_LE(one.lower, meets);
  const FirstContact whole = first_contact(pair.query, motion, 1e-6);
  EXPECT_EQ(whole.status, ContactStatus::kContact);
  EXPECT_LE(whole.lower, meets + 1e-12);
  EXPECT_GE(whole.upper, meets - 1e-12);
}

TEST(FirstContact, OfFarPosesIsNoneOrRefused) {
  BodyPair pair(icosphere(2, 1), icosphere(2, 1));
  const FirstContact far =
      first_contact(pair.query, place({1e14, 3e13, 0}), place({1e14, 4e13, 0}), 1);
  EXPECT_EQ(far.status, ContactStatus::kNone) << to_string(far.status);
  for (const double much : {1e16, 1e155}) {
    EXPECT_EQ(
        error_name([&] {
          static_cast<void>(first_contact(pair.query, place({much, 0, 0}), place({0, 0, 0}), 1));
        }),
        "argument-invalid");
  }
}

// Rounding is large at the first poses, and small near the contact: there alone it counts.
TEST(FirstContact, IsSharpHoweverFarTheBodiesBegin) {
  BodyPair pair(box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0}, {1, 1, 1}));
  for (const double far : {1e2, 2e4, 1e6, 1e8}) {
    const Motion motion = Motion::between(place({far, 0.2, 0.3}), place({-1, 0.2, 0.3}));
    const FirstContact found = first_contact(pair.query, motion, 1e-3);
    expect_contact(pair, motion, 1e-3, found);
    EXPECT_LE(found.narrowest, 1e-3) << far;
    const double truth = (far - 1) / (far + 1);
    EXPECT_LE(found.lower, truth);
    EXPECT_GE(found.upper, truth * (1 - 1e-15));
    EXPECT_LE((found.upper - found.lower) * (far + 1), 1.001e-3) << far;
  }
}

TEST(FirstContact, RefusesWhatIsNoQuestion) {
  BodyPair pair(box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0}, {1, 1, 1}));
  for (const double tolerance : {-1.0, std::nan("")}) {
    EXPECT_EQ(error_name([&] {
                static_cast<void>(
                    first_contact(pair.query, Pose::Identity(), Pose::Identity(), tolerance));
              }),
              "argument-invalid");
  }
  const SphereTree bare =
      build_tree(box({0, 0, 0}, {1, 1, 1}), {.voxel_size = 0.5, .keep_triangles = false});
  Query query(pair.fixed, bare);
  EXPECT_EQ(error_name([&] {
              static_cast<void>(first_contact(query, Pose::Identity(), Pose::Identity(), 1));
            }),
            "triangles-missing");
}

}  // namespace
}  // namespace ist::test
