#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "ist/base/pose.h"
#include "query/scenes.h"
#include "stability/hard_pair.h"
#include "support/effort.h"
#include "support/rigid_pose.h"
#include "support/stability.h"

namespace ist::test {
namespace {

constexpr double kUnit = 0x1p-53;
// What one composition turns and moves a pose by, as is documented with compose_rigid.
constexpr double kTurn = 20 * kUnit, kShift = 8 * kUnit;

// A motion in numbers of 320 bits, some 30 digits more than 10^7 compositions lose.
struct LongMotion {
  std::array<std::array<mpf_class, 4>, 3> rows;

  explicit LongMotion(const Eigen::Isometry3d& pose) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(j);
        rows[i][j] = mpf_class(pose.matrix()(row, column), 320);
      }
    }
  }
  // This after `first`.
  [[nodiscard]] LongMotion after(const LongMotion& first) const {
    LongMotion product(Eigen::Isometry3d::Identity());
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        product.rows[i][j] = j == 3 ? rows[i][3] : mpf_class(0, 320);
        for (std::size_t k = 0; k < 3; ++k) product.rows[i][j] += rows[i][k] * first.rows[k][j];
      }
    }
    return product;
  }
  [[nodiscard]] LongMotion times(std::uint64_t count) const {
    LongMotion result(Eigen::Isometry3d::Identity()), square = *this;
    for (; count > 0; count /= 2, square = square.after(square)) {
      if (count % 2 == 1) result = square.after(result);
    }
    return result;
  }
  [[nodiscard]] Eigen::Isometry3d rounded() const {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        pose.matrix()(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            rows[i][j].get_d();
      }
    }
    return pose;
  }
};

