#include "verify/answer_verifier.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ist/query/query.h"
#include "ist/query/reference/reference_query.h"
#include "ist/tree/sphere_tree.h"
#include "query/triangles/triangle_tree.h"
#include "support/effort.h"
#include "support/exact_query.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// Two balls that cross in a ring, one turned.
class Guarantee : public ::testing::TestWithParam<SpherePolicy> {
 protected:
  [[nodiscard]] FoundPairs right_answer() const {
    QueryOptions options;
    options.policy = GetParam();
    Query query(fixed_, moving_, options);
    return ask(query, pose_);
  }
  [[nodiscard]] std::optional<Violation> check(const FoundPairs& answer) const {
    return check_.check(pose_, std::vector{GivenAnswer{answer.result, answer.leaf_pairs}});
  }
  // The answer is wrong, and the check says so in these words.
  void refuses(const FoundPairs& answer, const std::string& words) const {
    const std::optional<Violation> violation = check(answer);
    ASSERT_TRUE(violation) << words;
    EXPECT_NE(violation->detail.find(words), std::string::npos) << violation->detail;
  }

  Random random_{7};
  const TriangleMesh fixed_mesh_ = icosphere(1, 1), moving_mesh_ = icosphere(2, 0.9);
  const SphereTree fixed_ = triangle_tree(fixed_mesh_, 9), moving_ = triangle_tree(moving_mesh_, 7);
  const Eigen::Isometry3d pose_ = pose_of(random_.rotation(), {1.1, 0.4, 0.3});
  const AnswerVerifier check_{fixed_, moving_, GetParam()};
};

