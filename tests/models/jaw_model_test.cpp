#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <ostream>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "ist/models/models.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist {
namespace {

using test::fingerprint;

constexpr std::uint64_t kSeed = 1, kOtherSeed = 0x9876543210abcdef;

struct Case {
  Jaw jaw;
  std::uint64_t seed;
};
std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << (c.jaw == Jaw::kLower ? "lower " : "upper ") << c.seed;
}

class JawModel : public ::testing::TestWithParam<Case> {
 protected:
  const TriangleMesh mesh_ = make_jaw(GetParam().jaw, GetParam().seed);

  [[nodiscard]] Eigen::Vector3d corner(const Triangle& t, std::size_t k) const {
    return mesh_.vertices[t[k]];
  }
};
INSTANTIATE_TEST_SUITE_P(JawsAndSeeds, JawModel,
                         ::testing::Values(Case{Jaw::kLower, kSeed}, Case{Jaw::kLower, kOtherSeed},
                                           Case{Jaw::kUpper, kSeed}, Case{Jaw::kUpper, kOtherSeed}),
                         [](const auto& tested) {
                           return std::string(tested.param.jaw == Jaw::kLower ? "Lower" : "Upper") +
                                  (tested.param.seed == kSeed ? "" : "OfAnotherSeed");
                         });

TEST_P(JawModel, HasTheTrianglesThatItsDocumentationNames) {
  EXPECT_EQ(mesh_.triangles.size(), GetParam().jaw == Jaw::kLower ? 119096u : 106676u);
}

TEST_P(JawModel, IsClosedAndConsistentlyWound) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Triangle& t : mesh_.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_LT(t[k], mesh_.vertices.size());
      ASSERT_NE(t[k], t[(k + 1) % 3]);
      ASSERT_TRUE(edges.emplace(t[k], t[(k + 1) % 3]).second) << "an edge runs twice one way";
    }
  }
  for (const auto& [from, to] : edges) {
    ASSERT_TRUE(edges.contains({to, from})) << "an edge has one triangle only";
  }
}

TEST_P(JawModel, IsOnePieceOfGenusZero) {
  std::vector<std::uint32_t> parent(mesh_.vertices.size());
  for (std::uint32_t i = 0; i < parent.size(); ++i) parent[i] = i;
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const Triangle& t : mesh_.triangles) {
    parent[root(t[0])] = root(t[1]);
    parent[root(t[1])] = root(t[2]);
  }
  for (std::uint32_t i = 0; i < parent.size(); ++i) ASSERT_EQ(root(i), root(0));
  // Closed, so three edges for two triangles: V - E + F = V - F/2.
  EXPECT_EQ(mesh_.vertices.size() - mesh_.triangles.size() / 2, 2u);
}

TEST_P(JawModel, FacesOutwardAndHasAJawsVolume) {
  double volume = 0;
  for (const Triangle& t : mesh_.triangles) {
    volume += corner(t, 0).dot(corner(t, 1).cross(corner(t, 2))) / 6;
  }
  EXPECT_GT(volume, 40e3);  // mm³
  EXPECT_LT(volume, 80e3);
}

TEST_P(JawModel, HasFloatVerticesNoTwoAlikeAndNoDegenerateTriangle) {
  std::set<std::tuple<double, double, double>> places;
  for (const Eigen::Vector3d& v : mesh_.vertices) {
    ASSERT_EQ(v, v.cast<float>().cast<double>());
    ASSERT_TRUE(places.emplace(v.x(), v.y(), v.z()).second);
  }
  for (const Triangle& t : mesh_.triangles) {
    const Eigen::Vector3d a = corner(t, 1) - corner(t, 0), b = corner(t, 2) - corner(t, 0);
    const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (a - b).squaredNorm()});
    ASSERT_GT(a.cross(b).norm(), 1e-4 * longest);
  }
}

TEST_P(JawModel, HasAJawsSizeInTheDocumentedFrame) {
  Eigen::Vector3d low = mesh_.vertices[0], high = low;
  for (const Eigen::Vector3d& v : mesh_.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  const Eigen::Vector3d expected =
      GetParam().jaw == Jaw::kLower ? Eigen::Vector3d(112, 90, 74) : Eigen::Vector3d(110, 77, 44);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR((high - low)[axis], expected[axis], 2.5);
  EXPECT_NEAR(low.x() + high.x(), 0, 2);
  EXPECT_NEAR(low.y(), -52, 2);
}

TEST(JawModelBytes, AreTheSameOnEveryMachine) {
  EXPECT_EQ(fingerprint(make_jaw(Jaw::kLower, kSeed)), 0x877ef125302f0684u);
  EXPECT_EQ(fingerprint(make_jaw(Jaw::kUpper, kSeed)), 0x01a44cd90efe722cu);
  EXPECT_EQ(fingerprint(make_jaw(Jaw::kLower, kOtherSeed)), 0x0ec14ff230921f46u);
  EXPECT_EQ(fingerprint(make_jaw(Jaw::kUpper, kOtherSeed)), 0xf9088cc45ba21e58u);
}

TEST(JawModelBytes, DoNotDependOnTheCallersRounding) {
  const std::uint64_t expected = fingerprint(make_jaw(Jaw::kLower, kSeed));
  constexpr unsigned kRoundUp = 0x4000;
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | kRoundUp);
  const std::uint64_t rounded_up = fingerprint(make_jaw(Jaw::kLower, kSeed));
  _mm_setcsr(before);
  EXPECT_EQ(rounded_up, expected);
}

