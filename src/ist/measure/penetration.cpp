#include "ist/measure/penetration.h"

#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/pose.h"
#include "ist/base/rigid_move.h"
#include "ist/measure/depth_front.h"
#include "ist/measure/depth_search.h"
#include "ist/measure/outer_ball_builder.h"
#include "ist/measure/point_search.h"
#include "ist/measure/require.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;
using DepthStatus = Penetration::Status;

double size_of(const SphereTree& tree) {
  return tree.bounding_radius() + tree.origin().cwiseAbs().maxCoeff();
}

double rounding_of(const SphereTree& fixed, const SphereTree& moving, const Vector& translation) {
  return 0x1p-44 * (size_of(fixed) + size_of(moving) + translation.cwiseAbs().maxCoeff());
}

bool has_balls(const SphereTree& tree) {
  return parts_of(tree).triangles->outer_balls() != nullptr;
}

// The farthest way of a point in a box between two places.
double largest_way(const Eigen::AlignedBox3d& box, const RigidMove& from, const RigidMove& to) {
  double most = 0;  // a square
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vector at;
    for (Eigen::Index i = 0; i < 3; ++i)
      at[i] = (corner >> i & 1U) != 0 ? box.max()[i] : box.min()[i];
    most = std::max(most, square_in_order(difference(to(at), from(at))));
  }
  return std::sqrt(most) * (1 + 0x1p-40);
}

// A front is made anew after a way of as many sizes of the bodies: its bounds are then too loose,
// and sums of ways would round.
constexpr double kLongestWay = 16;
// A search without outer balls takes as long as the balls of so many triangles. Fewer depths than
// kFewDepths never pay for balls.
constexpr std::uint64_t kBallBytesOfATriangle = 28, kTrianglesOfADepth = 800, kFewDepths = 100;

}  // namespace

// The searches of two bodies, and what one question leaves to the next.
struct detail::DepthMemory {
  SphereTree fixed, moving;
  PointSearch in_fixed, in_moving;
  std::array<SurfaceInBody, 2> sides;
  DepthSearch search;
  std::optional<DepthFront> front;
  std::array<RigidMove, 2> places;  // the sides' at the last question
  std::optional<DepthSearch::Point> deepest;
  double way = 0;

  DepthMemory(const SphereTree& a, const SphereTree& b, const ClusterKernels& kernels)
      : fixed(a),
        moving(b),
        in_fixed(fixed, kernels),
        in_moving(moving, kernels),
        sides{{{moving, fixed, in_fixed, RigidMove(Eigen::Isometry3d::Identity())},
               {fixed, moving, in_moving, RigidMove(Eigen::Isometry3d::Identity())}}},
        search({sides.begin(), sides.end()}),
        places{sides[0].to_body, sides[1].to_body} {
    if (has_balls(fixed) && has_balls(moving)) front.emplace(sides, kernels);
  }
  [[nodiscard]] bool is_of(const SphereTree& a, const SphereTree& b) const {
    return &parts_of(fixed) == &parts_of(a) && &parts_of(moving) == &parts_of(b) &&
           front.has_value() == (has_balls(a) && has_balls(b));
  }
  void place(std::size_t side, const RigidMove& to_body) {
    sides[side].to_body = to_body;
    search.set_move(side, to_body);
  }
  // Goes on from the deepest point of an earlier answer.
  void begin_at(const Penetration& last) {
    const std::size_t side = last.of_moving ? 0 : 1;
    const bool there = last.status == DepthStatus::kDone && last.lower > 0 &&
                       last.triangle < sides[side].surface.triangles()->triangles.size();
    if (!there) return;
    search.begin_at(side, last.triangle,
                    last.of_moving ? last.point : sides[1].to_body(last.point));
  }
  bool search_by_points(const Penetration* last) {
    if (last != nullptr) begin_at(*last);
    search.add_surfaces();
    return search.run();
  }
  bool search_by_balls(const Penetration* last, bool keeps) {
    std::array<double, 2> ways{};
    for (std::size_t side = 0; side < 2; ++side) {
      const RigidMove& now = sides[side].to_body;
      const auto& box = parts_of(sides[side].surface).triangles->box();
      ways[side] = largest_way(box, places[side], now) + search.rounding();
      places[side] = now;
    }
    way += std::max(ways[0], ways[1]);
    const bool goes_on = keeps && front->has_front() &&
                         way <= kLongestWay * (fixed.bounding_radius() + moving.bounding_radius());
    if (goes_on && deepest) {
      search.begin_at(*deepest);
    } else if (last != nullptr) {
      begin_at(*last);
    }
    if (!goes_on) way = 0;
    const bool is_complete =
        goes_on ? front->search_front(search, ways) : front->search_all(search, keeps);
    deepest = search.deepest();
    return is_complete;
  }
};

DepthTracker::DepthTracker() = default;
DepthTracker::~DepthTracker() = default;
DepthTracker::DepthTracker(DepthTracker&&) noexcept = default;
DepthTracker& DepthTracker::operator=(DepthTracker&&) noexcept = default;
void DepthTracker::forget() noexcept { memory_.reset(); }

