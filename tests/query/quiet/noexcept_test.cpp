// The verbs that a loop calls throw nothing, by their types: who takes a `noexcept` away breaks
// this build. Nothing here runs.
#include <array>
#include <optional>
#include <span>

#include "ist/haptics.h"
#include "ist/ist.h"

namespace ist::test {
namespace {

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
  static_assert(noexcept(world.query(0, 1)));
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
  static_assert(noexcept(callback.fault()));
  static_assert(noexcept(device.read()));
  static_assert(noexcept(device.write(six, 1.0)));
  static_assert(noexcept(effect.needs()));
  static_assert(noexcept(effect.reset()));
}

}  // namespace
}  // namespace ist::test
