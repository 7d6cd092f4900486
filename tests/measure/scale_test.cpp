#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ist/measure/first_contact.h"
#include "ist/measure/penetration.h"
#include "ist/measure/signed_distance.h"
#include "measure/body_pair.h"
#include "query/query_cases.h"
#include "support/shapes.h"

// The measures at every promised extent, 1e-12 to 1e15, and of bodies that are very thin. The
// oracles are closed forms, and the same question at the extent 1.
namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;

TriangleMesh scaled_mesh(TriangleMesh mesh, double by) {
  for (Vector& v : mesh.vertices) v *= by;
  return mesh;
}

TriangleMesh centred_cube(double edge) {
  return box(Vector::Constant(-0.5 * edge), Vector::Constant(0.5 * edge));
}

// The signed distance from an axis-aligned box, by its closed form.
double distance_to_box(const Vector& low, const Vector& high, const Vector& p) {
  const Vector beyond = (low - p).cwiseMax(p - high);
  const double inside = beyond.maxCoeff();
  return inside <= 0 ? inside : beyond.cwiseMax(0).stableNorm();
}

class Scale : public ::testing::TestWithParam<double> {
 protected:
  const double scale_ = GetParam();
};

TEST_P(Scale, SignedDistance_IsTheOneAtExtentOneTimesTheScale) {
  Random random(71);
  for (const TriangleMesh& mesh : {icosphere(3, 0.5), torus(0.35, 0.15, 60, 30),
                                   cylinder(100, 0.01, 1.0), box({0, 0, 0}, {1, 1e-3, 1e-6})}) {
    std::vector<Vector> points, there;
    for (int k = 0; k < 200; ++k) {
      const Vector& at = mesh.vertices[random.below(mesh.vertices.size())];
      points.push_back(at + std::pow(2.0, -random.uniform(0, 30)) * random.direction());
      points.push_back(0.5 * random.uniform(0, 1) * random.direction());
    }
    // No point is farther than 1e15.
    std::erase_if(points, [](const Vector& p) { return p.cwiseAbs().maxCoeff() > 1; });
    for (const Vector& p : points) there.push_back(scale_ * p);
    const SphereTree one = build_tree(mesh, {.voxel_size = 0.05});
    const SphereTree other = build_tree(scaled_mesh(mesh, scale_), {.voxel_size = 0.05 * scale_});
    const auto truth = signed_distance(one, points, HUGE_VAL);
    const auto found = signed_distance(other, there, HUGE_VAL);
    int exponent = 0;
    const bool is_exact = std::frexp(scale_, &exponent) == 0.5;
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_TRUE(found[i].is_signed) << scale_;
      if (is_exact) {
        ASSERT_EQ(found[i].distance, scale_ * truth[i].distance) << points[i].transpose();
        ASSERT_EQ(found[i].triangle, truth[i].triangle);
      } else {
        ASSERT_NEAR(found[i].distance / scale_, truth[i].distance, 1e-14) << points[i].transpose();
      }
    }
  }
}

// A side that is thinner than 1e-11 of its length counts as its edges, half of its width away. So
// no bar here is as thin.
TEST_P(Scale, SignedDistance_OfThinPlatesAndBarsIsTheirClosedForm) {
  Random random(73);
  for (const double thin : {1e-3, 1e-6, 1e-9, 1e-12}) {
    const double wide = std::max(thin, 1e-9);
    for (const Vector& size : {Vector(1, 1, thin), Vector(1, wide, wide), Vector(1, 1e-2, thin)}) {
      const Vector high = scale_ * size;
      const SphereTree tree = build_tree(box({0, 0, 0}, high), {.voxel_size = 0.1 * scale_});
      std::vector<Vector> points;
      for (int k = 0; k < 200; ++k) {
        const Vector on = high.cwiseProduct(
            Vector(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)));
        points.push_back(on);
        const double way = k % 2 == 0 ? scale_ * random.uniform(0, 1) : 3 * high[2];
        const Vector off = on + way * random.direction();
        if (off.cwiseAbs().maxCoeff() <= 1e15) points.push_back(off);
      }
      const double doubt = scale_ * (1e-13 + (thin < 1e-11 ? 0.5 * thin : 0));
      const auto found = signed_distance(tree, points, HUGE_VAL);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const double truth = distance_to_box({0, 0, 0}, high, points[i]);
        ASSERT_NEAR(found[i].distance, truth, doubt)
            << scale_ << ' ' << size.transpose() << " at " << (points[i] / scale_).transpose();
      }
    }
  }
}

TEST_P(Scale, Penetration_OfCubesIsExact) {
  BodyPair pair(centred_cube(scale_), centred_cube(scale_), 0.05 * scale_);
  for (const Vector& way : {Vector(0.75, 0.1, 0.2), Vector(0.6, 0.7, 0.75), Vector(0, 0, 0.75)}) {
    const Penetration found = penetration(pair.query, place(scale_ * way), 1e-5 * scale_);
    EXPECT_TRUE(found.complete);
    EXPECT_LE(found.lower / scale_, 0.25) << way.transpose();
    EXPECT_GE(found.upper / scale_, 0.25) << way.transpose();
    EXPECT_LE((found.upper - found.lower) / scale_, 1e-5 * (1 + 1e-9));
  }
}

TEST_P(Scale, DistanceAndTouch_OfCubesAreExact) {
  BodyPair pair(centred_cube(scale_), centred_cube(scale_), 0.05 * scale_);
  for (const double gap : {0.5, 1e-3, 1e-6}) {
    const DistanceResult apart =
        pair.query.distance(place(scale_ * Vector(1 + gap, 0.2, 0.1)), 1e-7 * scale_);
    EXPECT_LE(apart.distance.lower / scale_, gap + 1e-12);
    EXPECT_GE(apart.distance.upper / scale_, gap - 1e-12);
    EXPECT_LE((apart.distance.upper - apart.distance.lower) / scale_, 1e-6);
    EXPECT_FALSE(pair.meet(place(scale_ * Vector(1 + gap, 0.2, 0.1))));
    EXPECT_TRUE(pair.meet(place(scale_ * Vector(1 - gap, 0.2, 0.1))));
  }
}

TEST_P(Scale, FirstContact_OfCubesIsWhereTheirFacesMeet) {
  const double edge = scale_ < 1 ? scale_ : 0.25 * scale_;
  BodyPair pair(centred_cube(edge), centred_cube(edge), 0.05 * edge);
  const FirstContact found = first_contact(pair.query, place(edge * Vector(0.3, 0.2, 3)),
                                           place(edge * Vector(0.3, 0.2, -1)), 1e-5 * edge);
  EXPECT_EQ(found.status, FirstContact::Status::kContact) << to_string(found.status);
  EXPECT_LE(found.lower, 0.5);
  EXPECT_GE(found.upper, 0.5);
  EXPECT_LE(found.upper - found.lower, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(PowersOfTen, Scale,
                         ::testing::Values(1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-3, 1e3,
                                           1e6, 1e9, 1e10, 1e12, 1e13, 1e15));
INSTANTIATE_TEST_SUITE_P(PowersOfTwo, Scale,
                         ::testing::Values(0x1p-38, 0x1p-33, 0x1p-28, 0x1p-23, 0x1p-7, 0x1p14,
                                           0x1p33, 0x1p41, 0x1p49));

}  // namespace
}  // namespace ist::test
