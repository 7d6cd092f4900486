// Asks ten fixed queries of the built-in jaws, one worker on AVX2, and makes ticks of two scenes,
// for callgrind to count: see scripts/query_instructions.py, which runs this. Prints compiler,
// flags and how many ticks, then a line a query: its name, what it found and how many pairs of
// spheres it tested. Exits with 77 where the processor has no AVX2.
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <string>
#include <vector>

#include "instructions/counted.h"
#include "instructions/counted_ticks.h"
#include "ist/models/models.h"
#include "ist/query/query.h"
#include "ist/tree/sphere_tree.h"
#include "simd/dispatch.h"
#include "support/rigid_pose.h"

namespace {

constexpr double kVoxelSize = 0.8;  // mm
constexpr const char* kTarget = "avx2";
constexpr int kSkipped = 77;

using ist::test::Answer;
using ist::test::count;

ist::SphereTree jaw(ist::Jaw which) {
  ist::BuildOptions options;
  options.voxel_size = kVoxelSize;
  options.keep_triangles = true;
  return ist::build_tree(ist::make_jaw(which, 1), options);
}

using ist::test::closing;

Answer answer_of(const ist::QueryResult& result) {
  return {result.leaf_pairs, result.sphere_tests};
}

void count_all() {
  const ist::SphereTree fixed = jaw(ist::Jaw::kUpper), moving = jaw(ist::Jaw::kLower);
  const Eigen::Isometry3d closed = closing(0), near = closing(-1.5), apart = closing(-2.5);
  std::vector<ist::LeafPair> leaf_pairs(1 << 18);
  std::vector<ist::TrianglePair> pairs(1 << 16);
  ist::QueryOptions options;
  options.target = kTarget;
  for (const ist::SpherePolicy policy : ist::kSpherePolicies) {
    options.policy = policy;
    ist::Query query(fixed, moving, options);
    count("leaf_pairs/" + std::string(to_string(policy)) + "/closed",
          [&] { return answer_of(query.leaf_pairs(closed, leaf_pairs)); });
  }
  options.policy = ist::SpherePolicy::kSlab;
  ist::Query query(fixed, moving, options);
  ist::ContactManifold points(fixed, moving, query.policy(), {.margin = 2});
  count("leaf_pairs/slab/near", [&] { return answer_of(query.leaf_pairs(near, leaf_pairs)); });
  count("leaf_pairs/slab/within_20000_tests",
        [&] { return answer_of(query.leaf_pairs(closed, leaf_pairs, {.tests = 20'000})); });
  count("contacts/closed", [&] { return answer_of(query.contacts(closed, points)); });
  // Each is a fresh answer.
  count("distance/apart", [&] {
    query.forget();
    const ist::DistanceResult result = query.distance(apart, 0.01);
    return Answer{result.distance.lower > 0 ? 1U : 0U, result.sphere_tests};
  });
  count("intersects/near", [&] {  // where leaves touch and triangles do not
    query.forget();
    const ist::IntersectionResult result = query.intersects(near);
    return Answer{result.answer == ist::Answer::kYes ? 1U : 0U, result.sphere_tests};
  });
  count("triangle_pairs/closed", [&] {
    const ist::TrianglePairsResult result = query.triangle_pairs(closed, pairs);
    return Answer{result.triangle_pairs, result.sphere_tests};
  });
}

}  // namespace

int main() try {
  if (std::ranges::none_of(ist::all_kernels(), [](const ist::Kernels& kernels) {
        return std::string(kernels.target) == kTarget;
      })) {
    fmt::print(stderr, "this processor, as valgrind shows it, has no AVX2\n");
    return kSkipped;
  }
  fmt::print("compiler: {}\nflags: {}\nticks: {}\n", IST_COMPILER, IST_FLAGS, ist::test::kTicks);
  count_all();
  ist::test::count_ticks();
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 1;
}