INSTANTIATE_TEST_SUITE_P(EachPolicy, Guarantee, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

TEST_P(Guarantee, WhatGoesMissingIsFound) {
  const FoundPairs whole = right_answer();
  ASSERT_GT(whole.leaf_pairs.size(), 50u);
  EXPECT_FALSE(check(whole));
  const ExactBody fixed(fixed_mesh_, fixed_), moving(moving_mesh_, moving_);
  const ExactPair exact(fixed, moving, pose_);
  std::size_t meet = 0, found = 0;
  for (std::size_t i = 0; i < whole.leaf_pairs.size(); ++i) {
    FoundPairs lacking = whole;
    lacking.leaf_pairs.erase(lacking.leaf_pairs.begin() + static_cast<std::ptrdiff_t>(i));
    --lacking.result.leaf_pairs;
    const LeafPair pair = whole.leaf_pairs[i];
    const bool required = must_be_found(exact, GetParam(), pair.fixed, pair.moving);
    meet += required ? 1 : 0;
    if (const std::optional<Violation> violation = check(lacking)) {
      ++found;
      EXPECT_TRUE(required) << violation->detail;
      EXPECT_NE(violation->detail.find(std::to_string(pair.fixed) + " and moving leaf " +
                                       std::to_string(pair.moving) + " is not in"),
                std::string::npos)
          << violation->detail;
    }
  }
  EXPECT_GT(meet, 10u);
  EXPECT_EQ(found, meet);
}

TEST_P(Guarantee, WhatDoesNotBelongIsFound) {
  const FoundPairs right = right_answer();
  const ExactBody fixed(fixed_mesh_, fixed_), moving(moving_mesh_, moving_);
  const ExactPair exact(fixed, moving, pose_);
  std::size_t apart = 0;
  for (int i = 0; i < samples(500); ++i) {
    const LeafPair pair{static_cast<std::uint32_t>(random_.below(fixed_.leaf_count())),
                        static_cast<std::uint32_t>(random_.below(moving_.leaf_count()))};
    FoundPairs more = right;
    const auto at = std::lower_bound(more.leaf_pairs.begin(), more.leaf_pairs.end(), pair);
    if (at != more.leaf_pairs.end() && *at == pair) continue;
    more.leaf_pairs.insert(at, pair);
    ++more.result.leaf_pairs;
    const bool belongs = exact.bounds_meet(GetParam(), pair.fixed, pair.moving, right.result.pad);
    apart += belongs ? 0 : 1;
    if (belongs) {
      EXPECT_FALSE(check(more));
    } else {
      refuses(more, "is in the answer, but its bounds are");
    }
  }
  EXPECT_GT(apart, samples(std::size_t{100}));
}

TEST_P(Guarantee, TheListIsWhatItSays) {
  const FoundPairs right = right_answer();
  FoundPairs wrong = right;
  ++wrong.result.leaf_pairs;
  refuses(wrong, "it counts");
  wrong = right;
  std::swap(wrong.leaf_pairs[3], wrong.leaf_pairs[4]);
  refuses(wrong, "out of order, or twice");
  wrong = right;
  wrong.leaf_pairs[4] = wrong.leaf_pairs[3];
  refuses(wrong, "out of order, or twice");
  wrong = right;
  wrong.leaf_pairs.back().moving = moving_.leaf_count();
  refuses(wrong, "there is no such leaf");
  wrong = right;
  wrong.result.status = QueryStatus::kInvalidPose;
  refuses(wrong, "rigid");
}

// Where the triangles are not known, bounds alone decide.
TEST_P(Guarantee, WhatGoesMissingIsFoundWithoutTrianglesToo) {
  if (is_implicit(GetParam())) return;
  const SphereTree fixed = tree_of(fixed_mesh_, 9), moving = tree_of(moving_mesh_, 7);
  const AnswerVerifier check(fixed, moving, GetParam());
  EXPECT_TRUE(check_.knows_geometry());
  EXPECT_FALSE(check.knows_geometry());
  const FoundPairs whole = right_answer();
  const auto violation_in = [&](const FoundPairs& answer) {
    return check.check(pose_, std::vector{GivenAnswer{whole.result, whole.leaf_pairs},
                                          GivenAnswer{answer.result, answer.leaf_pairs}});
  };
  EXPECT_FALSE(violation_in(whole));
  for (std::size_t i = 0; i < whole.leaf_pairs.size(); ++i) {
    FoundPairs lacking = whole;
    lacking.leaf_pairs.erase(lacking.leaf_pairs.begin() + static_cast<std::ptrdiff_t>(i));
    --lacking.result.leaf_pairs;
    const auto violation = violation_in(lacking);
    ASSERT_TRUE(violation);
    EXPECT_EQ(violation->answer, 1u);
    EXPECT_NE(violation->detail.find("is not in the answer, but its bounds overlap"),
              std::string::npos);
    lacking.result.complete = false;  // then it need not have all
    EXPECT_FALSE(violation_in(lacking));
  }
}

TEST_P(Guarantee, NoFalseAlarm) {
  std::size_t leaf_pairs = 0;
  for (int i = 0; i < samples(60); ++i) {
    SCOPED_TRACE(i);
    const SphereTree a = triangle_tree(random_mesh(random_), random_.uniform(1, 12));
    const SphereTree b = triangle_tree(random_mesh(random_), random_.uniform(1, 12));
    const AnswerVerifier check(a, b, GetParam());
    ReferenceQuery reference(a, b, GetParam());
    QueryOptions options;
    options.policy = GetParam();
    Query query(a, b, options);
    for (int j = 0; j < 10; ++j) {
      // Every other pose puts the bodies on planes that both lattices may share.
      const Eigen::Matrix3d rotation =
          j % 2 == 0 ? random_.rotation() : quarter_turns()[random_.below(24)];
      const Eigen::Vector3d near = random_.point(-3, 3);
      const Eigen::Isometry3d pose =
          pose_of(rotation, j % 2 == 0 ? near : Eigen::Vector3d(near.array().round()));
      const FoundPairs one = ask(reference, pose), other = ask(query, pose);
      const std::vector<GivenAnswer> both{
          {one.result, one.leaf_pairs, published_are_nested(GetParam())},
          {other.result, other.leaf_pairs}};
      const std::optional<Violation> violation = check.check(pose, both);
      EXPECT_FALSE(violation) << violation->answer << ": " << violation->detail;
      leaf_pairs += one.leaf_pairs.size();
    }
  }
  EXPECT_GT(leaf_pairs, samples(std::size_t{300}));
}

// Between lattices that coincide, the published balls of `table` lose pairs of leaves whose own
// balls overlap.
TEST_P(Guarantee, BoundsThatAreNotNestedOweWhatIntersects) {
  ReferenceQuery reference(fixed_, fixed_, GetParam());
  const AnswerVerifier check(fixed_, fixed_, GetParam());
  const bool published_nest = published_are_nested(GetParam());
  int lacking = 0;
  // A pair may be lost only at some poses: at most 100 are asked until one is.
  const auto goes_on = [&](int asked) {
    return asked < samples(100) || (!published_nest && lacking == 0 && asked < 100);
  };
  for (int i = 0; goes_on(i); ++i) {
    const Eigen::Isometry3d pose = pose_of(Eigen::Matrix3d::Identity(), random_.point(-1.5, 1.5));
    const FoundPairs found = ask(reference, pose);
    const auto violation = [&](bool nested) {
      return check.check(pose, std::vector{GivenAnswer{found.result, found.leaf_pairs, nested}});
    };
    EXPECT_FALSE(violation(published_nest));
    lacking += violation(true) ? 1 : 0;
  }
  EXPECT_EQ(lacking > 0, !published_nest);
}

// A rotation that is too long by 4e-6 would put a body far from its mesh's origin elsewhere.
TEST_P(Guarantee, AnswersAreAboutTheProjectedPose) {
  constexpr double kFar = 1e5, kStretch = 4e-6;
  TriangleMesh far = moving_mesh_;
  for (Eigen::Vector3d& vertex : far.vertices) vertex[0] += kFar;
  const SphereTree moving = triangle_tree(far, 7);
  const AnswerVerifier check(fixed_, moving, GetParam());
  QueryOptions options;
  options.policy = GetParam();
  Query query(fixed_, moving, options);
  const Eigen::Isometry3d rigid = pose_ * shift({-kFar, 0, 0});
  Eigen::Isometry3d stretched = rigid;
  stretched.linear() *= 1 + kStretch;
  const auto violation = [&](const Eigen::Isometry3d& answered) {
    const FoundPairs answer = ask(query, answered);
    EXPECT_GT(answer.leaf_pairs.size(), 50u);
    return check.check(stretched, std::vector{GivenAnswer{answer.result, answer.leaf_pairs}});
  };
  EXPECT_FALSE(violation(stretched));
  EXPECT_FALSE(violation(rigid));
  EXPECT_TRUE(violation(rigid * shift({kStretch * kFar, 0, 0})));
}

TEST_P(Guarantee, APoseThatIsRough) {
  std::vector<Eigen::Isometry3d> poses(3, pose_);
  poses[0].linear() *= Eigen::Vector3d(1 + 4e-4, 1, 1 - 4e-4).asDiagonal();
  poses[1].linear() *= 1 + 9e-6;
  poses[2].linear() *= 1 - 9e-6;
  QueryOptions options;
  options.policy = GetParam();
  Query query(fixed_, moving_, options);
  for (const Eigen::Isometry3d& rough : poses) {
    FoundPairs answer = ask(query, rough);
    const auto given = [&answer] {
      return std::vector{GivenAnswer{answer.result, answer.leaf_pairs}};
    };
    EXPECT_FALSE(check_.check(rough, given())) << rough.matrix();
    answer.result.status = QueryStatus::kInvalidPose;
    EXPECT_TRUE(check_.check(rough, given())) << rough.matrix();
  }
}

TEST_P(Guarantee, APoseThatIsNone) {
  std::vector<Eigen::Isometry3d> poses(6, pose_);
  poses[0](0, 0) = std::numeric_limits<double>::quiet_NaN();
  poses[1].linear().col(2) *= -1;
  poses[2].linear() *= 1 + 1.1e-5;
  poses[3](3, 0) = 1e-9;
  poses[4].linear() *= 1 - 1.1e-5;
  poses[5].linear() *= Eigen::Vector3d(1 + 6e-4, 1, 1 - 6e-4).asDiagonal();
  ReferenceQuery query(fixed_, moving_, GetParam());
  for (const Eigen::Isometry3d& none : poses) {
    FoundPairs answer = ask(query, none);
    const auto given = [&answer] {
      return std::vector{GivenAnswer{answer.result, answer.leaf_pairs}};
    };
    EXPECT_FALSE(check_.check(none, given())) << none.matrix();
    answer.result.status = QueryStatus::kDone;
    EXPECT_TRUE(check_.check(none, given())) << none.matrix();
  }
}

}  // namespace
}  // namespace ist::test
