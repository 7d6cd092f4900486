#include "cli/engine.h"

#include <chrono>

#include "simd/dispatch.h"

namespace ist::cli {

Engine::Engine(std::string_view name, const SphereTree& fixed, const SphereTree& moving,
               const EngineOptions& options) {
  if (name == kEngineNames.back()) {
    reference_.emplace(fixed, moving, options.policy);
    nested_ = published_are_nested(options.policy);
    return;
  }
  options_ = options;
  if (options.exact) pairs_.resize(1 << 14);
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
  const Budget budget{options_.max_tests.value_or(Budget().tests)};
  while (true) {
    if (simd_) simd_->forget();  // no answer depends on the pose before
    const auto begin = std::chrono::steady_clock::now();
    const QueryResult leaves = simd_ ? simd_->leaf_pairs(pose, leaf_pairs_, budget)
                                     : reference_->leaf_pairs(pose, leaf_pairs_);
    const TrianglePairsResult exact =
        options_.exact ? simd_->triangle_pairs(pose, pairs_) : TrianglePairsResult();
    const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - begin;
    count_ = leaves.leaf_pairs;
    if (leaves.truncated) leaf_pairs_.resize(2 * count_);
    if (exact.truncated) pairs_.resize(2 * exact.triangle_pairs);
    if (leaves.truncated || exact.truncated) continue;
    Answer answer{leaves, time.count()};
    if (options_.exact) answer.triangle_pairs = exact.triangle_pairs;
    if (options_.max_tests) answer.gap = leaves.distance;
    if (options_.gap) answer.gap = simd_->distance(pose, *options_.gap).distance;
    return answer;
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

}  // namespace ist::cli
