#include "ist/query/contacts/ancestor_share.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ist/query/query_rules.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

constexpr std::uint32_t kNoBound = std::numeric_limits<std::uint32_t>::max();

}  // namespace

AncestorShare::AncestorShare(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                             const NodeParents& fixed_parents, const NodeParents& moving_parents,
                             const ContactScale& scale)
    : fixed_(fixed),
      moving_(moving),
      policy_(policy),
      fixed_parents_(fixed_parents),
      moving_parents_(moving_parents),
      width_(scale.width),
      margin_(scale.margin) {
  int a = fixed.depth(), b = moving.depth();
  while (a > 0 || b > 0) {
    Step& step = steps_.emplace_back();
    step.fixed_level = a;
    step.moving_level = b;
    step.bound_of = kNoBound;
    const double edge_a = fixed.parts().lattice.edge(a), edge_b = moving.parts().lattice.edge(b);
    const bool open_a = descends(a, edge_a, b, edge_b), open_b = descends(b, edge_b, a, edge_a);
    a -= open_a ? 1 : 0;
    b -= open_b ? 1 : 0;
  }
  std::reverse(steps_.begin(), steps_.end());
}

void AncestorShare::begin(const RelativePose& pose) noexcept {
  pose_ = &pose;
  if (++query_ != 0) return;
  query_ = 1;  // after 2^32 queries a cache entry could match by chance
  for (Step& step : steps_) {
    step.known.fill({});
    step.moved.fill({});
  }
}

double AncestorShare::find(std::size_t index, std::uint32_t fixed, std::uint32_t moving) noexcept {
  Step& step = steps_[index];
  Known& known = step.known[moving & (kKnown - 1)];
  if (is(known, fixed, moving)) return known.share;
  double share = own(step, fixed, moving);
  if (share > 0 && index + 1 < steps_.size()) {
    const Step& next = steps_[index + 1];
    const bool fixed_is_child = next.fixed_level > step.fixed_level;
    const bool moving_is_child = next.moving_level > step.moving_level;
    share = std::min(
        share, find(index + 1, fixed_is_child ? fixed_parents_.of(step.fixed_level, fixed) : fixed,
                    moving_is_child ? moving_parents_.of(step.moving_level, moving) : moving));
  }
  known = {query_, fixed, moving, share};
  return share;
}

double AncestorShare::own(Step& step, std::uint32_t fixed, std::uint32_t moving) noexcept {
  if (step.bound_of != fixed) {
    step.bound_of = fixed;
    step.bound = read_bound(fixed_, policy_, step.fixed_level, fixed,
                            fixed_parents_.of(step.fixed_level, fixed))
                     .inflated(margin_);
  }
  const NodeBound &a = step.bound, &b = moved(step, moving);
  const Eigen::Vector3d between = difference(b.centre, a.centre);
  const double squared = dot_in_order(between, between), radius_sum = a.radius + b.radius;
  const double near = radius_sum - width_;
  double overlap = width_;
  if (!(near > 0 && squared <= near * near)) overlap = radius_sum - std::sqrt(squared);
  if (policy_ == SpherePolicy::kSlab) overlap = std::min(overlap, slab_overlap(a, b));
  return std::clamp(overlap / width_, 0.0, 1.0);
}

const NodeBound& AncestorShare::moved(Step& step, std::uint32_t moving) noexcept {
  MovedBound& moved = step.moved[moving & (kKnown - 1)];
  if (moved.query != query_ || moved.node != moving) {
    moved.query = query_;
    moved.node = moving;
    moved.bound = read_bound(moving_, policy_, step.moving_level, moving,
                             moving_parents_.of(step.moving_level, moving))
                      .inflated(margin_)
                      .in(*pose_);
  }
  return moved.bound;
}

std::size_t AncestorShare::bytes() const noexcept { return steps_.size() * sizeof(Step); }

}  // namespace ist