// The largest entry of RᵀR - I.
double from_orthonormal(const Eigen::Isometry3d& pose) {
  const Eigen::Matrix3d r = pose.linear();
  return (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

// How far one pose is turned against another, rad; for small angles.
double angle_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const Eigen::Matrix3d turn = a.linear().transpose() * b.linear();
  return (turn - turn.transpose()).norm() / std::sqrt(8.0);
}

// A turn about an axis that is askew, by the angle whose half has the tangent `tangent`.
Eigen::Isometry3d screw(double tangent, const Eigen::Vector3d& step) {
  const Eigen::Quaterniond q =
      Eigen::Quaterniond(1, tangent * 2 / 7, tangent * 3 / 7, tangent * 6 / 7).normalized();
  return project_to_rigid(pose_of(q.toRotationMatrix(), step)).value();
}

// Where the last contact ends at one of two poses that should be one: the pairs in which their
// answers differ are no farther from changing than the pad and what the poses may be apart.
void compare_answers(const Eigen::Isometry3d& composed, const Eigen::Isometry3d& direct,
                     double turn, double shift_by, StabilityCase& pairs) {
  const Scene& scene = solids()[0];
  const double reach =
      scene.moving.bounding_radius() + 3;  // a lever of what is moved out to where they part
  std::size_t differing = 0;
  for (const SpherePolicy policy : {SpherePolicy::kTight, SpherePolicy::kSlab}) {
    Query query(scene.fixed, scene.moving, options_of(policy));
    Random random(3);
    for (int i = 0; i < 12; ++i) {
      const Eigen::Matrix3d rotation = random.rotation();
      const Eigen::Vector3d out = random.direction();
      const auto place = [&](const Eigen::Isometry3d& motion, double x) {
        return compose_rigid(motion, pose_of(rotation, x * out)).value();
      };
      const double last = last_touching(
          1, 3, [&](double x) { return ask(query, place(direct, x)).result.leaf_pairs > 0; });
      for (const double x : {last, std::nextafter(last, 3)}) {
        const FoundPairs a = ask(query, place(composed, x)), b = ask(query, place(direct, x));
        ASSERT_EQ(a.result.status, QueryStatus::kDone);
        const double band = std::max(a.result.pad, b.result.pad) + turn * reach + shift_by;
        std::vector<LeafPair> differ;
        std::set_symmetric_difference(a.leaf_pairs.begin(), a.leaf_pairs.end(),
                                      b.leaf_pairs.begin(), b.leaf_pairs.end(),
                                      std::back_inserter(differ));
        differing += differ.size();
        for (const LeafPair& pair : differ) {
          const double overlap =
              leaf_overlap(scene.fixed, scene.moving, policy,
                           between_frames(place(direct, x), scene.fixed, scene.moving), pair);
          pairs.sample(std::abs(overlap), band);
        }
      }
    }
  }
  EXPECT_GT(differing, 5u);  // or nothing was compared
}

// Ten million small motions, as a servo loop makes them in three hours. With IST_EFFORT=1 it is one
// million.
class LongRun : public ::testing::Test {
 protected:
  const std::uint64_t count_ =
      std::min(samples(std::uint64_t{1'000'000}), std::uint64_t{10'000'000});
};

TEST_F(LongRun, StaysRigidAndWhereItIsGivenDirectly) {
  StabilityCase rigid("long runs", "a pose of up to 1e7 small motions", "largest entry of RtR - I");
  StabilityCase turned("long runs", "its drift from the pose given directly", "rad");
  StabilityCase shifted("long runs", "its drift in place", "mm");
  StabilityCase pairs("long runs", "leaf pairs that differ, from where both answers agree",
                      "mm from a change, of pad and drift");
  // Round and round about the origin, with a step that a turn brings back.
  const Eigen::Isometry3d motion = screw(0x1.3p-12, {3e-5, -2e-5, 1e-5});
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  double farthest = 0;
  for (std::uint64_t i = 1; i <= count_; ++i) {
    pose = *compose_rigid(motion, pose);
    if (i % 1000 != 0) continue;
    farthest = std::max(farthest, pose.translation().norm());
    rigid.sample(from_orthonormal(pose), 1e-9);
  }
  const Eigen::Isometry3d direct =
      project_to_rigid(LongMotion(motion).times(count_).rounded()).value();
  const auto n = static_cast<double>(count_);
  // Between two looks it goes on by less than 1.
  const double length = 2 * farthest + 1;
  turned.sample(angle_between(pose, direct), n * kTurn);
  shifted.sample((pose.translation() - direct.translation()).norm(), n * kShift * length);
  // What was gone is gone back, but for the drift.
  compare_answers(compose_rigid(direct.inverse(), pose).value(),
                  compose_rigid(direct.inverse(), direct).value(), n * kTurn, n * kShift * length,
                  pairs);
}

// Multiplied and never projected it is rigid no more, but far within what a query projects.
TEST_F(LongRun, WithoutProjectionIsStillAPose) {
  StabilityCase rigid("long runs", "small motions multiplied, not projected",
                      "largest entry of RtR - I");
  StabilityCase turned("long runs", "drift of motions multiplied, not projected", "rad");
  const Eigen::Isometry3d motion = screw(0x1.3p-12, {0, 0, 0});
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  for (std::uint64_t i = 0; i < count_; ++i) rotation = motion.linear() * rotation;
  const Eigen::Isometry3d pose = pose_of(rotation, {0, 0, 0});
  const auto n = static_cast<double>(count_);
  rigid.sample(from_orthonormal(pose), n * kTurn);
  const auto projected = project_to_rigid(pose);
  ASSERT_TRUE(projected);
  EXPECT_LE(from_orthonormal(*projected), 1e-15);
  Query query(solids()[0].fixed, solids()[0].moving);
  EXPECT_TRUE(same(ask(query, pose), ask(query, *projected)));
  const Eigen::Isometry3d direct =
      project_to_rigid(LongMotion(motion).times(count_).rounded()).value();
  turned.sample(angle_between(*projected, direct), n * kTurn);
}

}  // namespace
}  // namespace ist::test
