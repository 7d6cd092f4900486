// What a budget leaves of the contacts of a world.

#include <gtest/gtest.h>

#include <vector>

#include "capi/c_bodies.h"
#include "ist/capi/ist_world.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr std::uint32_t kBodies = 30;
constexpr std::size_t kPairRoom = 2 * kBodies;

// Balls in a row, each in the next.
class CWorldBudget : public ::testing::Test {
 protected:
  CWorldBudget() {
    auto options = sized<ist_world_options>();
    auto query = sized<ist_query_options>();
    query.frontier_pairs = 1 << 10;
    options.query = &query;
    EXPECT_EQ(name(ist_world_create(&options, &world_)), "ok") << ist_last_error_message();
    ist_tree* tree = c_tree(icosphere(5, 1), 0.05);
    for (std::uint32_t k = 0; k < kBodies; ++k) {
      std::uint32_t body = 0;
      EXPECT_EQ(name(ist_world_add(world_, tree, c_shift(1.9 * k, 0, 0).data(), nullptr, &body)),
                "ok");
    }
    EXPECT_EQ(name(ist_tree_free(tree)), "ok");
  }
  ~CWorldBudget() override { EXPECT_EQ(name(ist_world_free(world_)), "ok"); }

  ist_status ask(std::int32_t what, const ist_budget* budget) {
    auto question = sized<ist_world_question>();
    question.ask = what;
    return ist_world_ask(world_, &question, budget, pairs_.data(), kPairRoom, &result_);
  }
  void ask_contacts(const ist_budget* budget) {
    ASSERT_EQ(name(ask(IST_ASK_CONTACTS, budget)), "ok");
    ASSERT_EQ(result_.written, kBodies - 1);
  }
  // The contacts of the first two bodies.
  ist_status get_contacts() {
    sums_ = sized<ist_contact_sums>();
    return ist_world_get_contacts(world_, 0, 1, nullptr, 0, &sums_, &count_);
  }

  ist_world* world_ = nullptr;
  std::vector<ist_world_pair> pairs_ = std::vector<ist_world_pair>(kPairRoom);
  ist_world_result result_ = sized<ist_world_result>();
  ist_contact_sums sums_ = sized<ist_contact_sums>();
  std::uint64_t count_ = 0;
};

TEST_F(CWorldBudget, ARowTellsWhereABudgetEndedItsContacts) {
  ASSERT_EQ(name(ist_world_reserve(world_, IST_ALL_PAIRS)), "ok");
  ask_contacts(nullptr);
  ASSERT_EQ(name(get_contacts()), "ok");
  EXPECT_EQ(pairs_[0].complete, 1);
  const ist_contact_sums whole = sums_;
  const auto half = sized<ist_budget>({0, pairs_[0].sphere_tests / 2, 0});
  ask_contacts(&half);
  ASSERT_EQ(name(get_contacts()), "ok");
  EXPECT_EQ(pairs_[0].complete, 0);
  EXPECT_LT(sums_.pairs, whole.pairs);
}

}  // namespace
}  // namespace ist::test
