#include "ist/query/collision_query.h"

#include <algorithm>

#include "ist/base/assert.h"
#include "ist/base/pose.h"
#include "ist/query/kernels.h"
#include "ist/query/query_rules.h"
#include "ist/query/relative_pose.h"
#include "ist/query/root_test.h"
#include "ist/query/search_pose.h"

namespace ist {
namespace {

// A stream looks at so many contacts at a time.
constexpr std::size_t kWindow = 1 << 12;
// Fixed nodes that are searched at a time where the first contact will do.
constexpr std::size_t kFewGroups = 16;

QueryResult invalid_pose() {
  QueryResult result;
  result.status = QueryStatus::kInvalidPose;
  result.complete = false;
  return result;
}

// What is left when the roots are tested.
Budget without_roots(Budget budget) {
  budget.sphere_tests -= budget.has_tests() && budget.sphere_tests > 0 ? 1U : 0U;
  return budget;
}

// What is known when the roots are tested. Where they do not touch, that is all.
QueryResult of_roots(const RootTest& roots) {
  QueryResult result;
  result.sphere_tests = 1;
  result.pad = 2 * roots.slack;
  if (!roots.touch) result.gap = roots.gap;
  return result;
}

}  // namespace

// What is made once and read by every query must not hang on the caller's arithmetic either.
CollisionQuery::CollisionQuery(const SphereTree& fixed, const SphereTree& moving,
                               const CollisionOptions& options)
    : CollisionQuery(fixed, moving, options, ScopedFloatEnvironment()) {}

CollisionQuery::CollisionQuery(const SphereTree& fixed, const SphereTree& moving,
                               const CollisionOptions& options, const ScopedFloatEnvironment&)
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
  window_.resize(kWindow + kContactSlack);
  if (fixed.triangles() && moving.triangles()) {
    exact_.emplace(fixed, moving, policy_, kernels_, options.triangle_pairs);
    // Of vertices that triangles name: others may lie anywhere.
    const TriangleMesh& mesh = moving.triangles()->mesh;
    for (const Triangle& triangle : mesh.triangles) {
      for (const std::uint32_t v : triangle) {
        largest_coordinate_ = std::max(largest_coordinate_, mesh.vertices[v].cwiseAbs().maxCoeff());
      }
    }
  }
  static_cast<void>(collide(Eigen::Isometry3d::Identity(), std::span<Contact>()));
}

CollisionQuery::~CollisionQuery() = default;

QueryResult CollisionQuery::collide(const Eigen::Isometry3d& pose,
                                    std::span<Contact> out) noexcept {
  const ScopedFloatEnvironment environment;
  ContactSink sink(out);
  return search(pose, sink, 0);
}

QueryResult CollisionQuery::collide(const Eigen::Isometry3d& pose, ContactStream& stream) noexcept {
  const ScopedFloatEnvironment environment;
  ContactSink sink(window_, stream);
  return search(pose, sink, 0);
}

QueryResult CollisionQuery::contact_points(const Eigen::Isometry3d& pose,
                                           ContactPoints& points) noexcept {
  IST_ASSERT(points.is_between(fixed_, moving_) && points.policy() == policy_);
  const ScopedFloatEnvironment environment;
  if (!points.begin(pose)) return invalid_pose();
  ContactSink sink(window_, points);
  const QueryResult result = search(pose, sink, points.scale().grow);
  points.finish();
  return result;
}

double CollisionQuery::triangle_error(const Eigen::Isometry3d& pose) const noexcept {
  // A moved vertex errs by 2⁻⁵¹ of its place, an axis: a pair of triangles that meet so is looked
  // for even where they do not. Leaves are placed better than that, wherever the scene lies.
  return exact_ ? 0x1p-48 * (largest_coordinate_ + pose.translation().cwiseAbs().maxCoeff()) : 0;
}

std::optional<CollisionQuery::Approach> CollisionQuery::approach(const Eigen::Isometry3d& pose,
                                                                 double grow) const noexcept {
  const auto relative = relative_pose(pose, fixed_.lattice(), moving_.lattice());
  if (!relative) return std::nullopt;
  return Approach{*relative, test_roots(fixed_, moving_, policy_, *relative, grow), grow};
}

SearchPose CollisionQuery::narrowed(const Approach& approach, double grow) const noexcept {
  return narrow(approach.relative, fixed_.reach() + moving_.reach(), approach.grow + grow);
}

double CollisionQuery::pad_of(const SearchPose& pose) const noexcept {
  return policy_ == SpherePolicy::kSlab ? pose.slab_pad : pose.ball_pad;
}

QueryResult CollisionQuery::search(const Eigen::Isometry3d& pose, ContactSink& sink,
                                   double grow) noexcept {
  const std::optional<Approach> bodies = approach(pose, grow);
  if (!bodies) return invalid_pose();
  QueryResult result = of_roots(bodies->roots);
  if (!bodies->roots.touch) return result;

  const SearchPose from = narrowed(*bodies);
  // What was added to a reach, and what the test may err by on top.
  result.pad = 2 * pad_of(from) - grow;
  if (auto* shared = std::get_if<SharedSearch>(&search_)) {
    result.sphere_tests += shared->run(from, sink);
  } else {
    result.sphere_tests += alone().run(from, sink);
  }
  result.contacts = sink.count();
  result.truncated = sink.truncated();
  result.complete = !sink.stopped();
  return result;
}

