#include "simd/plan_cases.h"

#include <limits>
#include <utility>

#include "simd/guarded.h"
#include "simd/lanes.h"
#include "support/shapes.h"

namespace ist::test {

// With pads without end everything touches, so the search itself names all the nodes.
PlannedSearch::PlannedSearch(SphereTree a, SphereTree b, SpherePolicy with)
    : fixed(std::move(a)), moving(std::move(b)), policy(with), plan(fixed, moving, with) {
  SearchPose pose{};
  constexpr float kAll = std::numeric_limits<float>::infinity();
  pose.leaf = pose.inner = {kAll, kAll, kAll};
  const auto scratch = std::make_unique<SearchScratch>();
  auto pairs = std::make_unique<GuardedFrontier>(1, 0);
  pairs->append(0, std::vector<std::uint32_t>{0});
  for (std::size_t step = 0; step < plan.steps().size(); ++step) {
    Names& all = names.emplace_back();
    for (std::size_t g = 0; g < pairs->group_count; ++g)
      all.fixed.push_back(pairs->groups[g].fixed);
    all.moving.assign(pairs->moving, pairs->moving + pairs->groups[0].end);
    auto next = std::make_unique<GuardedFrontier>(plan.most_pairs(step), 0);
    SearchCursor cursor;
    DistanceBounds none;
    advance_scalar(plan.steps()[step], pose, *pairs, cursor, *next, *scratch, ~std::uint64_t{0},
                   Measured::kNothing, none);
    pairs = std::move(next);
  }
}

const std::vector<std::unique_ptr<PlannedSearch>>& all_plans() {
  static const std::vector<std::unique_ptr<PlannedSearch>> plans = [] {
    const TriangleMesh ball = icosphere(2, 1), block = box({-0.5, -0.4, -0.7}, {0.5, 0.4, 0.7});
    struct Sizes {
      double fixed, moving;
    };
    std::vector<std::unique_ptr<PlannedSearch>> all;
    for (const SpherePolicy policy : kSpherePolicies) {
      for (const Sizes cells :
           {Sizes{12, 9}, Sizes{3, 14}, Sizes{14, 2}, Sizes{1, 9}, Sizes{9, 1}, Sizes{1, 1}}) {
        all.push_back(std::make_unique<PlannedSearch>(tree_of(ball, cells.fixed),
                                                      tree_of(block, cells.moving), policy));
      }
    }
    return all;
  }();
  return plans;
}

SearchPose random_pose(Random& random, double most) {
  SearchPose pose{};
  const Eigen::Matrix3d rotation = random.rotation();
  const Eigen::Vector3d translation = random.point(-1, 1);
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      pose.rotation[3 * i + j] = static_cast<float>(rotation(i, j));
    }
    pose.translation[i] = static_cast<float>(translation[i]);
  }
  const auto pad = [&] { return static_cast<float>(random.uniform(0, most)); };
  for (Pads* pads : {&pose.leaf, &pose.inner}) {
    for (float* each : {&pads->ball, &pads->slab_fixed, &pads->slab_moving}) *each = pad();
  }
  return pose;
}

}  // namespace ist::test
