// The kernels that add up contacts: each vector form against the scalar one, which specifies it,
// and the scalar form by hand.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "ist/tree/tree_parts.h"
#include "simd/contact_lanes.h"
#include "simd/guarded.h"
#include "simd/plan_cases.h"
#include "simd/targets.h"
#include "support/effort.h"

namespace ist::test {
namespace {

class ContactKernels : public ::testing::TestWithParam<std::string> {
 protected:
  // Both go through a last step in calls of at most `most` tests. Returns how many pairs weigh.
  std::uint64_t expect_same(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                            const ContactRule& rule, std::uint64_t most) {
    std::uint64_t counted = 0;
    for (const Measured measured : {Measured::kNothing, Measured::kUpper, Measured::kBoth}) {
      TermsRecorder wanted_terms, made_terms;
      wanted_->clear();
      made_->clear();
      wanted_->rule = made_->rule = rule;
      wanted_->stream = &wanted_terms;
      made_->stream = &made_terms;
      SearchCursor wanted_cursor, made_cursor;
      DistanceBounds wanted_bounds, made_bounds;
      Advanced made;
      do {
        const Advanced wanted = advance_contacts_scalar(step, pose, in, wanted_cursor, *wanted_,
                                                        *scratch_, most, measured, wanted_bounds);
        made = kernels_.advance_contacts(step, pose, in, made_cursor, *made_, *scratch_, most,
                                         measured, made_bounds);
        EXPECT_EQ(made.tests, wanted.tests);
        EXPECT_LE(made.tests, most);
        EXPECT_FALSE(made.full);
        EXPECT_EQ(made_cursor, wanted_cursor);
        EXPECT_EQ(made_bounds.lower, wanted_bounds.lower);
        EXPECT_EQ(made_bounds.upper, wanted_bounds.upper);
      } while (!HasFailure() && made.tests > 0 && made_cursor.group < in.group_count);
      add_contacts_scalar(step, pose, *wanted_);
      kernels_.add_contacts(step, pose, *made_);
      EXPECT_TRUE(same(made_->totals, wanted_->totals));
      EXPECT_TRUE(made_terms.is(wanted_terms));
      EXPECT_EQ(made_terms.fixed.size(), made_->totals.pairs);
      counted = made_->totals.counted;
    }
    return counted;
  }

