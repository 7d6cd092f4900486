#include "ist/measure/first_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "ist/base/direction.h"
#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/pose.h"
#include "ist/base/rigid_move.h"
#include "ist/measure/point_search.h"
#include "ist/measure/require.h"
#include "ist/query/swept_pairs.h"
#include "ist/query/triangles/moving_pair.h"
#include "ist/query/triangles/triangle_distance.h"
#include "ist/query/triangles/triangle_visitors.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

using ContactStatus = FirstContact::Status;
using Pose = Eigen::Isometry3d;

// The least part of the tolerance that rounding may take from a distance.
constexpr double kStuck = 1.0 / 16;
// Triangles within the tolerance of each other take at most so many steps for a way as long as the
// tolerance.
constexpr double kSlowSteps = 64;
// The direction of a distance is known if the distance is so many times the rounding.
constexpr double kSharp = 64;
// A list of more pairs costs more than two lists of half the way.
constexpr std::size_t kFewPairs = 512;
// So many parts before a contact are shorter than the one before.
constexpr int kShorterParts = 2;
// Later lists may be twice as long if the way of one was halved more often.
constexpr int kMostHalves = 2;

// Returns the most speed of the vertices in use, by a box round them.
double most_speed(const Motion& motion, const SphereTree& tree) {
  const TriangleClusters& clusters = parts_of(tree).triangles->clusters;
  const NodeBlock& root = clusters.bounds(clusters.root_level())[0];
  std::array<Eigen::Vector3d, 8> corners;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    Eigen::Vector3d& corner = corners[k] = clusters.origin();
    for (Eigen::Index i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      const double centre = root.centre[axis][0], half = root.half[axis][0];
      const double along = (k >> axis & 1U) != 0 ? centre + half : centre - half;
      add_to(corner, scaled(along, clusters.axes().col(i)));
    }
  }
  return motion.longest_way(corners) * (1 + 0x1p-40);
}

bool is_inside_other(const Query& query, const Pose& pose) {
  const ClusterKernels& kernels = select_kernels(query.target()).clusters;
  const SphereTree &fixed = query.fixed(), &moving = query.moving();
  const auto holds = [&](const SphereTree& body, const SphereTree& surface, const Pose& to_body) {
    if (body.orientation() != Orientation::kOutward) return false;
    const PointSearch search(body, kernels);
    return is_any_inside({surface, body, search, RigidMove(to_body)});
  };
  return holds(fixed, moving, pose) || holds(moving, fixed, inverse_of(pose));
}

// A search along one motion. It lists the pairs of triangles that may meet on a part of the way.
// Each pair has a parameter before which it does not meet. The pair with the least one goes on.
class Advance {
 public:
  Advance(Query& query, const Motion& motion, double tolerance, const FirstContactOptions& options)
      : query_(query),
        motion_(motion),
        options_(options),
        way_(most_speed(motion, query.moving())) {
    const auto size = [](const SphereTree& tree) {
      return tree.bounding_radius() + tree.origin().cwiseAbs().maxCoeff();
    };
    // The rounding at a pose on the way: the longest way of a point counts too.
    rounding_ = 0x1p-42 * (size(query.fixed()) + size(query.moving()) + way_ +
                           motion.at(0).translation().cwiseAbs().maxCoeff());
    found_.rotation_error = motion.rotation_error();
    found_.narrowest = rounding_ / kStuck;
    tolerance_ = std::max(tolerance, found_.narrowest);
    part_ = {rigid_at(0), rigid_at(0), motion.turning(), motion.velocity({0, 0, 0}),
             0,           way_,        rounding_};
  }

