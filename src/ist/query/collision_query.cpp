#include "ist/query/collision_query.h"

#include <algorithm>
#include <cmath>

#include "ist/base/assert.h"
#include "ist/base/float_environment.h"
#include "ist/query/kernels.h"
#include "ist/query/query_rules.h"
#include "ist/query/relative_pose.h"
#include "ist/query/root_test.h"

namespace ist {
namespace {

// What the kernels err by, in parts of |A| + |B| + |t|, u = 2⁻²⁴. |A| bounds a node's centre plus
// its radius, and by more than a fourth the corners of the root cube.
//   Decoding a centre, parent's cube and offset in it: the factor and the product 2u of each, the
//   sum u; the two are together no longer than the root cube's half diagonal, so 2.6u|A| for
//   blocks, and 4u|A| for the table, which adds three numbers. Turning the fixed one: entries,
//   products and two sums of three, √3 (1 + 1 + 2)u|a|, and adding the translation u(|a| + |t|),
//   itself narrowed, u|t|: 8u|A| + 2u|t|. Difference, squares and their sums: 2.5u of the distance,
//   which is about rA + rB; radii 2u, pad, sum and square 2.5u: 7u (rA + rB).
// |a| + rA <= |A|, so no length is counted for more than 12u.
constexpr double kBallRounding = 12.5 * 0x1p-24;
// In a slab's test the same difference meets a normal that errs by 7u, in a dot product of 5u, less
// an offset, against a sum: 16u (rA + rB) at most. A radius is at most 1.01 √3 half edges of
// the root, and |A| at least 2.21 of them, so rA < 0.8|A|: 2.6u|A| + 8u|a| + 16u rA < 17u|A|.
constexpr double kSlabRounding = 17 * 0x1p-24;

float round_up(double value) noexcept {
  return std::nextafter(static_cast<float>(value), HUGE_VALF);
}

SearchPose narrow(const RelativePose& pose, double reaches) noexcept {
  SearchPose narrow{};
  for (Eigen::Index i = 0; i < 3; ++i) {
    double moved = 0;
    for (Eigen::Index j = 0; j < 3; ++j) {
      narrow.rotation[3 * i + j] = static_cast<float>(pose.rotation(j, i));
      moved -= pose.rotation(j, i) * pose.translation[j];
    }
    narrow.translation[i] = static_cast<float>(moved);
  }
  const Eigen::Vector3d& t = pose.translation;
  const double lengths = reaches + std::sqrt((t[0] * t[0] + t[1] * t[1]) + t[2] * t[2]);
  narrow.ball_pad = round_up(kBallRounding * lengths);
  narrow.slab_pad = round_up(kSlabRounding * lengths);
  return narrow;
}

}  // namespace

CollisionQuery::CollisionQuery(const SphereTree& fixed, const SphereTree& moving,
                               const CollisionOptions& options)
    : fixed_(fixed),
      moving_(moving),
      policy_(options.policy.value_or(std::min(fixed.tightest(), moving.tightest()))),
      kernels_(find_kernels(options.target)),
      plan_(fixed, moving, policy_) {
  IST_ASSERT(options.workers == 1 || options.workers == 2);
  if (options.workers == 2) {
    search_.emplace<SharedSearch>(plan_, kernels_, options.frontier_pairs, options.period);
  } else {
    search_.emplace<Search>(plan_, kernels_, options.frontier_pairs);
  }
  static_cast<void>(collide(Eigen::Isometry3d::Identity(), {}));
}

QueryResult CollisionQuery::collide(const Eigen::Isometry3d& pose,
                                    std::span<Contact> out) noexcept {
  const ScopedFloatEnvironment environment;
  QueryResult result;
  const std::optional<RelativePose> relative =
      relative_pose(pose, fixed_.lattice(), moving_.lattice());
  if (!relative) {
    result.status = QueryStatus::kInvalidPose;
    result.complete = false;
    return result;
  }
  result.sphere_tests = 1;
  const RootTest roots = test_roots(fixed_, moving_, policy_, *relative);
  result.pad = 2 * roots.slack;
  if (!roots.touch) return result;

  const SearchPose narrowed = narrow(*relative, fixed_.reach() + moving_.reach());
  // What was added to a reach, and what the test may err by on top.
  result.pad = 2 * double{policy_ == SpherePolicy::kSlab ? narrowed.slab_pad : narrowed.ball_pad};
  ContactSink sink(out);
  if (auto* alone = std::get_if<Search>(&search_)) {
    result.sphere_tests += alone->run(narrowed, sink);
  } else {
    result.sphere_tests += std::get_if<SharedSearch>(&search_)->run(narrowed, sink);
  }
  result.contacts = sink.count();
  result.truncated = sink.truncated();
  return result;
}

std::size_t CollisionQuery::bytes() const noexcept {
  const auto* alone = std::get_if<Search>(&search_);
  return alone != nullptr ? alone->bytes() : std::get_if<SharedSearch>(&search_)->bytes();
}

SharedSearch::Sharing CollisionQuery::sharing() const noexcept {
  const auto* shared = std::get_if<SharedSearch>(&search_);
  return shared != nullptr ? shared->sharing() : SharedSearch::Sharing{};
}

double CollisionQuery::resolution(const QueryResult& result) const noexcept {
  return resolution_of(result, fixed_, moving_, policy_);
}

}  // namespace ist