  const Kernels& kernels_ = select_kernels(GetParam());
  const std::unique_ptr<SearchScratch> scratch_ = std::make_unique<SearchScratch>();
  const std::unique_ptr<ContactAdder> wanted_ = std::make_unique<ContactAdder>(),
                                      made_ = std::make_unique<ContactAdder>();
};

INSTANTIATE_TEST_SUITE_P(Targets, ContactKernels, ::testing::ValuesIn(vector_targets()), name_of);

// From the roots down by the scalar form, and then the last step.
TEST_P(ContactKernels, AreTheScalarFormAfterASearch) {
  std::uint64_t counted = 0;
  Random random(1);
  for (const auto& search : all_plans()) {
    for (const double margin : {2.0, 0.25, 0.0}) {
      const SearchPose pose = random_pose(random, 0.02);
      auto in = std::make_unique<GuardedFrontier>(1, 0);
      in->append(0, std::vector<std::uint32_t>{0});
      for (std::size_t step = 0; step + 1 < search->plan.steps().size(); ++step) {
        auto out = std::make_unique<GuardedFrontier>(search->plan.most_pairs(step), 0);
        SearchCursor cursor;
        DistanceBounds none;
        advance_scalar(search->plan.steps()[step], pose, *in, cursor, *out, *scratch_,
                       ~std::uint64_t{0}, Measured::kNothing, none);
        in = std::move(out);
      }
      SCOPED_TRACE(std::string(to_string(search->policy)));
      for (const std::uint64_t most : {~std::uint64_t{0}, std::uint64_t{500}}) {
        counted +=
            expect_same(search->plan.steps().back(), pose, *in, rule_of(*search, margin), most);
        if (HasFailure()) return;
      }
    }
  }
  EXPECT_GT(counted, 10'000u);
}

// Rows of any length, and longer than a batch; all overlap, by pads.
TEST_P(ContactKernels, AreTheScalarFormForGroupsOfAnyLength) {
  std::uint64_t counted = 0;
  std::size_t longest = 0;
  Random random(2);
  for (const auto& search : all_plans()) {
    const PlannedSearch::Names& names = search->names.back();
    GuardedFrontier in(1 << 14, 0);
    for (std::size_t length = 1; length < 2 * names.moving.size(); length += 1 + length / 3) {
      const std::size_t count = std::min(length, names.moving.size());
      const auto first = names.moving.begin() +
                         static_cast<std::ptrdiff_t>(random.below(names.moving.size() - count + 1));
      in.append(names.fixed[random.below(names.fixed.size())],
                std::vector<std::uint32_t>(first, first + static_cast<std::ptrdiff_t>(count)));
      longest = std::max(longest, count);
    }
    SearchPose pose = random_pose(random, 0);
    for (const float pad : {0.1F, std::numeric_limits<float>::infinity()}) {
      pose.leaf = pose.inner = {pad, pad, pad};
      SCOPED_TRACE(std::string(to_string(search->policy)));
      counted += expect_same(search->plan.steps().back(), pose, in, rule_of(*search, 2),
                             ~std::uint64_t{0});
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(longest, 3u * kPieceNodes);
  EXPECT_GT(counted, 40'000u);
}

// Lanes that hold any number, also infinities and NaN.
TEST_P(ContactKernels, AreTheScalarFormForAnyBits) {
  Random random(3);
  std::vector<PackedNormal> normals;
  for (int i = 0; i < 4096; ++i) {
    normals.push_back(
        PackedNormal::from_word(static_cast<std::uint32_t>(random.below(1ULL << 32))));
  }
  SearchStep step{};
  step.moving.descends = true;
  step.moving_normals = normals.data();
  const float odd[] = {0,
                       -0.0F,
                       1e-45F,
                       3e38F,
                       std::numeric_limits<float>::infinity(),
                       -std::numeric_limits<float>::infinity(),
                       std::numeric_limits<float>::quiet_NaN()};
  std::uint64_t counted = 0;
  for (int round = 0; round < samples(60); ++round) {
    const SearchPose pose = random_pose(random, 0);
    ContactAdder& adder = *wanted_;
    adder.clear();
    adder.rule = {0.3F, 2, 0.01F, -2, 3, 1.0F / 3, 0, 4, 0.5F};
    if (round % 2 == 0) adder.rule.fade_from = 1, adder.rule.per_fade = 0;
    ContactLanes& lanes = adder.lanes;
    lanes.count = random.below(ContactLanes::kSize - 15);
    for (std::size_t i = 0; i < lanes.count; ++i) {
      for (float* lane : {lanes.share, lanes.fixed_x, lanes.fixed_y, lanes.fixed_z, lanes.moving_x,
                          lanes.moving_y, lanes.moving_z}) {
        lane[i] = random.below(20) == 0 ? odd[random.below(std::size(odd))]
                                        : static_cast<float>(random.uniform(-1, 1));
      }
      lanes.fixed_normal[i] = normals[random.below(normals.size())].word();
      lanes.fixed[i] = static_cast<std::uint32_t>(i);
      lanes.moving[i] = static_cast<std::uint32_t>(random.below(normals.size()));
    }
    *made_ = adder;
    add_contacts_scalar(step, pose, *wanted_);
    kernels_.add_contacts(step, pose, *made_);
    ASSERT_TRUE(same(made_->totals, wanted_->totals)) << round;
    counted += made_->totals.counted;
  }
  EXPECT_GT(counted, samples(std::uint64_t{5'000}));
}

// Every term as great as it can be, in one direction: in 32 bits there is room for no third more.
TEST_P(ContactKernels, DoNotOverflow) {
  const double diagonal = std::sqrt(0.5);
  const std::vector<PackedNormal> normals{PackedNormal({-diagonal, -diagonal, 0}, 1)};
  SearchStep step{};
  step.moving.descends = true;
  step.moving_normals = normals.data();
  SearchPose pose{};
  pose.rotation[0] = pose.rotation[4] = pose.rotation[8] = 1;
  made_->clear();
  made_->rule = {1, 1, 1, -2, 3, 1.0F / 3, 1, 0, 10};
  ContactLanes& lanes = made_->lanes;
  lanes.count = 3 * kContactBatch;
  for (std::size_t i = 0; i < lanes.count; ++i) {
    lanes.share[i] = 100;
    lanes.fixed_x[i] = 50;
    lanes.fixed_y[i] = -40;
    lanes.fixed_z[i] = 0;
    lanes.moving_x[i] = 20;
    lanes.moving_y[i] = -20;
    lanes.moving_z[i] = 0;
    lanes.fixed_normal[i] = PackedNormal({diagonal, diagonal, 0}, 1).word();
    lanes.moving[i] = 0;
  }
  kernels_.add_contacts(step, pose, *made_);
  const ContactTotals& totals = made_->totals;
  EXPECT_EQ(totals.counted, 3 * kContactBatch);
  EXPECT_EQ(totals.sum[kWeightSum], std::int64_t{3 * kContactBatch} << 21);
  const double most = 3 * kContactBatch * std::sqrt(2.0) * kContactUnit;
  for (const std::size_t place : {kTorqueSum + 2, kSpringTorqueSum + 2}) {
    EXPECT_NEAR(static_cast<double>(totals.sum[place]), most, 1e-3 * most);
  }
  EXPECT_GT(most / 3 * 1.5, 0x1p31);
  EXPECT_LT(most / 3, 0x1p31);
}

// The scalar form by hand: two leaves that face each other along z, `depth` deep.
PairTerms facing(double depth, const ContactRule& rule, float share = 1) {
  return pair_terms(rule, share, {3, 0, 0}, {3, 0, static_cast<float>(-depth)},
                    unpack_normal(PackedNormal({0, 0, 1}, 1).word()),
                    unpack_normal(PackedNormal({0, 0, -1}, 2).word()));
}

TEST(PairTerms, AreWeightDepthPositionAndForce) {
  const ContactRule rule{1, 1, 1, -2, 3, 1.0F / 3, 1, 0, 0.5F / 4};
  const PairTerms terms = facing(0.5, rule, 0.5F);
  // The moving normal is half as long as coherent: the mean of 1 and 128/255.
  const double mean = 0.5 * (1 + 128.0 / 255);
  EXPECT_NEAR(terms.weight, 0.5 * mean * kContactUnit, 1);
  EXPECT_FLOAT_EQ(terms.depth, 2.5F);
  EXPECT_FLOAT_EQ(terms.position.x, 3.0F / 4);
  EXPECT_FLOAT_EQ(terms.position.z, -0.25F / 4);
  EXPECT_FLOAT_EQ(terms.force.z, terms.weight);
  EXPECT_EQ(facing(-3, rule).depth, 0);
  EXPECT_EQ(facing(2, rule).depth, 3);
  EXPECT_EQ(facing(0.5, rule, 0).weight, 0);
  EXPECT_EQ(facing(0.5, rule, -1).weight, 0);
}

// With a margin below 2 the weight grows from 0.
TEST(PairTerms, BeginToWeighWithNothing) {
  const SphereTree& tree = all_plans()[0]->fixed;
  const double size = tree.voxel_size();
  const auto weight_at = [&](double above_least, double least) {
    const ContactRule rule = contact_rule(ContactScale(tree, tree, -least), 10 * size);
    return facing((least + above_least) * size, rule).weight / (0.5 * kContactUnit);
  };
  const double whole = 1 + 128.0 / 255;
  EXPECT_EQ(weight_at(0, -0.25), 0);
  EXPECT_NEAR(weight_at(0.05, -0.25), 0.2 * whole, 1e-5);
  EXPECT_NEAR(weight_at(0.125, -0.25), 0.5 * whole, 1e-5);
  EXPECT_NEAR(weight_at(0.5, -0.25), whole, 1e-6);
  EXPECT_NEAR(weight_at(0.05, -2), whole, 1e-6);
}

// Against the definition in double, for packed words.
TEST(UnpackNormal, IsThatOfPackedNormal) {
  Random random(4);
  for (int i = 0; i < samples(100'000); ++i) {
    const auto part = [&](std::size_t values) {
      return static_cast<std::uint32_t>(random.below(values));
    };
    const std::uint32_t word = part(4095) << 20 | part(4095) << 8 | part(256);
    const PackedNormal packed = PackedNormal::from_word(word);
    const Eigen::Vector3d wanted = packed.coherence() * packed.direction();
    const FloatVector made = unpack_normal(word);
    ASSERT_LE((Eigen::Vector3d(made.x, made.y, made.z) - wanted).norm(), 0x1p-22) << word;
  }
}

TEST(ToFixedPoint, RoundsToTheNearestAndTiesToEven) {
  for (const float x :
       {0.0F, 0.5F, 1.5F, -0.5F, -1.5F, 2.5F, 2097151.5F, -2097152.0F, 2965820.8F}) {
    EXPECT_EQ(to_fixed_point(x), static_cast<std::int32_t>(std::nearbyint(x))) << x;
  }
}

}  // namespace
}  // namespace ist::test