  FirstContact run() {
    query_.forget();
    const IntersectionResult start = query_.intersects(motion_.at(0));
    if (start.status == QueryStatus::kBusy) return end(ContactStatus::kBusy, 0, 1);
    found_.verdicts = 1;
    if (start.answer == Answer::kYes) return touches_at_start();
    found_.fixed_self_intersecting = query_.fixed().self_intersections() > 0;
    found_.moving_self_intersecting = query_.moving().self_intersections() > 0;
    if (is_inside_other(query_, motion_.at(0))) return end(ContactStatus::kInsideAtStart, 0, 0);
    if (meet_at(1)) contact_ = 1;
    for (double at = 0, length = 1; at < 1;) {
      const std::optional<double> until = list_pairs(at, length);
      if (!until || advance(at, *until)) return found_;
      length = (*until - at) * growth();
      at = *until;
      if (at >= contact_) contact_ = HUGE_VAL;  // only rounding can let them pass it
    }
    return found_.grazed ? end(ContactStatus::kGrazing, graze_.first, graze_.second)
                         : end(ContactStatus::kNone, 1, 1);
  }

 private:
  // A pair that does not meet before a parameter.
  struct Waiting {
    double from;
    TriangleIds ids;
    Eigen::Vector3d axis;  // parts the triangles, as far as it is known

    // The least parameter is on top of a heap.
    [[nodiscard]] static bool later(const Waiting& a, const Waiting& b) noexcept {
      return std::tie(a.from, a.ids) > std::tie(b.from, b.ids);
    }
  };
  // The moving body at a parameter.
  struct Moment {
    Pose pose;
    MovedTriangles moving;

    Moment(const Advance& of, double parameter)
        : pose(*project_to_rigid(of.motion_.at(parameter))),
          moving(*of.query_.moving().triangles(), pose) {}
  };

  FirstContact end(ContactStatus status, double lower, double upper) {
    found_.status = status;
    found_.lower = lower;
    found_.upper = upper;
    return found_;
  }
  FirstContact touches_at_start() {
    const TrianglePair first = first_at(0);
    if (is_busy_) return end(ContactStatus::kBusy, 0, 1);
    found_.triangles = first;
    found_.place =
        closest_points(fixed_corners(first.fixed), Moment(*this, 0).moving[first.moving], first);
    found_.distance = {0, 0};
    return end(ContactStatus::kTouchesAtStart, 0, 0);
  }
  [[nodiscard]] RelativePose rigid_at(double at) const {
    const Pose pose = *project_to_rigid(motion_.at(at));
    return {pose.linear(), pose.translation()};
  }
  // Returns the first triangles that intersect at a parameter. Precondition: some do.
  TrianglePair first_at(double at) {
    std::array<TrianglePair, 1> first{};
    is_busy_ = query_.triangle_pairs(motion_.at(at), first).status == QueryStatus::kBusy;
    return first[0];
  }
  [[nodiscard]] TriangleCorners fixed_corners(std::uint32_t triangle) const {
    return corners_of(*query_.fixed().triangles(), triangle);
  }
  // Returns the first parameter at which the surfaces may have met unseen, or `at`.
  [[nodiscard]] double grazed_at(double at) const { return found_.grazed ? graze_.first : at; }
  // Returns whether the search may ask one more question at a parameter. Else ends it.
  [[nodiscard]] bool goes_on(double at) {
    bool stopped = found_.distances >= options_.budget.tests || options_.budget.is_past();
    if (!stopped && options_.proceed && at > asked_) {
      stopped = !options_.proceed(at);
      asked_ = at;
    }
    if (stopped) end(ContactStatus::kStopped, grazed_at(at), 1);
    return !stopped;
  }
  // Returns the parameter after a way of `by` of the fastest point.
  [[nodiscard]] double step(double at, double by) const {
    return by < way_ * (1 - at) ? at + by / way_ : 1;
  }

