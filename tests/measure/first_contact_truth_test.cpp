#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "ist/base/pose.h"
#include "ist/base/rigid_move.h"
#include "ist/measure/first_contact.h"
#include "ist/mesh/triangles_meet.h"
#include "measure/body_pair.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/shapes.h"

// First contacts against exact answers from other sources: all pairs of triangles at many poses,
// and a collection of queries whose answers are known.
namespace ist::test {
namespace {

using ContactStatus = FirstContact::Status;

// Whether any triangles of two meshes meet at a pose, exactly.
bool any_meet(const TriangleMesh& fixed, const TriangleMesh& moving,
              const Eigen::Isometry3d& pose) {
  const RigidMove moved(*project_to_rigid(pose));
  std::vector<Eigen::Vector3d> at(moving.vertices.size());
  std::transform(moving.vertices.begin(), moving.vertices.end(), at.begin(), moved);
  return std::any_of(moving.triangles.begin(), moving.triangles.end(), [&](const Triangle& m) {
    const TriangleCorners b = {at[m[0]], at[m[1]], at[m[2]]};
    return std::any_of(fixed.triangles.begin(), fixed.triangles.end(), [&](const Triangle& f) {
      return triangles_meet({fixed.vertices[f[0]], fixed.vertices[f[1]], fixed.vertices[f[2]]}, b);
    });
  });
}

// Bodies of a few triangles: blocks, plates, needles, and those that are neither.
std::vector<TriangleMesh> few_triangles() {
  return {box({-1, -0.7, -0.5}, {1, 0.7, 0.5}),
          box({-2, -2, 0}, {2, 2, 0.01}),
          box({-2, -1.5, 0}, {2, 1.5, 1e-5}),
          box({-0.005, -0.005, -2}, {0.005, 0.005, 2}),
          icosphere(1, 1),
          triangle({-2, -1, 0}, {2, -1, 0.3}, {0, 2, 0.1}),
          joined(box({-2, -1, -1}, {-0.01, 1, 1}), box({0.01, -1, -1}, {2, 1, 1}))};
}

TEST(FirstContactTruth, RandomScrews_MeetNoEarlierThanFound) {
  Random random(41);
  const std::vector<TriangleMesh> bodies = few_triangles();
  int contacts = 0, passes = 0, grazes = 0, nones = 0;
  const int screws = samples(10'000);
  std::vector<std::unique_ptr<BodyPair>> pairs;
  for (const TriangleMesh& a : bodies) {
    for (const TriangleMesh& b : bodies) pairs.push_back(std::make_unique<BodyPair>(a, b, 0));
  }
  for (int i = 0; i < screws; ++i) {
    BodyPair& pair = *pairs[random.below(pairs.size())];
    const TriangleMesh &fixed = *pair.fixed.triangles(), &moving = *pair.moving.triangles();
    // On every second motion, points of both bodies meet half way, to within rounding.
    const auto any_point = [&](const TriangleMesh& mesh) {
      const Triangle& t = mesh.triangles[random.below(mesh.triangles.size())];
      const double s = random.uniform(0, 1), r = random.uniform(0, 1 - s);
      return Eigen::Vector3d(mesh.vertices[t[0]] * (1 - s - r) + mesh.vertices[t[1]] * s +
                             mesh.vertices[t[2]] * r);
    };
    const Eigen::Vector3d there = any_point(fixed) + (i % 2) * random.point(-2, 2);
    Eigen::Isometry3d half = Eigen::Isometry3d::Identity();
    half.linear() = random.rotation();
    half.translation() = there - half.linear() * any_point(moving);
    const Eigen::Vector3d axis = random.direction(), centre = random.point(-3, 3);
    const double angle = i % 4 == 0 ? 0 : random.uniform(-4, 4);
    const double along = random.uniform(2, 12);
    const Motion back = Motion::screw(half, centre, axis, -angle / 2, -along / 2);
    const Motion motion = Motion::screw(back.at(1), centre, axis, angle, along);
    const double tolerance = std::pow(10, random.uniform(-8, -1));
    const FirstContact found = first_contact(pair.query, motion, tolerance);
    using Status = FirstContact::Status;
    contacts += found.status == Status::kContact ? 1 : 0;
    passes += found.passes ? 1 : 0;
    grazes += found.status == Status::kGrazing ? 1 : 0;
    nones += found.status == Status::kNone ? 1 : 0;
    const auto meet = [&](double at) { return any_meet(fixed, moving, motion.at(at)); };
    if (found.status == Status::kTouchesAtStart) {
      EXPECT_TRUE(meet(0)) << i;
      continue;
    }
    if (found.status == Status::kInsideAtStart) continue;
    const bool is_over = found.status != Status::kGrazing;
    const auto free_at = [&](double at) {
      return at < found.lower || (!is_over && at > found.upper);
    };
    for (int k = 0; k < 60; ++k) {
      const double at = random.uniform(0, is_over ? found.lower : 1);
      ASSERT_FALSE(free_at(at) && meet(at)) << i << ' ' << at << ' ' << to_string(found.status);
    }
    // Most likely just before the contact.
    for (int k = 1; k <= 40; ++k) {
      const double at = found.lower * (1 - std::ldexp(1.0, -k));
      ASSERT_FALSE(free_at(at) && meet(at)) << i << ' ' << at << ' ' << to_string(found.status);
    }
    if (found.status != Status::kContact) continue;
    EXPECT_EQ(meet(found.upper) || found.passes, true) << i;
    EXPECT_LE(found.lower, found.upper);
    const double way = motion.longest_way(moving.vertices);
    if (!found.grazed) {
      EXPECT_LE((found.upper - found.lower) * way, std::max(tolerance, found.narrowest) * 1.0001);
    }
    // Half way the bodies meet.
    EXPECT_LE(found.lower, i % 2 == 0 ? 0.5 + 1e-9 : 1) << i;
  }
  std::printf("screws %d: contacts %d, of which %d pass; none %d, grazing %d\n", screws, contacts,
              passes, nones, grazes);
  EXPECT_GT(contacts, screws / 3);
  EXPECT_GT(nones, screws / 20);
  EXPECT_LE(100 * grazes, screws);
}

// A query of two primitives, one of which translates.
struct Translation {
  bool of_edges, meet;
  std::array<Eigen::Vector3d, 4> point;
  Eigen::Vector3d way;
};

std::vector<Translation> known_translations() {
  std::ifstream file(IST_MOTIONS "/translations.txt");
  std::vector<Translation> out;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    char kind = 0;
    int meet = 0;
    Translation query{};
    words >> kind >> meet;
    for (Eigen::Vector3d& p : query.point) words >> p[0] >> p[1] >> p[2];
    words >> query.way[0] >> query.way[1] >> query.way[2];
    EXPECT_TRUE(words) << line;
    query.of_edges = kind == 'e';
    query.meet = meet == 1;
    out.push_back(query);
  }
  return out;
}

// An edge as a triangle without area. A point needs another, far away, for a mesh has an extent.
TriangleMesh moving_primitive(const Translation& query) {
  const auto& p = query.point;
  if (query.of_edges) return triangle(p[0], p[1], p[1]);
  double size = query.way.norm();
  for (const Eigen::Vector3d& q : p) size = std::max(size, (q - p[0]).norm());
  Eigen::Index axis = 0;
  query.way.cwiseAbs().minCoeff(&axis);
  const Eigen::Vector3d far = p[0] + 8 * size * Eigen::Vector3d::Unit(axis);
  return joined(triangle(p[0], p[0], p[0]), triangle(far, far, far));
}

TEST(FirstContactTruth, KnownTranslations_MissNoContactAndGrazeSeldom) {
  const std::vector<Translation> queries = known_translations();
  ASSERT_EQ(queries.size(), 321U);
  int meet = 0, found_all = 0, exact = 0, graze = 0, apart = 0, apart_graze = 0;
  for (std::size_t k = 0; k < queries.size(); ++k) {
    const Translation& query = queries[k];
    const auto& p = query.point;
    BodyPair pair(query.of_edges ? triangle(p[2], p[3], p[3]) : triangle(p[1], p[2], p[3]),
                  moving_primitive(query), 0);
    const FirstContact found =
        first_contact(pair.query, place({0, 0, 0}), place(query.way), 1e-6 * query.way.norm());
    const bool grazes = found.status == ContactStatus::kGrazing;
    const bool contact =
        found.status == ContactStatus::kContact || found.status == ContactStatus::kTouchesAtStart;
    if (query.meet) {
      ++meet;
      EXPECT_NE(found.status, ContactStatus::kNone) << k << ": a contact is missed";
      found_all += contact ? 1 : 0;
      exact += contact && !found.passes ? 1 : 0;
      graze += grazes ? 1 : 0;
    } else {
      ++apart;
      EXPECT_FALSE(contact) << k << ": there is no contact";
      apart_graze += grazes ? 1 : 0;
    }
  }
  std::printf("meet %d: contact %d (at a pose in double %d), grazing %d; apart %d: grazing %d\n",
              meet, found_all, exact, graze, apart, apart_graze);
  EXPECT_LT(exact, found_all) << "some pass between poses in double";
  EXPECT_LE(4 * graze, meet);
  EXPECT_LE(20 * apart_graze, apart);
}

}  // namespace
}  // namespace ist::test
