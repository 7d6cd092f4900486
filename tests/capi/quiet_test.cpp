// Functions marked [real time] in ist_c.h allocate no memory and make no system call, even with
// errors.

#include <gtest/gtest.h>

#include <csignal>
#include <vector>

#include "capi/c_bodies.h"
#include "ist/capi/ist_world.h"
#include "query/quiet/allocations.h"
#include "support/effort.h"
#include "support/shapes.h"
#include "support/system_calls.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

struct Bodies {
  TempDir folder;
  ist_query* query = c_query(c_tree(icosphere(2, 1), 0.15));
  ist_query* freed = c_query(c_tree(icosphere(1, 1), 0.5));
  ist_servo* servo = nullptr;
  ist_world* world = nullptr;
  std::vector<ist_leaf_pair> leaf_pairs = std::vector<ist_leaf_pair>(1 << 12);
  std::vector<ist_contact> contacts = std::vector<ist_contact>(32);
  std::vector<ist_triangle_pair> triangle_pairs = std::vector<ist_triangle_pair>(1 << 12);
  std::vector<ist_near_pair> near_pairs = std::vector<ist_near_pair>(1 << 12);

  Bodies() {
    auto options = sized<ist_servo_options>();
    options.unit = IST_UNIT_MM;
    const std::string file = folder.write("scene.toml", kSmallScene).string();
    EXPECT_EQ(name(ist_servo_open_scene(file.c_str(), &options, &servo)), "ok");
    EXPECT_EQ(name(ist_query_free(freed)), "ok");
    EXPECT_EQ(name(ist_world_create(nullptr, &world)), "ok");
    ist_tree* tree = c_tree(icosphere(2, 1), 0.15);
    for (std::uint32_t i = 0, body = 0; i < 3; ++i) {
      EXPECT_EQ(name(ist_world_add(world, tree, c_shift(1.8 * i, 0, 0).data(), nullptr, &body)),
                "ok");
    }
    EXPECT_EQ(name(ist_tree_free(tree)), "ok");
    EXPECT_EQ(name(ist_world_reserve(world, IST_ALL_PAIRS)), "ok");
  }
  ~Bodies() {
    EXPECT_EQ(name(ist_query_free(query)), "ok");
    EXPECT_EQ(name(ist_servo_free(servo)), "ok");
    EXPECT_EQ(name(ist_world_free(world)), "ok");
  }
};

// Counts of the calls with the expected status and of the others, and of their answers.
struct Asked {
  int as_expected = 0, otherwise = 0;
  std::uint64_t leaf_pairs = 0, contacts = 0, triangle_pairs = 0, near_pairs = 0;
  double force = 0;

  void status(ist_status is, ist_status wanted) noexcept {
    ++(is == wanted ? as_expected : otherwise);
  }
  [[nodiscard]] bool all() const noexcept {
    return otherwise == 0 && as_expected > 1000 && leaf_pairs > 100 && contacts > 100 &&
           triangle_pairs > 100 && near_pairs > 100 && force > 0.1;
  }
};

// Every function of a world that is for real time, at a pose that may be invalid.
void ask_world(Bodies& bodies, const double* at, bool bad, const ist_budget* limits,
               Asked& seen) noexcept {
  ist_world_pair pairs[4];
  auto result = sized<ist_world_result>();
  auto least = sized<ist_least_distance>();
  auto sums = sized<ist_contact_sums>();
  auto info = sized<ist_world_info>();
  std::uint64_t count = 0;
  double pose[16];
  ist_world* world = bodies.world;
  seen.status(ist_world_set_pose(world, 1, at), bad ? IST_POSE_INVALID : IST_OK);
  seen.status(ist_world_get_pose(world, 0, 1, pose), bad ? IST_POSE_INVALID : IST_OK);
  auto question = sized<ist_world_question>();
  question.tolerance = 0.01;
  question.leaf_pairs = bodies.leaf_pairs.data();
  question.leaf_capacity = bodies.leaf_pairs.size();
  question.triangles = bodies.triangle_pairs.data();
  question.triangle_capacity = bodies.triangle_pairs.size();
  for (const int ask : {IST_ASK_NEAR, IST_ASK_INTERSECTS, IST_ASK_LEAF_PAIRS, IST_ASK_DISTANCE,
                        IST_ASK_TRIANGLE_PAIRS}) {
    question.ask = ask;
    seen.status(ist_world_ask(world, &question, limits, pairs, 4, &result), IST_OK);
  }
  question.ask = IST_ASK_CONTACTS;
  seen.status(ist_world_ask(world, &question, nullptr, pairs, 4, &result), IST_OK);
  seen.status(ist_world_get_contacts(world, 0, 1, bodies.contacts.data(), 32, &sums, &count),
              bad ? IST_NOT_PREPARED : IST_OK);
  seen.contacts += count;
  seen.status(ist_world_distance(world, 0.01, limits, &least), IST_OK);
  seen.status(ist_world_set_pose(world, 7, at), IST_ARGUMENT_INVALID);
  seen.status(ist_world_forget(world), IST_OK);
  seen.status(ist_world_get_info(world, &info), IST_OK);
}

