// Bodies from scans: of high genus, and with every fault that a mesh can have.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ist/mesh/mesh.h"
#include "ist/query/reference/reference_query.h"
#include "ist/tree/tree_parts.h"
#include "query/contacts/contact_cases.h"
#include "query/scenes.h"
#include "query/triangles/meeting_pairs.h"
#include "query/triangles/mesh_distance.h"
#include "query/triangles/triangle_tree.h"
#include "simd/targets.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/shapes.h"
#include "support/stability.h"
#include "verify/answer_verifier.h"

namespace ist::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

class RealBodies : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Files, RealBodies,
                         ::testing::Values("human_maxilla", "spl_cranium_face", "dirty/dragon_res3",
                                           "dirty/human_maxilla_raw_open_soup",
                                           "dirty/spl_mandible_orig_dirty",
                                           "dirty/vkh_skull_dirty"),
                         [](const auto& file) {
                           const std::string name = file.param;
                           return name.substr(name.find('/') + 1);
                         });

// Two bodies at some poses: the guarantee, by the library's own check if asked; the same bits from
// all targets; contact points that are numbers.
void check_answers(const SphereTree& fixed, const SphereTree& moving,
                   const std::vector<Isometry3d>& poses, bool guarantee, StabilityCase& answers) {
  const SphereTree plain_fixed = without_triangles(fixed), plain_moving = without_triangles(moving);
  for (const SpherePolicy policy : kSpherePolicies) {
    SCOPED_TRACE(to_string(policy));
    const AnswerVerifier check(fixed, moving, policy);
    ReferenceQuery reference(plain_fixed, plain_moving, policy);
    ContactManifold points(plain_fixed, plain_moving, policy, {.margin = 2});
    std::vector<std::unique_ptr<Query>> engines;
    const auto add = [&](const std::string& target, int workers) {
      engines.push_back(
          std::make_unique<Query>(plain_fixed, plain_moving, options_of(policy, target, workers)));
    };
    for (const std::string& target : all_targets()) add(target, 1);
    add("", 2);
    for (const Isometry3d& pose : poses) {
      const FoundPairs answer = ask(*engines.front(), pose);
      const FoundContacts first = find_contacts(*engines.front(), points, pose);
      if (guarantee) {
        const FoundPairs plain = ask(reference, pose);
        const auto violation = check.check(
            pose,
            std::vector{GivenAnswer{answer.result, answer.leaf_pairs},
                        GivenAnswer{plain.result, plain.leaf_pairs, published_are_nested(policy)}});
        answers.sample(violation ? 1 : 0, 0, violation ? violation->detail : "");
      }
      answers.sample(is_sound(first, fixed.voxel_size()) ? 0 : 1, 0, "contact points");
      for (const auto& engine : engines) {
        answers.sample(same(ask(*engine, pose), answer) ? 0 : 1, 0, engine->target());
      }
      answers.sample(same(find_contacts(*engines.back(), points, pose), first) ? 0 : 1, 0,
                     "contact points by two workers");
    }
  }
}

// A body and a small ball in several places on it and off it: the distance, and the triangles that
// meet, against what all pairs of triangles give.
void check_distance(const SphereTree& body, const SphereTree& ball, double reach, Random& random,
                    StabilityCase& gap, StabilityCase& answers) {
  const TriangleMesh &mesh = parts_of(body).triangles->mesh,
                     &other = parts_of(ball).triangles->mesh;
  const double size = body.voxel_size();
  const double longest = std::max(longest_edge(mesh), longest_edge(other));
  std::vector<std::unique_ptr<Query>> queries;
  for (const SpherePolicy policy : kSpherePolicies) {
    queries.push_back(std::make_unique<Query>(body, ball, options_of(policy)));
  }
  for (int i = 0; i < std::max(2, samples(3)); ++i) {
    // Every other time a corner of the ball is on one of the body.
    const Vector3d at = mesh.vertices[random.below(mesh.vertices.size())];
    const double away = i % 2 == 0 ? 0 : random.uniform(1, 3) * (reach + size);
    const Isometry3d pose = shift((at - other.vertices[random.below(other.vertices.size())]) +
                                  away * random.direction());
    const double distance = mesh_distance(mesh, other, pose);
    const std::vector<TrianglePair> meeting = meeting_pairs(body, ball, pose);
    answers.sample((distance > 0) == meeting.empty() ? 0 : 1, 0, "the oracles agree");
    const double error = kTriangleDistanceError * (distance + longest);
    for (const auto& query : queries) {
      std::vector<TrianglePair> pairs(meeting.size() + 1);
      const TrianglePairsResult found = query->triangle_pairs(pose, pairs);
      answers.sample(found.triangle_pairs == meeting.size() &&
                             std::equal(meeting.begin(), meeting.end(), pairs.begin())
                         ? 0
                         : 1,
                     0, "triangle pairs");
      for (const double tolerance : {0.0, 0.3 * size}) {
        const DistanceInterval interval = query->distance(pose, tolerance).distance;
        gap.sample(outside(interval, distance), error);
        const double wide = tolerance + 2 * error;
        gap.sample(std::max(0.0, interval.upper - interval.lower - wide), error, "width");
      }
      const DistanceInterval early = *query->leaf_pairs(pose, {}, {.tests = 300}).distance;
      gap.sample(outside(early, distance), error, "early");
    }
  }
}

TEST_P(RealBodies, KeepEveryGuarantee) {
  IST_SLOW();
  const auto file = data_dir() / (std::string(GetParam()) + ".stl");
  if (!std::filesystem::exists(file)) IST_SKIP(file << " is not there");
  const std::string name = file.stem();
  StabilityCase answers("shapes", name, "wrong answers"),
      gap("shapes", name + ": gap", "mm that the distance is outside its interval");
  const TriangleMesh mesh = read_mesh(file);
  constexpr double kCells = 20;
  const SphereTree body = triangle_tree(mesh, kCells);
  const double size = body.voxel_size(), reach = 2 * size;
  const SphereTree ball = triangle_tree(icosphere(0, reach), 4);
  Random random(23);
  // On itself as it is; and a part of it in another part, where the check affords to look.
  check_answers(body, body, {Isometry3d::Identity()}, false, answers);
  std::vector<Isometry3d> aside;
  for (int i = 0; i < samples(1); ++i) {
    aside.push_back(
        pose_of(quarter_turns()[random.below(24)], 0.8 * kCells * size * random.direction()));
  }
  check_answers(body, body, aside, true, answers);
  std::vector<Isometry3d> poses;
  for (int i = 0; i < samples(6); ++i) {
    poses.push_back(pose_of(random.rotation(), mesh.vertices[random.below(mesh.vertices.size())] +
                                                   reach * random.direction()));
  }
  check_answers(body, ball, poses, true, answers);
  check_distance(body, ball, reach, random, gap, answers);
}

}  // namespace
}  // namespace ist::test
