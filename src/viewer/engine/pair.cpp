#include "viewer/engine/pair.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <vector>

#include "answers/answer.h"
#include "answers/json_parts.h"

namespace ist::viewer {
namespace {

constexpr int kTogether = 20;
constexpr std::size_t kGroups = 9;
// A browser's clock steps by 0.1 ms.
constexpr std::chrono::milliseconds kShortestGroup{1}, kLongest{400};

// A distance that a person sees, of the smaller body's extent.
constexpr double kSeen = 1e-3;

double median_time(answers::Engine& engine, const Eigen::Isometry3d& pose) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> groups;
  const auto begin = Clock::now();
  while (groups.size() < kGroups && (groups.empty() || Clock::now() - begin < kLongest)) {
    const auto group = Clock::now();
    std::chrono::duration<double, std::micro> time;
    int asked = 0;
    do {
      for (int i = 0; i < kTogether; ++i) static_cast<void>(engine.ask(pose));
      asked += kTogether;
      time = Clock::now() - group;
    } while (time < kShortestGroup);
    groups.push_back(time.count() / asked);
  }
  const auto middle = groups.begin() + static_cast<std::ptrdiff_t>(groups.size() / 2);
  std::nth_element(groups.begin(), middle, groups.end());
  return *middle;
}

nlohmann::ordered_json contacts_of(const ContactManifold& manifold, double stiffness,
                                   Reply& reply) {
  std::vector<double> positions, normals, depths, weights;
  for (const Contact& contact : manifold.points()) {
    positions.insert(positions.end(), contact.position.begin(), contact.position.end());
    normals.insert(normals.end(), contact.normal.begin(), contact.normal.end());
    depths.push_back(contact.depth);
    weights.push_back(contact.weight);
  }
  const Wrench wrench = manifold.wrench(stiffness);
  return {{"positions", reply.array(std::move(positions))},
          {"normals", reply.array(std::move(normals))},
          {"depths", reply.array(std::move(depths))},
          {"weights", reply.array(std::move(weights))},
          {"force", answers::point_json(wrench.force)},
          {"torque", answers::point_json(wrench.torque)},
          {"about", answers::point_json(manifold.sums().about)}};
}

}  // namespace

Pair::Pair(const answers::Bodies& bodies)
    : bodies_(bodies),
      examiner_(bodies_, {}, {}),
      query_(bodies_.fixed, bodies_.moving, {.policy = bodies_.policy}),
      manifold_(bodies_.fixed, bodies_.moving, bodies_.policy) {
  engines_.emplace_back(answers::kEngineNames.front(), bodies_.fixed, bodies_.moving,
                        answers::EngineOptions{.policy = bodies_.policy});
}

nlohmann::ordered_json Pair::collide(const Eigen::Isometry3d& pose) {
  answers::Engine& engine = engines_.front();
  answers::PoseAnswer answer{pose, {}, examiner_.at(pose), {}};
  const answers::Engine::Answer given = engine.ask(pose);
  answer.engines.push_back({given.result, {given.microseconds}});
  return {{"header",
           answers::header_line(
               "collide", {{"fixed", bodies_.fixed.source()}, {"moving", bodies_.moving.source()}},
               bodies_)},
          {"line", answers::answer_line(
                       0, answer, answers::LeafAnswer{engine, answer.engines.front()}, bodies_)},
          {"microseconds", median_time(engine, pose)}};
}

void Pair::tick(const Eigen::Isometry3d& pose, double stiffness, Reply& reply) {
  const IntersectionResult touch = query_.intersects(pose);
  const DistanceResult distance = query_.distance(pose, kSeen * bodies_.extent());
  const QueryResult pairs = query_.contacts(pose, manifold_);
  reply.json = {
      {"touch", to_string(touch.answer)},          {"distance_lower", distance.distance.lower},
      {"distance_upper", distance.distance.upper}, {"leaf_pairs", pairs.leaf_pairs},
      {"sphere_tests", pairs.sphere_tests},        {"resolution", pairs.resolution}};
  reply.json["contacts"] = contacts_of(manifold_, stiffness, reply);
}

Pair& Pairs::of(std::optional<SpherePolicy> policy) {
  const SpherePolicy wanted = policy.value_or(bodies_.policy);
  bodies_.fixed.require(wanted, "the fixed body");
  bodies_.moving.require(wanted, "the moving body");
  std::optional<Pair>& pair = pairs_[static_cast<std::size_t>(wanted)];
  if (!pair) {
    answers::Bodies bodies = bodies_;
    bodies.policy = wanted;
    pair.emplace(bodies);
  }
  return *pair;
}

}  // namespace ist::viewer