const char* to_string(DepthStatus status) noexcept {
  constexpr std::array kNames = {"done", "invalid-pose", "fixed-not-closed", "moving-not-closed",
                                 "busy"};
  const auto at = static_cast<std::size_t>(status);
  return at < kNames.size() ? kNames[at] : "unknown";
}

void prepare_depth(const SphereTree& tree, std::uint64_t max_memory, Progress* progress) {
  const ScopedFloatEnvironment environment;
  require_triangles(tree, "tree");
  if (has_balls(tree)) return;
  parts_of(tree).triangles->keep_outer_balls(make_outer_balls(tree, max_memory, progress));
}

bool prepare_depth_for(std::uint64_t depths, const SphereTree& fixed, const SphereTree& moving,
                       Progress* progress) {
  std::uint64_t triangles = 0;
  for (const SphereTree* tree : {&fixed, &moving}) {
    const bool closed = tree->orientation() == Orientation::kOutward;
    if (tree->triangles() == nullptr || !closed) return false;
    const std::uint64_t count = tree->triangles()->triangles.size();
    if (count > kMostBallBytes / kBallBytesOfATriangle) return false;
    triangles += is_prepared_for_depth(*tree) ? 0 : count;
  }
  if (triangles > 0 && depths < std::max(kFewDepths, triangles / kTrianglesOfADepth)) return false;
  for (const SphereTree* tree : {&fixed, &moving}) prepare_depth(*tree, kMostBallBytes, progress);
  return true;
}

bool is_prepared_for_depth(const SphereTree& tree) noexcept {
  return parts_of(tree).triangles && has_balls(tree);
}

Penetration penetration(Query& query, const Eigen::Isometry3d& pose, double tolerance,
                        const PenetrationOptions& options) {
  const ScopedFloatEnvironment environment;
  const SphereTree &fixed = query.fixed(), &moving = query.moving();
  require_triangles(fixed, "fixed");
  require_triangles(moving, "moving");
  require_tolerance(tolerance);
  Penetration result;
  result.rotation_error = rotation_error(pose);
  const std::optional<Eigen::Isometry3d> rigid = project_to_rigid(pose);
  if (!rigid) {
    result.status = DepthStatus::kInvalidPose;
  } else if (fixed.orientation() != Orientation::kOutward) {
    result.status = DepthStatus::kFixedNotClosed;
  } else if (moving.orientation() != Orientation::kOutward) {
    result.status = DepthStatus::kMovingNotClosed;
  }
  if (result.status != DepthStatus::kDone) return result;
  const bool by_balls = has_balls(fixed) && has_balls(moving);
  std::unique_ptr<detail::DepthMemory> own;
  std::unique_ptr<detail::DepthMemory>& memory =
      options.tracker != nullptr ? options.tracker->memory_ : own;
  if (memory == nullptr || !memory->is_of(fixed, moving)) {
    memory = std::make_unique<detail::DepthMemory>(fixed, moving,
                                                   select_kernels(query.target()).clusters);
  }
  detail::DepthMemory& bodies = *memory;
  const RigidMove to_fixed(*rigid);
  bodies.place(0, to_fixed);
  bodies.place(1, RigidMove(rigid->inverse()));
  const double rounding = rounding_of(fixed, moving, rigid->translation());
  const DepthQuestion question{tolerance, rounding, options.budget, options.proceed};
  DepthSearch& search = bodies.search;
  search.begin(question);
  result.narrowest = 4 * rounding;
  result.fixed_self_intersecting = fixed.self_intersections() > 0;
  result.moving_self_intersecting = moving.self_intersections() > 0;
  const bool fits = by_balls && bodies.front->set_pose(0, bodies.sides[0].to_body, search) &&
                    bodies.front->set_pose(1, bodies.sides[1].to_body, search);
  result.complete = true;
  const bool is_tracked = fits && options.tracker != nullptr;
  if (!fits && bodies.front) bodies.front->forget();
  if (!is_tracked) {
    const IntersectionResult surfaces = query.intersects(*rigid);
    if (surfaces.status == QueryStatus::kBusy) {
      Penetration busy;
      busy.status = DepthStatus::kBusy;
      busy.rotation_error = result.rotation_error;
      return busy;
    }
    if (surfaces.answer != Answer::kYes && !is_any_inside(bodies.sides[0]) &&
        !is_any_inside(bodies.sides[1])) {
      result.upper = 0;
      return result;
    }
  }
  if (fits) {
    result.complete = bodies.search_by_balls(options.last, is_tracked);
    result.upper = bodies.front->bound(search);
  } else {
    result.complete = bodies.search_by_points(options.last);
    result.upper = search.bound();
  }
  result.capped = search.capped();
  result.points = search.points();
  if (const auto& deepest = search.deepest()) {
    result.of_moving = deepest->side == 0;
    result.lower = deepest->depth;
    result.triangle = deepest->triangle;
    const Vector way = difference(deepest->nearest, deepest->at);
    const double length = std::sqrt(dot_in_order(way, way));
    const Vector direction = length > 0 ? scaled(1 / length, way) : Vector(0, 0, 0);
    result.point = result.of_moving ? deepest->at : to_fixed(deepest->at);
    result.direction = result.of_moving ? direction : to_fixed.turned(direction);
  }
  return result;
}

}  // namespace ist
