#include "cli/engine.h"

#include <chrono>

#include "ist/query/collision_query.h"
#include "ist/query/kernels.h"
#include "ist/query/reference.h"

namespace ist::cli {
namespace {

template <class Query>
class EngineOf : public Engine {
 public:
  template <class... Arguments>
  explicit EngineOf(Arguments&&... arguments) : query_(std::forward<Arguments>(arguments)...) {}

  [[nodiscard]] double resolution(const QueryResult& result) const override {
    return query_.resolution(result);
  }

  [[nodiscard]] Answer ask(const Eigen::Isometry3d& pose) override {
    while (true) {
      const auto begin = std::chrono::steady_clock::now();
      const QueryResult result = query_.collide(pose, contacts_);
      const std::chrono::duration<double, std::micro> time =
          std::chrono::steady_clock::now() - begin;
      count_ = result.contacts;
      if (!result.truncated) return {result, time.count(), std::nullopt, std::nullopt};
      contacts_.resize(2 * count_);
    }
  }

 protected:
  Query query_;
};

class Reference final : public EngineOf<ReferenceQuery> {
 public:
  using EngineOf::EngineOf;
  [[nodiscard]] std::string_view name() const override { return "reference"; }
  [[nodiscard]] std::string_view target() const override { return kScalarKernels.target; }
  [[nodiscard]] int workers() const override { return 1; }
};

class Simd final : public EngineOf<CollisionQuery> {
 public:
  Simd(const SphereTree& fixed, const SphereTree& moving, const CollisionOptions& simd,
       const EngineOptions& options)
      : EngineOf(fixed, moving, simd), options_(options), pairs_(options.exact ? 1 << 14 : 0) {}

  [[nodiscard]] Answer ask(const Eigen::Isometry3d& pose) override {
    Answer answer = timed(pose);
    if (options_.gap) answer.gap = query_.gap(pose, *options_.gap).gap;
    return answer;
  }
  [[nodiscard]] std::string_view name() const override { return "simd"; }
  [[nodiscard]] std::string_view target() const override { return query_.target(); }
  [[nodiscard]] int workers() const override { return query_.workers(); }

 private:
  QueryResult collide(const Eigen::Isometry3d& pose) {
    return options_.max_tests ? query_.collide(pose, contacts_, {*options_.max_tests})
                              : query_.collide(pose, contacts_);
  }

  Answer timed(const Eigen::Isometry3d& pose) {
    while (true) {
      const auto begin = std::chrono::steady_clock::now();
      const QueryResult leaves = collide(pose);
      const ExactResult exact = options_.exact ? query_.collide_exact(pose, pairs_) : ExactResult();
      const std::chrono::duration<double, std::micro> time =
          std::chrono::steady_clock::now() - begin;
      count_ = leaves.contacts;
      if (leaves.truncated) contacts_.resize(2 * count_);
      if (exact.truncated) pairs_.resize(2 * exact.triangle_pairs);
      if (leaves.truncated || exact.truncated) continue;
      Answer answer{leaves, time.count(), std::nullopt, std::nullopt};
      if (options_.max_tests) answer.gap = leaves.gap;
      if (options_.exact) answer.triangle_pairs = exact.triangle_pairs;
      return answer;
    }
  }

  EngineOptions options_;
  std::vector<TrianglePair> pairs_;
};

}  // namespace

std::unique_ptr<Engine> make_engine(std::string_view name, const SphereTree& fixed,
                                    const SphereTree& moving, const EngineOptions& options) {
  if (name == "reference") return std::make_unique<Reference>(fixed, moving, options.policy);
  CollisionOptions simd;
  simd.policy = options.policy;
  simd.target = options.target;
  simd.workers = options.workers;
  simd.period = {};  // the command asks one query after the other
  return std::make_unique<Simd>(fixed, moving, simd, options);
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
