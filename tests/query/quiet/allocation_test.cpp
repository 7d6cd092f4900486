#include <gtest/gtest.h>

#include <chrono>
#include <new>

#include "ist/query/reference.h"
#include "query/quiet/allocations.h"
#include "query/search/scenes.h"

namespace ist::test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

template <class Action>
std::uint64_t allocations_of(const Action& action) {
  const std::uint64_t before = allocations();
  action();
  return allocations() - before;
}

TEST(Allocations, AreCountedHoweverMemoryIsAskedFor) {
  void* volatile memory = nullptr;  // so that nothing is optimised away
  EXPECT_EQ(allocations_of([&] { memory = std::malloc(1); }), 1u);
  EXPECT_EQ(allocations_of([&] { memory = std::realloc(memory, 10000); }), 1u);
  std::free(memory);
  EXPECT_EQ(allocations_of([&] { memory = ::operator new(8); }), 1u);
  ::operator delete(memory);
  EXPECT_EQ(allocations_of([&] { memory = ::operator new (64, std::align_val_t{64}); }), 1u);
  ::operator delete (memory, std::align_val_t{64});
  EXPECT_EQ(allocations_of([] {}), 0u);
}

TEST(Allocations, TheReferenceMakesSome) {
  const Scene& scene = solids()[0];
  ReferenceQuery query(scene.fixed, scene.moving, SpherePolicy::kTight);
  EXPECT_GT(allocations_of([&] { static_cast<void>(query.collide(scene.pose, {})); }), 0u);
}

// From the very first query on: all was reserved by the constructor. Nor does the worker make any.
TEST(Allocations, AQueryMakesNone) {
  for (const Scene& scene : solids()) {
    for (const SpherePolicy policy : kSpherePolicies) {
      for (const int workers : {1, 2}) {
        std::vector<Contact> out(1 << 16);
        CollisionQuery query(scene.fixed, scene.moving, options_of(policy, "", workers));
        EXPECT_EQ(allocations_of([&] {
                    for (int i = 0; i < 400; ++i) {
                      Eigen::Isometry3d pose = scene.pose;
                      pose.translation()[2] += 0.01 * (i % 100);
                      static_cast<void>(query.collide(pose, out));
                    }
                  }),
                  0u)
            << scene.name << ", " << to_string(policy) << ", " << workers << " workers";
      }
    }
  }
}

TEST(Allocations, NorDoesOneThatTheWorkerHelpsWith) {
  const Scene& scene = jaws();
  std::vector<Contact> out(1 << 16);
  CollisionQuery query(scene.fixed, scene.moving, options_of(SpherePolicy::kTight, "", 2));
  EXPECT_EQ(allocations_of([&] {
              for (const auto give_up = Clock::now() + 60s;
                   Clock::now() < give_up && query.sharing().chunks < 200;) {
                static_cast<void>(query.collide(scene.pose, out));
              }
            }),
            0u);
  EXPECT_GE(query.sharing().chunks, 200u);
}

}  // namespace
}  // namespace ist::test