Asked ask_all(Bodies& bodies) noexcept {
  Asked seen;
  auto result = sized<ist_query_result>();
  auto sums = sized<ist_contact_sums>();
  auto distance = sized<ist_distance_result>();
  auto triangle_result = sized<ist_triangle_pairs_result>();
  auto near_result = sized<ist_near_pairs_result>();
  auto query_info = sized<ist_query_info>();
  auto servo_info = sized<ist_servo_info>();
  auto servo_state = sized<ist_servo_state>();
  auto budget = sized<ist_budget>();
  std::int32_t answer = 0;
  double force[3], torque[3];
  seen.status(ist_servo_get_info(bodies.servo, &servo_info), IST_OK);
  for (int i = 0; i < 150; ++i) {
    const bool bad = i % 10 == 9;
    const ist_status wanted = bad ? IST_POSE_INVALID : IST_OK;
    std::array<double, 16> pose = c_shift(1.7 + 0.002 * i, 0, 0);
    if (bad) pose[5] = 3;
    budget.tests = i % 2 == 0 ? 100 : 0;
    budget.nanoseconds = i % 2 == 0 ? 0 : 20'000;
    const double* at = pose.data();
    for (const ist_budget* limits : std::array<const ist_budget*, 2>{nullptr, &budget}) {
      ask_world(bodies, at, bad, limits, seen);
      seen.status(ist_query_leaf_pairs(bodies.query, at, limits, bodies.leaf_pairs.data(),
                                       bodies.leaf_pairs.size(), &result),
                  wanted);
      seen.leaf_pairs += result.written;
      seen.status(
          ist_query_contacts(bodies.query, at, limits, bodies.contacts.data(), 32, &sums, &result),
          wanted);
      seen.contacts += result.written;
    }
    seen.status(ist_contact_sums_wrench(&sums, bad ? NAN : 2, force, torque),
                bad ? IST_ARGUMENT_INVALID : IST_OK);
    seen.status(ist_query_distance(bodies.query, at, 0.01, nullptr, &distance), wanted);
    seen.status(ist_query_intersects(bodies.query, at, nullptr, &answer), wanted);
    seen.status(ist_rotation_error(at, force), IST_OK);
    seen.status(ist_query_triangle_pairs(bodies.query, at, nullptr, bodies.triangle_pairs.data(),
                                         bodies.triangle_pairs.size(), &triangle_result),
                wanted);
    seen.triangle_pairs += triangle_result.written;
    seen.status(ist_query_near_pairs(bodies.query, at, 0.02, nullptr, bodies.near_pairs.data(),
                                     bodies.near_pairs.size(), &near_result),
                wanted);
    seen.near_pairs += near_result.written;
    seen.status(ist_query_near_pairs(bodies.query, at, 0.02, &budget, nullptr, 0, &near_result),
                wanted);
    seen.status(ist_query_near_pairs(bodies.query, at, NAN, nullptr, nullptr, 0, &near_result),
                IST_ARGUMENT_INVALID);
    seen.status(
        ist_query_near_parts(bodies.query, at, 0, 1, 9, bodies.near_pairs.data(), 15, &near_result),
        wanted);
    seen.status(ist_query_near_parts(bodies.query, at, 0, UINT32_MAX, 9, nullptr, 0, &near_result),
                IST_ARGUMENT_INVALID);
    seen.status(ist_query_forget(bodies.query), IST_OK);
    seen.status(ist_query_distance(bodies.query, at, 0.01, &budget, &distance), wanted);
    seen.status(ist_query_intersects(bodies.query, at, &budget, &answer), wanted);
    seen.status(ist_query_leaf_pairs(bodies.freed, at, nullptr, nullptr, 0, &result),
                IST_HANDLE_FREED);
    seen.status(ist_query_leaf_pairs(bodies.query, at, nullptr, nullptr, 7, &result),
                IST_NULL_ARGUMENT);
    seen.status(ist_query_get_info(bodies.query, &query_info), IST_OK);

    std::array<double, 16> device;
    std::copy_n(servo_info.tool, 16, device.begin());
    device[14] -= 0.015 * i;
    if (i == 100) device[14] = NAN;
    seen.status(ist_servo_on_tick(bodies.servo, device.data(), force, torque),
                i == 100 ? IST_POSE_INVALID : IST_OK);
    seen.force = std::max(seen.force, force[2]);
    seen.status(ist_servo_get_state(bodies.servo, &servo_state), IST_OK);
  }
  // A tick that gets no core in time holds the tool. So the last pose is given until it is felt.
  std::array<double, 16> device;
  std::copy_n(servo_info.tool, 16, device.begin());
  device[14] -= 0.015 * 149;
  while (seen.force <= 0.1) {
    seen.status(ist_servo_on_tick(bodies.servo, device.data(), force, torque), IST_OK);
    seen.force = std::max(seen.force, force[2]);
  }
  seen.status(ist_servo_get_info(bodies.servo, &servo_info), IST_OK);
  return seen;
}

TEST(CQuiet, AllocatesNothing) {
  Bodies bodies;
  const std::uint64_t before = allocations();
  const Asked seen = ask_all(bodies);
  EXPECT_EQ(allocations() - before, 0u);
  EXPECT_TRUE(seen.all()) << seen.as_expected << ' ' << seen.otherwise << ' ' << seen.leaf_pairs
                          << ' ' << seen.contacts << ' ' << seen.triangle_pairs << ' '
                          << seen.near_pairs << ' ' << seen.force;
}

TEST(CQuiet, MakesNoSystemCall) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  if (kSanitized) GTEST_SKIP() << "sanitizers call the system themselves";
  if (!can_forbid_system_calls()) IST_SKIP("this kernel does not filter system calls");
  EXPECT_EXIT(
      {
        Bodies bodies;
        forbid_system_calls();
        const Asked seen = ask_all(bodies);
        end_process(seen.all() ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace ist::test
