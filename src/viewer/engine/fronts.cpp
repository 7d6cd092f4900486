#include "viewer/engine/fronts.h"

#include <algorithm>

#include "ist/base/float_environment.h"
#include "ist/base/pose.h"
#include "ist/base/throw_error.h"
#include "ist/query/relative_pose.h"
#include "ist/query/traversal/root_test.h"
#include "ist/query/traversal/search.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/tree/tree_parts.h"
#include "simd/dispatch.h"

namespace ist::viewer {
namespace {

constexpr std::size_t kFrontierPairs = std::size_t{1} << 16;

// Converts the ids of one side's nodes after a step to indices.
class Indices {
 public:
  Indices(const SearchStep& step, const SearchSide& side)
      : parents_(side.emits_slots || (step.last && !side.descends) ? side.nodes : nullptr) {}

  std::uint32_t operator()(std::uint32_t id) const {
    return parents_ == nullptr ? id : parents_[id / 8].first_child + id % 8;
  }

 private:
  const OctreeNode* parents_;
};

// Makes every test, and keeps the pairs that overlap after each step.
class FrontRecorder : public VisitorBase {
 public:
  FrontRecorder(const SearchPlan& plan, const SearchPose& pose, std::vector<StepFront>& fronts)
      : plan_(plan), pose_(pose), fronts_(fronts) {}

  Advanced advance(const SearchBatch& batch) {
    const Advanced made = batch.advance(pose_);
    fronts_[static_cast<std::size_t>(&batch.step - plan_.steps().data())].tests += made.tests;
    return made;
  }
  bool enter(std::size_t step, const Frontier& pairs, bool /*whole*/) {
    keep(step - 1, pairs);
    return true;
  }
  bool leaves(const Frontier& pairs) {
    keep(plan_.steps().size() - 1, pairs);
    return true;
  }

 private:
  void keep(std::size_t step, const Frontier& pairs) {
    StepFront& front = fronts_[step];
    front.pairs += pairs.moving_count;
    const SearchStep& made = plan_.steps()[step];
    const Indices fixed(made, made.fixed), moving(made, made.moving);
    std::size_t at = 0;
    for (std::size_t group = 0; group < pairs.group_count; ++group) {
      for (; at < pairs.groups[group].end && front.fixed.size() < kMostKept; ++at) {
        front.fixed.push_back(fixed(pairs.groups[group].fixed));
        front.moving.push_back(moving(pairs.moving[at]));
      }
    }
  }

  const SearchPlan& plan_;
  const SearchPose& pose_;
  std::vector<StepFront>& fronts_;
};

}  // namespace

std::vector<StepFront> record_fronts(const SphereTree& fixed, const SphereTree& moving,
                                     SpherePolicy policy, const Eigen::Isometry3d& pose,
                                     SearchLevels last) {
  const ScopedFloatEnvironment environment;
  const SearchPlan plan(fixed, moving, policy, last);
  const auto relative = relative_pose(pose, parts_of(fixed).origin, parts_of(moving).origin);
  if (!relative) {
    throw_error(ErrorCode::kPoseInvalid, "pose: it is no rigid motion: {}", why_not_rigid(pose));
  }
  if (!test_roots(fixed, moving, policy, *relative).overlap) return {};
  std::vector<StepFront> fronts(plan.steps().size());
  int fixed_level = fixed.depth(), moving_level = moving.depth();
  for (std::size_t step = 0; step < fronts.size(); ++step) {
    fixed_level -= plan.steps()[step].fixed.descends ? 1 : 0;
    moving_level -= plan.steps()[step].moving.descends ? 1 : 0;
    fronts[step].fixed_level = fixed_level;
    fronts[step].moving_level = moving_level;
  }
  const SearchPose from =
      to_float(*relative, lengths_of(fixed, policy), lengths_of(moving, policy));
  Search search(plan, select_kernels({}), kFrontierPairs);
  FrontRecorder recorder(plan, from, fronts);
  static_cast<void>(search.run(recorder));
  return fronts;
}

std::vector<std::uint32_t> nodes_in(std::span<const std::uint32_t> of_pairs) {
  std::vector<std::uint32_t> nodes(of_pairs.begin(), of_pairs.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace ist::viewer