  // Returns the end of a part, no later than a contact that is known. Looks for an earlier contact:
  // to find that bodies meet takes less time than to list their pairs.
  double end_of(double at, double length) {
    const double last = std::min(contact_, 1.0), until = at + length < last ? at + length : last;
    if (contact_ > 1 || until == contact_ || !meet_at(until)) return until;
    contact_ = until;
    quiet_parts_ = 0;
    const double half = at + 0.5 * (until - at);
    if (meet_at(half)) contact_ = half;
    return contact_;
  }
  [[nodiscard]] bool meet_at(double at) {
    ++found_.verdicts;
    const IntersectionResult asked = query_.intersects(motion_.at(at));
    is_busy_ = is_busy_ || asked.status == QueryStatus::kBusy;
    return asked.answer == Answer::kYes;
  }

  // Returns the next part's length over the last one's. The bodies come nearer to each other
  // towards a contact that is known; but it may be far.
  double growth() {
    if (contact_ > 1) return listed_.pairs.size() < most_ / 4 ? 2 : 1;
    ++quiet_parts_;
    return quiet_parts_ <= kShorterParts ? 0.5 : quiet_parts_ == kShorterParts + 1 ? 1 : 2;
  }

  // Lists the pairs that may meet from a parameter on, for a part of the motion no longer than
  // `length`. Returns the end of the part; nothing if the search has ended.
  std::optional<double> list_pairs(double at, double length) {
    for (int halves = 0;; ++halves) {
      if (!goes_on(at)) return std::nullopt;
      const double until = end_of(at, length), middle = at + 0.5 * (until - at);
      part_.start = rigid_at(at);
      part_.middle = rigid_at(middle);
      part_.half = std::max(until - middle, middle - at);
      ++found_.distances;
      const SweptPairsResult listed = swept_pairs(query_, part_, most_, options_.budget, listed_);
      if (is_busy_ || listed.status == QueryStatus::kBusy) {
        end(ContactStatus::kBusy, 0, 1);
        return std::nullopt;
      }
      if (!listed.complete) {
        end(ContactStatus::kStopped, grazed_at(at), 1);
        return std::nullopt;
      }
      if (listed.fits) return until;
      length = 0.5 * (until - at);
      quiet_parts_ = 0;
      if (halves >= kMostHalves) most_ *= 2;
    }
  }

