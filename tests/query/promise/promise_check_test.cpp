#include "ist/query/promise/promise_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ist/query/collision_query.h"
#include "ist/query/reference.h"
#include "ist/tree/tree_builder.h"
#include "query/query_cases.h"
#include "support/exact_query.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

SphereTree tree_with_triangles(const TriangleMesh& mesh, double cells) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : mesh.vertices) bounds.extend(vertex);
  BuildOptions options;
  options.voxel_size = bounds.sizes().maxCoeff() / cells;
  options.spheres = SpherePolicy::kSlab;
  options.keep_triangles = true;
  return build_tree(mesh, options);
}

// Two balls that cross in a ring, one turned.
class Promise : public ::testing::TestWithParam<SpherePolicy> {
 protected:
  [[nodiscard]] Answer right_answer() const {
    ReferenceQuery query(fixed_, moving_, GetParam());
    return ask(query, pose_);
  }
  [[nodiscard]] std::optional<Breach> check(const Answer& answer) const {
    return check_.check(pose_, std::vector{GivenAnswer{answer.result, answer.contacts}});
  }
  // The answer is wrong, and the check says so in these words.
  void refuses(const Answer& answer, const std::string& words) const {
    const std::optional<Breach> breach = check(answer);
    ASSERT_TRUE(breach) << words;
    EXPECT_NE(breach->what.find(words), std::string::npos) << breach->what;
  }

  Random random_{7};
  const TriangleMesh fixed_mesh_ = icosphere(1, 1), moving_mesh_ = icosphere(2, 0.9);
  const SphereTree fixed_ = tree_with_triangles(fixed_mesh_, 9),
                   moving_ = tree_with_triangles(moving_mesh_, 7);
  const Eigen::Isometry3d pose_ = pose_of(random_.rotation(), {1.1, 0.4, 0.3});
  const PromiseCheck check_{fixed_, moving_, GetParam()};
};

