// What is marked real time in ist.h allocates nothing and makes no system call, also where it
// fails.

#include <gtest/gtest.h>

#include <csignal>
#include <vector>

#include "capi/c_bodies.h"
#include "query/quiet/allocations.h"
#include "support/shapes.h"
#include "support/skip.h"
#include "support/system_calls.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

struct Bodies {
  TempDir folder;
  ist_query* query = c_query(c_tree(icosphere(2, 1), 0.15));
  ist_query* freed = c_query(c_tree(icosphere(1, 1), 0.5));
  ist_servo* servo = nullptr;
  std::vector<ist_contact> contacts = std::vector<ist_contact>(1 << 12);
  std::vector<ist_contact_point> points = std::vector<ist_contact_point>(32);
  std::vector<ist_triangle_pair> pairs = std::vector<ist_triangle_pair>(1 << 12);

  Bodies() {
    auto options = sized<ist_servo_options>();
    options.unit = IST_UNIT_MM;
    const std::string file = folder.write("scene.toml", kSmallScene).string();
    EXPECT_EQ(name(ist_servo_open_scene(file.c_str(), &options, &servo)), "ok");
    EXPECT_EQ(name(ist_query_free(freed)), "ok");
  }
  ~Bodies() {
    EXPECT_EQ(name(ist_query_free(query)), "ok");
    EXPECT_EQ(name(ist_servo_free(servo)), "ok");
  }
};

// How many calls did, and did not, what is expected of them.
struct Asked {
  int as_expected = 0, otherwise = 0;
  std::uint64_t contacts = 0, points = 0, pairs = 0;
  double force = 0;

  void status(ist_status is, ist_status wanted) noexcept {
    ++(is == wanted ? as_expected : otherwise);
  }
  [[nodiscard]] bool all() const noexcept {
    return otherwise == 0 && as_expected > 1000 && contacts > 100 && points > 100 && pairs > 100 &&
           force > 0.1;
  }
};

Asked ask_all(Bodies& bodies) noexcept {
  Asked seen;
  auto result = sized<ist_query_result>();
  auto sums = sized<ist_contact_sums>();
  auto gap = sized<ist_gap_result>();
  auto exact = sized<ist_exact_result>();
  auto query_info = sized<ist_query_info>();
  auto servo_info = sized<ist_servo_info>();
  auto budget = sized<ist_budget>();
  std::int32_t touch = 0;
  double force[3], torque[3];
  seen.status(ist_servo_get_info(bodies.servo, &servo_info), IST_OK);
  for (int i = 0; i < 150; ++i) {
    const bool bad = i % 10 == 9;
    const ist_status wanted = bad ? IST_POSE_INVALID : IST_OK;
    std::array<double, 16> pose = c_shift(1.7 + 0.002 * i, 0, 0);
    if (bad) pose[5] = 3;
    budget.sphere_tests = i % 2 == 0 ? 100 : 0;
    budget.nanoseconds = i % 2 == 0 ? 0 : 20'000;
    const double* at = pose.data();
    seen.status(ist_query_collide(bodies.query, at, bodies.contacts.data(), bodies.contacts.size(),
                                  &result),
                wanted);
    seen.contacts += result.written;
    seen.status(ist_query_collide_within(bodies.query, at, &budget, bodies.contacts.data(),
                                         bodies.contacts.size(), &result),
                wanted);
    seen.status(
        ist_query_contact_points(bodies.query, at, bodies.points.data(), 32, &sums, &result),
        wanted);
    seen.points += result.written;
    seen.status(ist_query_contact_points_within(bodies.query, at, &budget, bodies.points.data(), 32,
                                                &sums, &result),
                wanted);
    seen.status(ist_query_gap(bodies.query, at, 0.01, &gap), wanted);
    seen.status(ist_query_touches(bodies.query, at, &touch), wanted);
    seen.status(ist_query_exact(bodies.query, at, bodies.pairs.data(), bodies.pairs.size(), &exact),
                wanted);
    seen.pairs += exact.written;
    seen.status(ist_query_collide(bodies.freed, at, nullptr, 0, &result), IST_HANDLE_FREED);
    seen.status(ist_query_collide(bodies.query, at, nullptr, 7, &result), IST_NULL_ARGUMENT);
    seen.status(ist_query_get_info(bodies.query, &query_info), IST_OK);

    std::array<double, 16> device;
    std::copy_n(servo_info.tool, 16, device.begin());
    device[14] -= 0.015 * i;
    if (i == 100) device[14] = NAN;
    seen.status(ist_servo_on_tick(bodies.servo, device.data(), force, torque),
                i == 100 ? IST_POSE_INVALID : IST_OK);
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
  EXPECT_TRUE(seen.all()) << seen.as_expected << ' ' << seen.otherwise << ' ' << seen.contacts
                          << ' ' << seen.points << ' ' << seen.pairs << ' ' << seen.force;
}

TEST(CQuiet, MakesNoSystemCall) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
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
