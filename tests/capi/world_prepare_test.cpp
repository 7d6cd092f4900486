// The preparation of a world that its caller follows, and what a budget leaves of contacts.

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "ist/capi/ist_world.h"
#include "listener.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr std::uint32_t kBodies = 30;
constexpr std::size_t kPairRoom = 2 * kBodies;

// Balls in a row, each in the next.
class CWorldPrepare : public ::testing::Test {
 protected:
  CWorldPrepare() {
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
  ~CWorldPrepare() override { EXPECT_EQ(name(ist_world_free(world_)), "ok"); }

  std::uint64_t bytes() {
    auto info = sized<ist_world_info>();
    EXPECT_EQ(name(ist_world_get_info(world_, &info)), "ok");
    return info.bytes;
  }
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

TEST_F(CWorldPrepare, IsFollowedAndEndsWhereTheCallerSaysSo) {
  IST_SLOW();
  const FrequentReports frequent;
  const ist_body_pair first[] = {{0, 1}};
  ASSERT_EQ(name(ist_world_prepare(world_, first, 1, nullptr)), "ok");
  ask_contacts(nullptr);
  ASSERT_EQ(name(get_contacts()), "ok");
  const std::uint64_t before = bytes(), contacts = count_;
  const ist_contact_sums sums = sums_;
  ASSERT_GT(contacts, 0u);

  Listener listener;
  const auto progress = sized<ist_progress>({0, Listener::hear, &listener});
  const auto prepare = [&] { return name(ist_world_prepare(world_, nullptr, 0, &progress)); };
  for (const int at : {1, 2, 3}) {
    listener = {.stop_at = at};
    EXPECT_EQ(prepare(), "cancelled");
    EXPECT_EQ(listener.reports, at);
    // The world is as it was, the contacts of its last answer too.
    EXPECT_EQ(bytes(), before);
    EXPECT_EQ(name(get_contacts()), "ok");
    EXPECT_EQ(count_, contacts);
    EXPECT_EQ(std::memcmp(&sums_, &sums, sizeof sums), 0);
    ASSERT_EQ(name(ask(IST_ASK_INTERSECTS, nullptr)), "ok");
    EXPECT_EQ(pairs_[0].status, IST_OK);
    EXPECT_EQ(pairs_[1].status, IST_NOT_PREPARED);
  }
  EXPECT_NE(std::string(ist_last_error_message()).find("ist_world_prepare: progress"),
            std::string::npos);

  listener = {};
  std::uint64_t needed = 0;
  ASSERT_EQ(name(ist_world_bytes_needed(world_, nullptr, 0, &needed)), "ok");
  EXPECT_EQ(prepare(), "ok");
  EXPECT_GE(listener.reports, 4) << "the call is too short";
  EXPECT_GT(listener.last, 0.1);
  EXPECT_EQ(bytes(), needed);
  EXPECT_EQ(name(get_contacts()), "not-prepared");
  ask_contacts(nullptr);
  EXPECT_EQ(result_.complete, 1);
}

TEST_F(CWorldPrepare, TellsItsFollowerOfItsErrors) {
  Listener listener;
  auto progress = sized<ist_progress>({0, Listener::hear, &listener});
  const ist_body_pair wrong[] = {{0, kBodies}};
  EXPECT_EQ(name(ist_world_prepare(world_, wrong, 1, &progress)), "argument-invalid");
  EXPECT_NE(std::string(ist_last_error_message()).find("body 30"), std::string::npos);
  const int reports = listener.reports;
  EXPECT_GE(reports, 1);
  EXPECT_EQ(name(ist_world_prepare(world_, nullptr, 2, &progress)), "null-argument");
  EXPECT_EQ(name(ist_world_prepare(nullptr, wrong, 1, &progress)), "null-argument");
  progress.struct_size = 7;
  EXPECT_EQ(name(ist_world_prepare(world_, wrong, 1, &progress)), "struct-size");
  EXPECT_EQ(listener.reports, reports);
}

TEST_F(CWorldPrepare, ARowTellsWhereABudgetEndedItsContacts) {
  const ist_body_pair first[] = {{0, 1}};
  ASSERT_EQ(name(ist_world_prepare(world_, first, 1, nullptr)), "ok");
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