INSTANTIATE_TEST_SUITE_P(EachPolicy, Promise, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

TEST_P(Promise, WhatGoesMissingIsFound) {
  const Answer whole = right_answer();
  ASSERT_GT(whole.contacts.size(), 50u);
  EXPECT_FALSE(check(whole));
  const ExactBody fixed(fixed_mesh_, fixed_), moving(moving_mesh_, moving_);
  const ExactPair exact(fixed, moving, pose_);
  std::size_t meet = 0, found = 0;
  for (std::size_t i = 0; i < whole.contacts.size(); ++i) {
    Answer lacking = whole;
    lacking.contacts.erase(lacking.contacts.begin() + static_cast<std::ptrdiff_t>(i));
    --lacking.result.contacts;
    const Contact pair = whole.contacts[i];
    const bool geometry_meets = exact.geometry_meets(GetParam(), pair.fixed, pair.moving);
    meet += geometry_meets ? 1 : 0;
    if (const std::optional<Breach> breach = check(lacking)) {
      ++found;
      EXPECT_TRUE(geometry_meets) << breach->what;
      EXPECT_NE(breach->what.find(std::to_string(pair.fixed) + " and moving leaf " +
                                  std::to_string(pair.moving) + " is not in"),
                std::string::npos)
          << breach->what;
    }
  }
  EXPECT_GT(meet, 10u);
  EXPECT_EQ(found, meet);
}

TEST_P(Promise, WhatDoesNotBelongIsFound) {
  const Answer right = right_answer();
  const ExactBody fixed(fixed_mesh_, fixed_), moving(moving_mesh_, moving_);
  const ExactPair exact(fixed, moving, pose_);
  std::size_t apart = 0;
  for (int i = 0; i < 500; ++i) {
    const Contact pair{static_cast<std::uint32_t>(random_.below(fixed_.octree().leaf_count())),
                       static_cast<std::uint32_t>(random_.below(moving_.octree().leaf_count()))};
    Answer more = right;
    const auto at = std::lower_bound(more.contacts.begin(), more.contacts.end(), pair);
    if (at != more.contacts.end() && *at == pair) continue;
    more.contacts.insert(at, pair);
    ++more.result.contacts;
    const bool belongs = exact.bounds_meet(GetParam(), pair.fixed, pair.moving, right.result.pad);
    apart += belongs ? 0 : 1;
    if (belongs) {
      EXPECT_FALSE(check(more));
    } else {
      refuses(more, "is in the answer, but its bounds are");
    }
  }
  EXPECT_GT(apart, 100u);
}

TEST_P(Promise, TheListIsWhatItSays) {
  const Answer right = right_answer();
  Answer wrong = right;
  ++wrong.result.contacts;
  refuses(wrong, "it counts");
  wrong = right;
  std::swap(wrong.contacts[3], wrong.contacts[4]);
  refuses(wrong, "out of order, or twice");
  wrong = right;
  wrong.contacts[4] = wrong.contacts[3];
  refuses(wrong, "out of order, or twice");
  wrong = right;
  wrong.contacts.back().moving = moving_.octree().leaf_count();
  refuses(wrong, "there is no such leaf");
  wrong = right;
  wrong.result.status = QueryStatus::kInvalidPose;
  refuses(wrong, "rigid");
}

// Where what the spheres stand for is not known, answers are held against each other.
TEST_P(Promise, EnginesAreComparedWhereThereAreNoTriangles) {
  if (is_implicit(GetParam())) return;
  const SphereTree fixed = tree_of(fixed_mesh_, 9), moving = tree_of(moving_mesh_, 7);
  const PromiseCheck check(fixed, moving, GetParam());
  EXPECT_TRUE(check_.knows_geometry());
  EXPECT_FALSE(check.knows_geometry());
  ReferenceQuery reference(fixed, moving, GetParam());
  CollisionOptions options;
  options.policy = GetParam();
  CollisionQuery query(fixed, moving, options);
  const Answer one = ask(reference, pose_), other = ask(query, pose_);
  const std::vector<GivenAnswer> both{{one.result, one.contacts}, {other.result, other.contacts}};
  EXPECT_FALSE(check.check(pose_, both));
  std::size_t found = 0;
  for (std::size_t i = 0; i < one.contacts.size(); ++i) {
    Answer lacking = one;
    lacking.contacts.erase(lacking.contacts.begin() + static_cast<std::ptrdiff_t>(i));
    --lacking.result.contacts;
    const GivenAnswer given{lacking.result, lacking.contacts};
    EXPECT_FALSE(check.check(pose_, std::vector{given}));
    if (const auto breach = check.check(pose_, std::vector{given, both[1]})) {
      ++found;
      EXPECT_EQ(breach->answer, 0u);
      EXPECT_NE(breach->what.find("in another engine's answer"), std::string::npos);
    }
  }
  EXPECT_GT(found, one.contacts.size() / 2);
}

TEST_P(Promise, NoFalseAlarm) {
  std::size_t contacts = 0;
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const SphereTree a = tree_with_triangles(random_mesh(random_), random_.uniform(1, 12));
    const SphereTree b = tree_with_triangles(random_mesh(random_), random_.uniform(1, 12));
    const PromiseCheck check(a, b, GetParam());
    ReferenceQuery reference(a, b, GetParam());
    CollisionOptions options;
    options.policy = GetParam();
    CollisionQuery query(a, b, options);
    for (int j = 0; j < 10; ++j) {
      // Every other one on planes that both lattices may share, and far from the origin.
      const Eigen::Matrix3d rotation =
          j % 2 == 0 ? random_.rotation() : quarter_turns()[random_.below(24)];
      const Eigen::Vector3d near = random_.point(-3, 3);
      const Eigen::Isometry3d pose =
          pose_of(rotation, j % 2 == 0 ? near : Eigen::Vector3d(near.array().round()));
      const Answer one = ask(reference, pose), other = ask(query, pose);
      const std::vector<GivenAnswer> both{{one.result, one.contacts},
                                          {other.result, other.contacts}};
      const std::optional<Breach> breach = check.check(pose, both);
      EXPECT_FALSE(breach) << breach->answer << ": " << breach->what;
      contacts += one.contacts.size();
    }
  }
  EXPECT_GT(contacts, 1000u);
}

TEST_P(Promise, APoseThatIsNone) {
  Eigen::Isometry3d none = pose_;
  none.matrix()(0, 0) = std::numeric_limits<double>::quiet_NaN();
  ReferenceQuery query(fixed_, moving_, GetParam());
  Answer answer = ask(query, none);
  const auto given = [&answer] { return std::vector{GivenAnswer{answer.result, answer.contacts}}; };
  EXPECT_FALSE(check_.check(none, given()));
  answer.result.status = QueryStatus::kDone;
  EXPECT_TRUE(check_.check(none, given()));
}

}  // namespace
}  // namespace ist::test