  // Lets the pairs of the list go on, always the one with the least parameter. Returns whether the
  // search has ended.
  bool advance(double at, double until) {
    waiting_.clear();
    for (const SweptPair& pair : listed_.pairs) {
      waiting_.push_back({at + shorter(pair.after), pair.ids, {0, 0, 0}});
    }
    std::make_heap(waiting_.begin(), waiting_.end(), Waiting::later);
    while (!waiting_.empty()) {
      std::pop_heap(waiting_.begin(), waiting_.end(), Waiting::later);
      Waiting& next = waiting_.back();
      if (!goes_on(next.from)) return true;
      ++found_.distances;
      const bool ended = go_on(next, until);
      if (is_busy_) end(ContactStatus::kBusy, 0, 1);
      if (ended || is_busy_) return true;
      if (next.from < until) {
        std::push_heap(waiting_.begin(), waiting_.end(), Waiting::later);
      } else {
        waiting_.pop_back();
      }
    }
    return false;
  }
  // Returns a time that leaves half of the tolerance, so that the last distance is not all
  // rounding.
  [[nodiscard]] double shorter(double time) const {
    return time * way_ >= tolerance_ ? time - 0.5 * tolerance_ / way_ : time;
  }
  // Lets one pair go on until it may meet. Returns whether it does meet, which ends the search.
  bool go_on(Waiting& pair, double until) {
    const double at = pair.from;
    const Moment now(*this, at);
    const TriangleCorners fixed = fixed_corners(pair.ids.fixed),
                          moving = now.moving[pair.ids.moving];
    const MovingPair here(fixed, moving, part_);
    const MovingPair::Free free = here.free_time(until - at);
    if (free.time > 0) pair.axis = free.axis;
    pair.from = at + free.time;
    if (pair.from >= until) return false;
    const double way = free.time * way_;
    if (way >= tolerance_) {
      pair.from = at + shorter(free.time);
      return false;
    }
    const double last = step(at, tolerance_);
    const double soon = std::min(last, step(at, 2 * way + rounding_ / kStuck));
    for (const double then : {last, soon}) {
      if (meet(pair.ids, then)) return meets({at, then}, pair, fixed, moving);
    }
    if (way * kSlowSteps >= tolerance_) return false;
    // Other triangles may meet there, as the sides of a thin plate do.
    for (const double then : {last, soon}) {
      if (!meet_at(then)) continue;
      const TrianglePair triangles = first_at(then);
      meets({at, then}, pair, fixed, moving);
      found_.triangles = triangles;
      return true;
    }
    const double before = std::max(0.0, at - (last - at));
    const TriangleCorners was = Moment(*this, before).moving[pair.ids.moving],
                          then = Moment(*this, last).moving[pair.ids.moving];
    if (MovingPair(fixed, was, part_).passes_until(MovingPair(fixed, then, part_), last - before)) {
      found_.passes = true;
      return meets({at, last}, pair, fixed, moving);
    }
    if (!found_.grazed) {
      graze_ = {at, last};
      found_.distance = {0, closest_points(fixed, moving, {}).distance + rounding_};
    }
    graze_.second = std::max(graze_.second, last);
    found_.grazed = true;
    pair.from = last;
    return false;
  }
  [[nodiscard]] bool meet(TriangleIds ids, double at) {
    ++found_.verdicts;
    return triangles_meet(fixed_corners(ids.fixed), Moment(*this, at).moving[ids.moving]);
  }
  // Ends the search with a contact of a pair between two parameters.
  bool meets(std::pair<double, double> between, const Waiting& pair, const TriangleCorners& fixed,
             const TriangleCorners& moving) {
    const TrianglePair triangles{pair.ids.fixed, pair.ids.moving};
    found_.triangles = triangles;
    const NearPair nearest = closest_points(fixed, moving, triangles);
    found_.place = nearest;
    const bool is_sharp = nearest.distance > kSharp * rounding_;
    const std::optional<Direction> axis = direction_of(pair.axis);
    if (is_sharp || axis) found_.normal = is_sharp ? nearest.direction() : axis->unit;
    found_.distance = {0, nearest.distance + rounding_};
    end(ContactStatus::kContact, grazed_at(between.first), between.second);
    return true;
  }

  Query& query_;
  const Motion& motion_;
  const FirstContactOptions& options_;
  double way_;  // of the fastest point
  double rounding_ = 0, tolerance_ = 0;
  ScrewPart part_;  // the last one that was listed
  FirstContact found_;
  std::size_t most_ = kFewPairs;  // of a list
  SweptList listed_;              // that may meet on it
  std::vector<Waiting> waiting_;  // a heap
  int quiet_parts_ = 0;           // since a list was too long, or a contact was found
  double contact_ = HUGE_VAL;     // a parameter at which the bodies meet
  bool is_busy_ = false;          // another thread uses the query
  double asked_ = -1;             // the last parameter that the caller was told
  std::pair<double, double> graze_{0, 0};
};

}  // namespace

const char* to_string(ContactStatus status) noexcept {
  constexpr std::array kNames = {"contact",         "none",    "grazing", "touches-at-start",
                                 "inside-at-start", "stopped", "busy"};
  const auto at = static_cast<std::size_t>(status);
  return at < kNames.size() ? kNames[at] : "unknown";
}

FirstContact first_contact(Query& query, const Motion& motion, double tolerance,
                           const FirstContactOptions& options) {
  const ScopedFloatEnvironment environment;
  require_triangles(query.fixed(), "fixed");
  require_triangles(query.moving(), "moving");
  require_tolerance(tolerance);
  return Advance(query, motion, tolerance, options).run();
}

FirstContact first_contact(Query& query, const Eigen::Isometry3d& from, const Eigen::Isometry3d& to,
                           double tolerance, const FirstContactOptions& options) {
  return first_contact(query, Motion::between(from, to), tolerance, options);
}

}  // namespace ist
