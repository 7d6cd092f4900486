// Asks the closed built-in jaws for leaf pairs and for contacts, by each instruction set, between
// two marks for counting_plugin.c or counting_steps.c: see scripts/target_instructions.py, which
// runs this. Prints a line a question: the target, the question, sphere tests and leaf pairs.
// Arguments name the instruction sets; without any, all that are here are asked.

#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string_view>
#include <vector>

#include "ist/ist.h"
#include "ist/models/models.h"
#include "simd/dispatch.h"

namespace {

ist::SphereTree jaw(ist::Jaw which) {
  return ist::build_tree(ist::make_jaw(which, 1), {.voxel_size = 0.8});
}

void mark() {
  constexpr long kMark = 4095;  // no system call
  ::syscall(kMark);
}

// Asks once before, so that no first allocation counts.
template <class Ask>
void count(const char* target, const char* question, const Ask& ask) {
  ask();
  mark();
  const ist::QueryResult found = ask();
  mark();
  std::printf("%s %s %llu %llu\n", target, question,
              static_cast<unsigned long long>(found.sphere_tests),
              static_cast<unsigned long long>(found.leaf_pairs));
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string_view> named(argv + 1, argv + argc);
  const ist::SphereTree fixed = jaw(ist::Jaw::kUpper), moving = jaw(ist::Jaw::kLower);
  const Eigen::Isometry3d closed = Eigen::Isometry3d::Identity();
  std::vector<ist::LeafPair> leaf_pairs(1 << 18);
  for (const ist::Kernels& kernels : ist::all_kernels()) {
    if (!named.empty() && std::find(named.begin(), named.end(), kernels.target) == named.end())
      continue;
    ist::QueryOptions options;
    options.target = kernels.target;
    ist::Query query(fixed, moving, options);
    ist::ContactManifold manifold(fixed, moving, query.policy(), {.margin = 2});
    count(kernels.target, "leaf_pairs", [&] { return query.leaf_pairs(closed, leaf_pairs); });
    count(kernels.target, "contacts", [&] { return query.contacts(closed, manifold); });
  }
}
