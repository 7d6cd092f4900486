#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "ist/base/error.h"
#include "ist/measure/signed_distance.h"
#include "ist/mesh/mesh.h"
#include "ist/models/models.h"
#include "ist/query/query.h"
#include "ist/tree/sphere_tree.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr double kSplintOpening = 5;  // mm
constexpr std::uint64_t kSplintSeed = 0x9876543210abcdef;

Eigen::Isometry3d lowered(double opening) {
  return Eigen::Isometry3d(Eigen::Translation3d(0, 0, -opening));
}

class SplintModel : public ::testing::TestWithParam<std::uint64_t> {
 protected:
  const TriangleMesh mesh_ = make_splint(GetParam(), kSplintOpening);
};
INSTANTIATE_TEST_SUITE_P(Seeds, SplintModel, ::testing::Values(1, 9, kSplintSeed),
                         [](const auto& tested) { return "Seed" + std::to_string(tested.index); });

TEST_P(SplintModel, IsClosedAndFacesOutward) {
  const MeshReport report = check_mesh(mesh_);
  EXPECT_EQ(report.triangles, 33520u);
  EXPECT_EQ(report.vertices, 2 + report.triangles / 2) << "not of genus 0";
  EXPECT_TRUE(report.closed && report.consistent);
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(report.degenerate_triangles, 0u);
  EXPECT_GT(report.signed_volume, 3000);
  EXPECT_LT(report.signed_volume, 8000);
}

TEST_P(SplintModel, IsAsThickAsIsGuaranteedBetweenItsFaces) {
  const std::size_t points = mesh_.vertices.size() / 2;  // of each face, in the same order
  double least = kSplintOpening, largest = 0;
  for (std::size_t i = 0; i < points; ++i) {
    const Eigen::Vector3d &upper = mesh_.vertices[i], &lower = mesh_.vertices[points + i];
    ASSERT_EQ(upper.head<2>(), lower.head<2>());
    least = std::min(least, upper.z() - lower.z());
    largest = std::max(largest, upper.z() - lower.z());
  }
  EXPECT_GE(least, 1.5);
  EXPECT_EQ(largest, kSplintOpening + 3);
}

TEST_P(SplintModel, HasFloatVerticesNoTwoAlike) {
  std::set<std::tuple<double, double, double>> places;
  for (const Eigen::Vector3d& v : mesh_.vertices) {
    ASSERT_EQ(v, v.cast<float>().cast<double>());
    ASSERT_TRUE(places.emplace(v.x(), v.y(), v.z()).second);
  }
}

TEST_P(SplintModel, KeepsItsDistanceFromBothArchesWhichComeOffAlongZ) {
  const SphereTree splint = build_tree(mesh_, {.voxel_size = 1});
  for (const Jaw jaw : {Jaw::kUpper, Jaw::kLower}) {
    const SphereTree teeth = build_tree(make_jaw(jaw, GetParam()), {.voxel_size = 1});
    Query query(splint, teeth);
    for (const double off : {0.0, 0.5, 2.0, 8.0}) {
      const DistanceInterval distance =
          query.distance(lowered(jaw == Jaw::kUpper ? -off : kSplintOpening + off), 0).distance;
      EXPECT_GE(distance.lower, 0.2 - 1e-9) << off;
      EXPECT_TRUE(off > 0 || distance.upper < 0.22) << distance.upper;
    }
  }
}

// A wall's run in the occlusal plane, with the splint at its left.
struct Wall {
  Eigen::Vector2d from, to;

  [[nodiscard]] Eigen::Vector2d along() const { return to - from; }
  [[nodiscard]] double length() const { return along().norm(); }
};

// The outline from above, of the triangles that stand upright: once round, cut at its corners.
std::vector<std::vector<Wall>> walls_of(const TriangleMesh& mesh) {
  std::map<std::pair<double, double>, Wall> walls;  // by where they begin
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d p = mesh.vertices[a], u = mesh.vertices[b] - p, v = mesh.vertices[c] - p;
    const Eigen::Vector3d normal = u.cross(v);
    if (normal.z() != 0) continue;
    // Two of its corners are above each other.
    Wall wall{p.head<2>(), (p + (u.head<2>().isZero(0) ? v : u)).head<2>()};
    if (wall.along().dot(Eigen::Vector2d(-normal.y(), normal.x())) < 0) {
      std::swap(wall.from, wall.to);
    }
    walls.try_emplace({wall.from.x(), wall.from.y()}, wall);
  }
  std::vector<Wall> round;
  for (Wall wall = walls.begin()->second; round.size() < walls.size();) {
    round.push_back(wall);
    wall = walls.at({wall.to.x(), wall.to.y()});
  }
  const auto turns = [](const Wall& a, const Wall& b) {
    return a.along().dot(b.along()) < 0.5 * a.length() * b.length();
  };
  std::size_t first = 0;
  while (!turns(round[(first + round.size() - 1) % round.size()], round[first])) ++first;
  std::rotate(round.begin(), round.begin() + static_cast<std::ptrdiff_t>(first), round.end());
  std::vector<std::vector<Wall>> parts;
  for (std::size_t i = 0; i < round.size(); ++i) {
    if (i == 0 || turns(round[i - 1], round[i])) parts.emplace_back();
    parts.back().push_back(round[i]);
  }
  return parts;
}

