#include "answers/engine.h"

#include <chrono>

#include "simd/dispatch.h"

namespace ist::answers {

Engine::Engine(std::string_view name, const SphereTree& fixed, const SphereTree& moving,
               const EngineOptions& options) {
  if (name == kEngineNames.back()) {
    reference_.emplace(fixed, moving, options.policy);
    nested_ = published_are_nested(options.policy);
    return;
  }
  budget_.tests = options.max_tests.value_or(budget_.tests);
  ist::QueryOptions simd;
  simd.policy = options.policy;
  simd.target = options.target;
  simd.workers = options.workers;
  simd.period = {};  // one query follows the other
  simd_.emplace(fixed, moving, simd);
}

std::string_view Engine::target() const {
  return simd_ ? std::string_view(simd_->target()) : kScalarKernels.target;
}

Engine::Answer Engine::ask(const Eigen::Isometry3d& pose) {
  while (true) {
    if (simd_) simd_->forget();  // no answer depends on the pose before
    const auto begin = std::chrono::steady_clock::now();
    const QueryResult result = simd_ ? simd_->leaf_pairs(pose, leaf_pairs_, budget_)
                                     : reference_->leaf_pairs(pose, leaf_pairs_);
    const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - begin;
    count_ = result.leaf_pairs;
    if (!result.truncated) return {result, time.count()};
    leaf_pairs_.resize(2 * count_);
  }
}

std::string target_names() {
  std::string names;
  for (const Kernels& kernels : all_kernels()) {
    names += names.empty() ? "" : ", ";
    names += kernels.target;
  }
  return names;
}

}  // namespace ist::answers
