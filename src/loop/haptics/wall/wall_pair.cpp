#include "loop/haptics/wall/wall_pair.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "ist/base/pose.h"
#include "ist/base/rigid_move.h"
#include "ist/measure/require.h"
#include "ist/mesh/bounding_box.h"
#include "ist/query/query_state.h"
#include "ist/query/triangles/triangle_distance.h"
#include "ist/query/triangles/triangle_visitors.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

// Room for near pairs. Surfaces that nearly coincide have more, and are then tested whole.
constexpr std::size_t kNearPairs = 1 << 12;
constexpr std::size_t kKeptPairs = 1 << 13;
constexpr std::uint64_t kManyTests = std::uint64_t{1} << 62;
// Rounding of lengths, as a part of the body's size.
constexpr double kRounding = 1e-12;

const TriangleMesh& mesh_of(const SphereTree& tree) {
  require_triangles(tree, "the body");
  return parts_of(tree).triangles->mesh;
}

QueryOptions of_query(const WallPair::Options& options) {
  QueryOptions of;
  of.target = options.target;
  of.workers = options.workers;
  of.period = std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * options.period));
  of.near_pairs = kKeptPairs;
  return of;
}

RelativePose relative(const Eigen::Isometry3d& pose) noexcept {
  return {pose.linear(), pose.translation()};
}

}  // namespace

WallBody::WallBody(const SphereTree& of) : tree(of), surface(mesh_of(tree)) {}

WallPair::WallPair(std::shared_ptr<const WallBody> fixed, std::shared_ptr<const WallBody> held,
                   const Options& options)
    : fixed_(std::move(fixed)),
      held_(std::move(held)),
      box_(bounding_box(held_->surface.mesh())),
      query_(fixed_->tree, held_->tree, of_query(options)),
      near_(kNearPairs),
      list_(fixed_->surface, held_->surface, options.features) {}

double WallPair::clearance(const Eigen::Isometry3d& pose) const noexcept {
  if (!(clear_ > 0)) return 0;
  const double size = box_.diagonal().norm() + pose.translation().cwiseAbs().maxCoeff();
  return clear_ - longest_way(box_, clear_pose_, relative(pose)) - kRounding * size;
}

WallPair::Search WallPair::find(const Eigen::Isometry3d& pose, double margin, double wanted,
                                const Budget& budget) noexcept {
  if (is_searched_ && margin == margin_ && pose.linear() == asked_.rotation &&
      pose.translation() == asked_.translation &&
      (is_near() || !(wanted > clear_) || wanted == wanted_)) {
    return {true, 0, Found::kKept};
  }
  near_count_ = 0;
  is_searched_ = false;
  wanted_ = 0;
  listed_.reset();
  pose_ = relative(project_to_rigid(pose).value_or(pose));
  margin_ = margin;
  const NearPairsResult near = query_.near_pairs(pose, margin, near_, budget);
  Search search{near.status == QueryStatus::kDone && near.complete, near.sphere_tests, near.found};
  if (!search.complete) return search;
  is_searched_ = true;
  asked_ = relative(pose);
  pad_ = near.pad;
  has_all_ = !near.truncated;
  near_count_ = static_cast<std::size_t>(std::min<std::uint64_t>(near.near_pairs, near_.size()));
  clear_ = is_near() ? 0 : margin;
  clear_pose_ = pose_;
  if (is_near() || !(wanted > margin)) return search;
  // A limit of tests makes the answer independent of earlier questions.
  Budget rest = budget;
  rest.tests = rest.has_tests() ? rest.tests - std::min(rest.tests, search.tests) : kManyTests;
  const DistanceResult distance = query_.distance(pose, 0.5 * wanted, rest);
  search.tests += distance.sphere_tests;
  if (distance.complete) {
    clear_ = std::max(clear_, distance.distance.lower);
    wanted_ = wanted;
  } else if (budget.has_deadline()) {
    search.complete = is_searched_ = false;  // the time decided how much is known
  }
  return search;
}

void WallPair::list(FeatureList::Which which) noexcept {
  if (listed_ == which) return;
  list_.find(std::span(near_).first(near_count_), to_isometry(pose_), margin_, which);
  listed_ = which;
}

Answer WallPair::meets(const Eigen::Isometry3d& pose, double way, const Budget& budget) noexcept {
  if (!is_searched_) return Answer::kUnknown;
  if (!is_near()) return way < clear_ ? Answer::kNo : Answer::kUnknown;
  if (!has_all_) return query_.intersects(pose, budget).answer;
  const std::optional<Eigen::Isometry3d> rigid = project_to_rigid(pose);
  if (!rigid) return Answer::kUnknown;
  const RigidMove move(*rigid);
  const double size = box_.diagonal().norm() + pose.translation().cwiseAbs().maxCoeff();
  const double reach = way + pad_ + kRounding * size;
  if (!(reach < margin_)) return query_.intersects(pose, budget).answer;
  for (const NearPair& pair : std::span(near_).first(near_count_)) {
    if (pair.distance > reach) break;
    const TriangleCorners first = corners_of(fixed_->surface.mesh(), pair.triangles.fixed);
    TriangleCorners second = corners_of(held_->surface.mesh(), pair.triangles.moving);
    for (Eigen::Vector3d& corner : second) corner = move(corner);
    const Eigen::Vector3d along = difference(pair.moving_point, pair.fixed_point);
    if (surely_parted(first, second, pair.fixed_point, along)) continue;
    if (triangles_meet(first, second)) return Answer::kYes;
  }
  return Answer::kNo;
}

std::size_t WallPair::bytes_for(const SphereTree& fixed, const SphereTree& held,
                                const Options& options) {
  return detail::QueryState::bytes_for(fixed, held, of_query(options)) +
         kNearPairs * sizeof(NearPair) + FeatureList::bytes_for(options.features);
}

std::size_t WallPair::bytes() const noexcept {
  return query_.bytes() + near_.capacity() * sizeof(NearPair) + list_.bytes();
}

}  // namespace ist