QueryResult CollisionQuery::collide(const Eigen::Isometry3d& pose, std::span<Contact> out,
                                    const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  const std::optional<Approach> bodies = approach(pose);
  if (!bodies) return invalid_pose();
  QueryResult result = of_roots(bodies->roots);
  result.gap = bodies->roots.gap;
  if (!bodies->roots.touch) return result;

  const SearchPose from = narrowed(*bodies);
  const double pad = pad_of(from);
  result.pad = 2 * pad;
  ContactSink sink(out);
  const Search::Known known = alone().run_within(without_roots(budget), from, sink);
  set_steps(known.steps, result);
  result.sphere_tests += known.tests;
  result.contacts = sink.count();
  result.truncated = sink.truncated();
  // Surfaces in a pair that was not opened may touch.
  const double apart = result.complete && result.contacts == 0
                           ? std::min(known.inner.pruned, known.leaves.pruned)
                           : 0;
  const double farthest = std::min(known.inner.farthest, known.leaves.farthest);
  result.gap->lower = std::max(result.gap->lower, apart - pad);
  result.gap->upper = std::min(result.gap->upper, farthest + pad);
  return result;
}

QueryResult CollisionQuery::contact_points(const Eigen::Isometry3d& pose, ContactPoints& points,
                                           const Budget& budget) noexcept {
  IST_ASSERT(points.is_between(fixed_, moving_) && points.policy() == policy_);
  const ScopedFloatEnvironment environment;
  if (!points.begin(pose)) return invalid_pose();
  const double grow = points.scale().grow;
  const std::optional<Approach> bodies = approach(pose, grow);
  if (!bodies) return invalid_pose();
  QueryResult result = of_roots(bodies->roots);
  result.gap = bodies->roots.gap;
  if (bodies->roots.touch) {
    const SearchPose from = narrowed(*bodies);
    result.pad = 2 * pad_of(from) - grow;
    ContactSink sink(window_, points);
    const Budget left = without_roots(budget);
    auto* shared = std::get_if<SharedSearch>(&search_);
    const Search::Stopped stopped =
        shared ? shared->run_until(left, from, sink) : alone().run_until(left, from, sink);
    set_steps(stopped.steps, result);
    result.sphere_tests += stopped.tests;
    result.contacts = stopped.contacts;
    if (result.contacts > 0) {
      const double within = resolution_of(result, fixed_, moving_, policy_);
      result.gap->upper = std::min(result.gap->upper, within);
    }
  }
  points.finish();
  return result;
}

void CollisionQuery::set_steps(std::size_t made, QueryResult& result) const noexcept {
  const std::size_t left = plan_.steps().size() - made;
  result.complete = left == 0;
  result.level = static_cast<int>(left);
}

ExactResult CollisionQuery::collide_exact(const Eigen::Isometry3d& pose,
                                          std::span<TrianglePair> out) noexcept {
  const ScopedFloatEnvironment environment;
  const std::optional<Approach> bodies = approach(pose, triangle_error(pose));
  ExactResult result;
  if (!is_exact()) {
    result.status = QueryStatus::kNoTriangles;
    return result;
  }
  if (!bodies) {
    result.status = QueryStatus::kInvalidPose;
    return result;
  }
  result.sphere_tests = 1;
  if (!bodies->roots.touch) return result;
  result.triangle_pairs = exact_->pairs(*project_to_rigid(pose), narrowed(*bodies), out);
  result.sphere_tests += exact_->tests();
  result.truncated = result.triangle_pairs > out.size();
  return result;
}

Touch CollisionQuery::touches(const Eigen::Isometry3d& pose) noexcept {
  const ScopedFloatEnvironment environment;
  const std::optional<Approach> bodies = approach(pose, triangle_error(pose));
  if (!bodies) return Touch::kInvalidPose;
  if (!bodies->roots.touch) return Touch::kNo;
  const SearchPose from = narrowed(*bodies);
  if (exact_) return exact_->any(*project_to_rigid(pose), from) ? Touch::kYes : Touch::kNo;
  struct First final : ContactStream {
    bool take(std::span<const Contact>) noexcept override { return false; }
  } first;
  ContactSink sink(window_, first);
  static_cast<void>(alone().run_hurried(from, sink, kFewGroups));
  return sink.count() > 0 ? Touch::kPossible : Touch::kNo;
}

Search& CollisionQuery::alone() noexcept {
  auto* shared = std::get_if<SharedSearch>(&search_);
  return shared != nullptr ? shared->alone() : *std::get_if<Search>(&search_);
}

std::size_t CollisionQuery::bytes() const noexcept {
  const auto* alone = std::get_if<Search>(&search_);
  return (alone != nullptr ? alone->bytes() : std::get_if<SharedSearch>(&search_)->bytes()) +
         (exact_ ? exact_->bytes() : 0) + window_.size() * sizeof(Contact);
}

SharedSearch::Sharing CollisionQuery::sharing() const noexcept {
  const auto* shared = std::get_if<SharedSearch>(&search_);
  return shared != nullptr ? shared->sharing() : SharedSearch::Sharing{};
}

double CollisionQuery::resolution(const QueryResult& result) const noexcept {
  const ScopedFloatEnvironment environment;
  return resolution_of(result, fixed_, moving_, policy_);
}

}  // namespace ist
