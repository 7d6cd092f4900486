#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/reference/reference_query.h"
#include "ist/tree/tree_parts.h"
#include "query/scenes.h"
#include "query/triangles/triangle_tree.h"
#include "support/effort.h"
#include "support/shapes.h"
#include "support/stability.h"

namespace ist::test {
namespace {

constexpr int kLargest = 40;  // 2^-40 and 2^40 times as large

// Everything that is said about a scene 2^k times as large, as it would be if it were not: what is
// a length is divided by 2^k, an area by its square, and so on.
class Numbers {
 public:
  explicit Numbers(int k) : k_(k) {}
  void add(double value, int dimension) { values_.push_back(std::ldexp(value, -k_ * dimension)); }
  void add(const Eigen::Vector3d& value, int dimension) {
    for (const double x : value) add(x, dimension);
  }
  void count(std::uint64_t value) { add(static_cast<double>(value), 0); }
  template <class Pairs>
  void pairs(const Pairs& all) {
    count(all.size());
    for (const auto& [fixed, moving] : all) {
      count(fixed);
      count(moving);
    }
  }
  [[nodiscard]] const std::vector<double>& all() const { return values_; }

 private:
  int k_;
  std::vector<double> values_;
};

// A ball and a block 2^k times as large.
class Scaled {
 public:
  explicit Scaled(int k)
      : unit_(std::ldexp(1.0, k)),
        numbers_(k),
        fixed_(tree(icosphere(1, 1))),
        moving_(tree(box({-0.75, -0.5, -0.625}, {0.75, 0.5, 0.625}))) {
    for (const SphereTree* tree : {&fixed_, &moving_}) {
      for (const double x : voxels_of(*tree).lattice.corner) numbers_.add(x, 1);
      for (const std::uint64_t code : voxels_of(*tree).octree.codes(0)) numbers_.count(code);
      for (const PackedNormal normal : voxels_of(*tree).normals) numbers_.count(normal.word());
      numbers_.add(tree->bounding_radius(), 1);
    }
  }

  // All that there is to ask at some poses.
  const std::vector<double>& ask_all() {
    for (const SpherePolicy policy : kSpherePolicies) {
      for (const char* target : {"", "scalar"}) {
        QueryOptions options = options_of(policy, target);
        options.frontier_pairs = 1 << 10;
        Query query(fixed_, moving_, options);
        ReferenceQuery reference(fixed_, moving_, policy);
        ContactManifold points(fixed_, moving_, policy, {8, 64, 2});
        for (int i = 0; i < samples(2); ++i) {
          Random random(static_cast<std::uint64_t>(i));
          const Eigen::Matrix3d rotation = random.rotation();
          const Eigen::Vector3d out = random.direction();
          for (const double distance : {1.25, 2.5}) {  // where they meet, and where they do not
            const Eigen::Isometry3d pose = pose_of(rotation, unit_ * distance * out);
            leaves(ask(query, pose));
            const FoundPairs published = ask(reference, pose);
            leaves(published);
            leaf_pairs(query, points, pose);
            triangles(query, pose);
          }
        }
      }
    }
    return numbers_.all();
  }

 private:
  [[nodiscard]] SphereTree tree(TriangleMesh mesh) const {
    for (Eigen::Vector3d& vertex : mesh.vertices) vertex *= unit_;
    return tree_with_triangles(mesh, 0.19 * unit_);
  }

  void leaves(const FoundPairs& answer) {
    numbers_.pairs(answer.leaf_pairs);
    numbers_.count(answer.result.sphere_tests);
    numbers_.add(answer.result.pad, 1);
    numbers_.add(answer.result.resolution, 1);
  }

  void gap(const DistanceInterval& gap) {
    numbers_.add(gap.lower, 1);
    numbers_.add(gap.upper, 1);
  }

  void leaf_pairs(Query& query, ContactManifold& points, const Eigen::Isometry3d& pose) {
    numbers_.count(query.contacts(pose, points).leaf_pairs);
    for (const Contact& point : points.points()) {
      numbers_.add(point.position, 1);
      numbers_.add(point.normal, 0);
      numbers_.add(point.depth, 1);
      numbers_.add(point.weight, 2);
    }
    const ContactSums& sums = points.sums();
    numbers_.count(sums.pairs);
    numbers_.add(sums.about, 1);
    numbers_.add(sums.weight, 2);
    numbers_.add(sums.pressure.force, 2);
    numbers_.add(sums.pressure.torque, 3);
    numbers_.add(sums.spring.force, 3);
    numbers_.add(sums.spring.torque, 4);
    const ContactRates& rates = points.rates();
    numbers_.add(rates.lever, 1);
    numbers_.add(rates.weight, 1);
    numbers_.add(rates.spring_torque, 3);
  }

  void triangles(Query& query, const Eigen::Isometry3d& pose) {
    std::vector<TrianglePair> pairs(1 << 12);
    const TrianglePairsResult exact = query.triangle_pairs(pose, pairs);
    EXPECT_FALSE(exact.truncated);
    pairs.resize(exact.triangle_pairs);
    numbers_.pairs(pairs);
    numbers_.count(exact.sphere_tests);
    numbers_.count(static_cast<std::uint64_t>(query.intersects(pose).answer));
    for (const double tolerance : {0.0, 0.125}) {
      const DistanceResult found = query.distance(pose, tolerance * unit_);
      gap(found.distance);
      numbers_.count(found.sphere_tests);
    }
    Budget budget;
    budget.tests = 300;
    const QueryResult part = query.leaf_pairs(pose, std::span<LeafPair>(), budget);
    numbers_.count(static_cast<std::uint64_t>(part.level));
    gap(*part.distance);
  }

  double unit_;
  Numbers numbers_;
  SphereTree fixed_, moving_;
};

TEST(Scale, PowersOfTwoChangeLengthsExactlyAndNothingElse) {
  StabilityCase wrong("scale", "scenes 2^-40 to 2^40 times as large",
                      "numbers that are not scaled exactly");
  Scaled plain(0);
  const std::vector<double> expected = plain.ask_all();
  EXPECT_GT(expected.size(), 5'000u);
  for (int k = -kLargest; k <= kLargest; ++k) {
    Scaled scaled(k);
    const std::vector<double>& found = scaled.ask_all();
    ASSERT_EQ(found.size(), expected.size()) << "2^" << k;
    std::size_t differing = 0;
    for (std::size_t i = 0; i < found.size(); ++i) differing += found[i] != expected[i] ? 1U : 0U;
    wrong.samples_of(found.size(), static_cast<double>(differing), 0, "2^" + std::to_string(k));
  }
}

}  // namespace
}  // namespace ist::test
