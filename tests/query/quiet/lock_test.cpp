#include <gtest/gtest.h>
#include <semaphore.h>

#include <mutex>
#include <optional>
#include <shared_mutex>
#include <span>
#include <vector>

#include "ist/haptics.h"
#include "ist/ist.h"
#include "query/every_verb.h"
#include "query/quiet/locks.h"
#include "query/scenes.h"
#include "query/triangles/triangle_tree.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

template <class Action>
std::uint64_t locks_of(const Action& action) {
  const std::uint64_t before = locks();
  action();
  return locks() - before;
}

TEST(Locks, AreCountedHoweverTheyAreAskedFor) {
  std::mutex mutex;
  EXPECT_EQ(locks_of([&] { const std::lock_guard lock(mutex); }), 1u);
  EXPECT_EQ(locks_of([&] {
              if (mutex.try_lock()) mutex.unlock();
            }),
            1u);
  std::shared_mutex shared;
  EXPECT_EQ(locks_of([&] { const std::shared_lock lock(shared); }), 1u);
  EXPECT_EQ(locks_of([&] { const std::unique_lock lock(shared); }), 1u);
  sem_t semaphore;
  ASSERT_EQ(sem_init(&semaphore, 0, 1), 0);
  EXPECT_EQ(locks_of([&] { sem_wait(&semaphore); }), 1u);
  sem_destroy(&semaphore);
  EXPECT_EQ(locks_of([] {}), 0u);
}

// From the very first query on, with and without a second worker and a cache.
TEST(Locks, AQueryAsksForNone) {
  const Scene& scene = solids()[0];
  for (const int workers : {1, 2}) {
    for (const std::size_t front_pairs : {std::size_t{0}, std::size_t{1} << 15}) {
      QueryOptions options = options_of(SpherePolicy::kSlab, "", workers);
      options.front_pairs = front_pairs;
      std::vector<LeafPair> out(1 << 16);
      Query query(scene.fixed, scene.moving, options);
      ContactManifold manifold(scene.fixed, scene.moving, SpherePolicy::kSlab, {.margin = 2});
      std::uint64_t pairs = 0;
      EXPECT_EQ(locks_of([&] {
                  for (int i = 0; i < 400; ++i) {
                    Eigen::Isometry3d pose = scene.pose;
                    pose.translation()[2] += 0.0005 * (i % 100);
                    pairs += query.leaf_pairs(pose, out).leaf_pairs;
                    pairs += query.contacts(pose, manifold).leaf_pairs;
                  }
                }),
                0u)
          << workers << " workers, a cache of " << front_pairs;
      EXPECT_GT(pairs, 0u);
    }
  }
}

TEST(Locks, NoVerbAsksForOne) {
  const SphereTree tree = triangle_tree(icosphere(3, 1), 20);
  for (const int workers : {1, 2}) {
    Query query(tree, tree, {.workers = workers, .near_pairs = 512});
    VerbRoom room(query);
    std::uint64_t tests = 0;
    const auto count = [&](const auto& result) { tests += result.sphere_tests; };
    EXPECT_EQ(locks_of([&] {
                for (int i = 0; i < 50; ++i) {
                  ask_every_verb(query, shift({0.03 * i, 0, 0}), room, {}, count);
                }
              }),
              0u)
        << workers << " workers";
    EXPECT_GT(tests, 1'000'000u);
  }
}

// The verbs that a loop calls throw nothing, by their types: who takes a `noexcept` away breaks
// this build. Nothing here runs.

[[maybe_unused]] void verbs_of_a_query(Query& query, ContactManifold& manifold,
                                       const Eigen::Isometry3d& pose, const Budget& budget,
                                       std::span<LeafPair> leaf_pairs, LeafPairStream& stream,
                                       std::span<TrianglePair> triangles) {
  static_assert(noexcept(query.intersects(pose, budget)));
  static_assert(noexcept(query.leaf_pairs(pose, leaf_pairs, budget)));
  static_assert(noexcept(query.leaf_pairs(pose, stream)));
  static_assert(noexcept(query.contacts(pose, manifold, budget)));
  static_assert(noexcept(query.distance(pose, 0.0, budget)));
  static_assert(noexcept(query.triangle_pairs(pose, triangles, budget)));
  static_assert(noexcept(query.near_pairs(pose, 1, {}, budget)));
  static_assert(noexcept(query.forget()));
  static_assert(noexcept(manifold.points()));
  static_assert(noexcept(manifold.sums()));
  static_assert(noexcept(manifold.wrench(1.0)));
  static_assert(noexcept(manifold.rates()));
}

[[maybe_unused]] void verbs_of_a_world(World& world, const Eigen::Isometry3d& pose,
                                       const Budget& budget, const WorldQuestion& question) {
  static_assert(noexcept(world.set_pose(0, pose)));
  static_assert(noexcept(world.ask(question, budget)));
  static_assert(noexcept(world.manifold(0, 1)));
  static_assert(noexcept(world.distance(0.0, budget)));
  static_assert(noexcept(world.forget()));
  static_assert(noexcept(world.pose_of(0, 1)));
}

[[maybe_unused]] void parts_of_a_tick(Simulation& simulation, ServoCallback& callback,
                                      Device& device, Effect& effect,
                                      const std::optional<Placement>& place,
                                      const TickBudget& budget, std::span<const double, 16> pose,
                                      std::span<double, 3> three, const Vector6& six) {
  static_assert(noexcept(simulation.tick(place, budget)));
  static_assert(noexcept(simulation.attach(0, budget)));
  static_assert(noexcept(simulation.release(0, budget)));
  static_assert(noexcept(simulation.changes()));
  static_assert(noexcept(simulation.body_pose(0)));
  static_assert(noexcept(simulation.tool_pose()));
  static_assert(noexcept(simulation.fault()));
  static_assert(noexcept(callback.on_tick(pose, three, three)));
  static_assert(noexcept(callback.attach(0)));
  static_assert(noexcept(callback.release(0)));
  static_assert(noexcept(callback.tool()));
  static_assert(noexcept(callback.last()));
  static_assert(noexcept(callback.fault()));
  static_assert(noexcept(device.read()));
  static_assert(noexcept(device.write(six, 1.0)));
  static_assert(noexcept(effect.needs()));
  static_assert(noexcept(effect.reset()));
}

}  // namespace
}  // namespace ist::test