double length_of(const std::vector<Wall>& walls) {
  double sum = 0;
  for (const Wall& wall : walls) sum += wall.length();
  return sum;
}

// How far it is from the middle of a wall, square to it and inwards, to the walls across; infinity
// where none is there.
double width_at(const Wall& here, const std::vector<Wall>& across) {
  const Eigen::Vector2d middle = (here.from + here.to) / 2;
  const Eigen::Vector2d inwards(-here.along().y() / here.length(),
                                here.along().x() / here.length());
  double nearest = std::numeric_limits<double>::infinity();
  for (const Wall& wall : across) {
    Eigen::Matrix2d system;
    system << inwards, -wall.along();
    const Eigen::Vector2d found = system.inverse() * (wall.from - middle);  // width; part of wall
    if (found[0] > 0 && found[1] >= 0 && found[1] <= 1) nearest = std::min(nearest, found[0]);
  }
  return nearest;
}

// Square to its walls, from the middle of each. A side is a curve of chords, which run inside it by
// up to 0.0007 mm.
TEST_P(SplintModel, IsOfOneWidthAllAlongTheArch) {
  constexpr double kWidth = 10.5, kChord = 0.001;
  std::vector<std::vector<Wall>> parts = walls_of(mesh_);
  ASSERT_EQ(parts.size(), 4u) << "two sides and two ends";
  std::sort(parts.begin(), parts.end(),
            [](const auto& a, const auto& b) { return length_of(a) < length_of(b); });
  EXPECT_NEAR(length_of(parts[0]), kWidth, kChord);
  EXPECT_NEAR(length_of(parts[1]), kWidth, kChord);
  EXPECT_GT(length_of(parts[2]), 90) << "it does not go from molar to molar";
  for (const std::size_t side : {2u, 3u}) {
    ASSERT_GT(parts[side].size(), 200u);
    for (const Wall& wall : parts[side]) {
      const double width = width_at(wall, parts[5 - side]);
      ASSERT_LE(std::abs(width - kWidth), kChord) << wall.from.transpose();
    }
  }
}

// Teeth are within half a millimetre of either face, all along the arch.
TEST_P(SplintModel, TakesImprintsOfAllTeeth) {
  const SphereTree splint = build_tree(mesh_, {.voxel_size = 1});
  for (const Jaw jaw : {Jaw::kUpper, Jaw::kLower}) {
    const SphereTree teeth = build_tree(make_jaw(jaw, GetParam()), {.voxel_size = 1});
    const std::vector<SurfaceDistance> distances =
        distance_map(splint, teeth, lowered(jaw == Jaw::kUpper ? 0 : -kSplintOpening), 1);
    std::set<std::tuple<bool, int>> sectors;
    std::size_t near = 0;
    for (std::size_t i = 0; i < distances.size(); ++i) {
      EXPECT_FALSE(distances[i].distance < 0.2 - 1e-9);
      if (!(distances[i].distance < 0.5)) continue;
      ++near;
      const Eigen::Vector3d& at = mesh_.vertices[i];
      sectors.emplace(at.x() > 0, static_cast<int>(-at.y() / 6));
    }
    EXPECT_GT(near, distances.size() / 8) << static_cast<int>(jaw);
    EXPECT_EQ(sectors.size(), 18u);
  }
}

TEST(SplintModelBytes, AreTheSameOnEveryMachine) {
  EXPECT_EQ(fingerprint(make_splint(1, kSplintOpening)), 0xc99643f0710746du);
  EXPECT_EQ(fingerprint(make_splint(kSplintSeed, 4.7)), 0x20fec71df9c5a57bu);
}

TEST(SplintModelOpening, MakesTheSplintThickerByAsMuch) {
  const TriangleMesh thin = make_splint(1, 5), thick = make_splint(1, 6.5);
  ASSERT_EQ(thin.vertices.size(), thick.vertices.size());
  for (std::size_t i = 0; i < thin.vertices.size(); ++i) {
    const bool upper = i < thin.vertices.size() / 2;
    EXPECT_EQ(thick.vertices[i], thin.vertices[i] - Eigen::Vector3d(0, 0, upper ? 0 : 1.5));
  }
}

TEST(SplintModelOpening, IsRefusedWhereItLeavesNoSplintAndItsRemedyHelps) {
  const std::optional<Error> error = error_of([] { static_cast<void>(make_splint(1, 2)); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kArgumentInvalid);
  const std::string text = error->what();
  const std::string before = "give an opening of ";
  const std::size_t at = text.find(before);
  ASSERT_NE(at, std::string::npos) << text;
  const double remedy = std::stod(text.substr(at + before.size()));
  EXPECT_GT(remedy, 2.5);
  EXPECT_FALSE(error_of([&] { static_cast<void>(make_splint(1, remedy)); }));
  EXPECT_TRUE(error_of([&] { static_cast<void>(make_splint(1, remedy - 0.02)); }));
}

TEST(SplintModelOpening, IsRefusedOutOfRange) {
  for (const double opening : {-1.0, 20.1, std::nan("")}) {
    const std::optional<Error> error =
        error_of([&] { static_cast<void>(make_splint(1, opening)); });
    ASSERT_TRUE(error) << opening;
    EXPECT_EQ(error->code(), ErrorCode::kArgumentInvalid);
  }
}

}  // namespace
}  // namespace ist::test