TEST(JawModelBytes, DifferFromSeedToSeed) {
  for (const Jaw jaw : {Jaw::kLower, Jaw::kUpper}) {
    const auto seeds = test::samples(std::size_t{8});
    std::set<std::uint64_t> seen;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      seen.insert(fingerprint(make_jaw(jaw, seed)));
    }
    EXPECT_EQ(seen.size(), seeds);
  }
}

// How far the lower jaw stands above the upper one, in the columns through the upper one's
// vertices: the way that it must go down to be free. By regions: side, and 6 mm steps of y.
class Overlaps {
 public:
  Overlaps(const TriangleMesh& lower, const TriangleMesh& upper) : lower_(lower) {
    for (const Triangle& t : lower.triangles) {
      const Eigen::Vector3d &a = lower.vertices[t[0]], &b = lower.vertices[t[1]],
                            &c = lower.vertices[t[2]];
      for (int x = cell(std::min({a.x(), b.x(), c.x()}));
           x <= cell(std::max({a.x(), b.x(), c.x()})); ++x) {
        for (int y = cell(std::min({a.y(), b.y(), c.y()}));
             y <= cell(std::max({a.y(), b.y(), c.y()})); ++y) {
          columns_[{x, y}].push_back(&t);
        }
      }
    }
    for (const Eigen::Vector3d& v : upper.vertices) {
      const double overlap = top(v.x(), v.y()) - v.z();
      const std::pair<bool, int> region{v.x() > 0, static_cast<int>(std::floor(v.y() / 6))};
      const auto [place, inserted] = regions_.try_emplace(region, overlap);
      place->second = std::max(place->second, overlap);
    }
  }

  [[nodiscard]] double largest() const {
    double result = -1e9;
    for (const auto& [region, overlap] : regions_) result = std::max(result, overlap);
    return result;
  }
  [[nodiscard]] auto regions_above(double bound) const {
    return std::count_if(regions_.begin(), regions_.end(),
                         [&](const auto& region) { return region.second > bound; });
  }

 private:
  static int cell(double x) { return static_cast<int>(std::floor(x)); }

  // The lower jaw's highest point above a place; far below where it has none.
  [[nodiscard]] double top(double x, double y) const {
    double result = -1e9;
    const auto column = columns_.find({cell(x), cell(y)});
    if (column == columns_.end()) return result;
    for (const Triangle* t : column->second) {
      const Eigen::Vector3d &a = lower_.vertices[(*t)[0]], &b = lower_.vertices[(*t)[1]],
                            &c = lower_.vertices[(*t)[2]];
      const double area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
      if (area == 0) continue;
      const double u = ((x - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (y - a.y())) / area;
      const double v = ((b.x() - a.x()) * (y - a.y()) - (x - a.x()) * (b.y() - a.y())) / area;
      if (u < 0 || v < 0 || u + v > 1) continue;
      result = std::max(result, a.z() + u * (b.z() - a.z()) + v * (c.z() - a.z()));
    }
    return result;
  }

  const TriangleMesh& lower_;
  std::map<std::pair<int, int>, std::vector<const Triangle*>> columns_;
  std::map<std::pair<bool, int>, double> regions_;
};

TEST(JawModelOcclusion, TeethOverlapAsMadeAndAreFreeTwoMillimetresLower) {
  constexpr std::array<std::pair<std::uint64_t, std::uint64_t>, 3> kSeeds{
      {{kSeed, kSeed}, {kSeed, kOtherSeed}, {7, 3}}};
  for (const auto& [lower_seed, upper_seed] : kSeeds) {
    const TriangleMesh lower = make_jaw(Jaw::kLower, lower_seed);
    const TriangleMesh upper = make_jaw(Jaw::kUpper, upper_seed);
    const Overlaps overlaps(lower, upper);
    EXPECT_GT(overlaps.largest(), 0.6);
    EXPECT_LT(overlaps.largest(), 2);
    EXPECT_GE(overlaps.regions_above(0.2), 8);
  }
}

}  // namespace
}  // namespace ist
