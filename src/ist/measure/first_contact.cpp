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
#include "ist/measure/pair_advance.h"
#include "ist/measure/point_search.h"
#include "ist/measure/require.h"
#include "ist/query/swept_clusters.h"
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
// A list of more pairs of clusters costs more than two lists of half the way.
constexpr std::size_t kFewPairs = 512;
// A list may be longer if the way was halved so often.
constexpr int kMostHalves = 4;

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

// The box round a triangle, and the velocities of its corners along each axis.
struct BoxOnTheWay {
  std::uint32_t id;
  double low[3], high[3], least[3], most[3], bend;

  BoxOnTheWay() noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = HUGE_VAL;
      high[i] = -HUGE_VAL;
    }
  }
  void set(const TriangleCorners& t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      std::tie(low[i], high[i]) = std::minmax({t[0][axis], t[1][axis], t[2][axis]});
    }
  }
  void set(const TriangleCorners& t, const ScrewPart& part) {
    set(t);
    const TriangleCorners v = {part.velocity(t[0]), part.velocity(t[1]), part.velocity(t[2])};
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      std::tie(least[i], most[i]) = std::minmax({v[0][axis], v[1][axis], v[2][axis]});
      square = std::max(square, square_in_order(v[i]));
    }
    bend = part.bend(std::sqrt(square));
  }
  void hold(const BoxOnTheWay& other) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], other.low[i]);
      high[i] = std::max(high[i], other.high[i]);
    }
  }
  // Returns the time before which the box, which moves, does not meet one that does not move.
  [[nodiscard]] double time_to(const BoxOnTheWay& fixed, double pad) const {
    double time = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double above = (low[i] - fixed.high[i]) - pad, below = (fixed.low[i] - high[i]) - pad;
      if (above > 0) time = std::max(time, free_time(above, -least[i], bend));
      if (below > 0) time = std::max(time, free_time(below, most[i], bend));
    }
    return time;
  }
};

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
    part_ = {Pose::Identity(), motion.turning(), motion.velocity({0, 0, 0}), 0, way_, rounding_};
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
    for (double at = 0; at < 1;) {
      const std::optional<double> until = list_pairs(at);
      if (!until || advance(*until)) return found_;
      at = *until;
    }
    return found_.grazed ? end(ContactStatus::kGrazing, graze_.first, graze_.second)
                         : end(ContactStatus::kNone, 1, 1);
  }

 private:
  // Two triangles, or two clusters of triangles, that do not meet before a parameter.
  struct Waiting {
    double from;
    TriangleIds ids;
    bool are_clusters;
    Eigen::Vector3d axis = {0, 0, 0};  // parts the triangles, as far as it is known

    // The least parameter is on top of a heap.
    [[nodiscard]] static bool later(const Waiting& a, const Waiting& b) noexcept {
      return std::tie(a.from, b.are_clusters, a.ids) > std::tie(b.from, a.are_clusters, b.ids);
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
    std::array<TrianglePair, 1> first;
    const Moment start(*this, 0);
    if (query_.triangle_pairs(start.pose, first).status == QueryStatus::kBusy) {
      return end(ContactStatus::kBusy, 0, 1);
    }
    found_.triangles = first[0];
    found_.place =
        closest_points(fixed_corners(first[0].fixed), start.moving[first[0].moving], first[0]);
    found_.distance = {0, 0};
    return end(ContactStatus::kTouchesAtStart, 0, 0);
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

  // Lists the clusters that may meet from a parameter on, for a part of the motion. Returns the end
  // of the part; nothing if the search has ended.
  std::optional<double> list_pairs(double at) {
    std::size_t most = kFewPairs;
    double until = at < crowded_ ? at + 0.5 * (crowded_ - at) : 1;
    for (int halves = 0;; ++halves) {
      if (!goes_on(at)) return std::nullopt;
      const double middle = at + 0.5 * (until - at);
      part_.middle = *project_to_rigid(motion_.at(middle));
      part_.half = std::max(until - middle, middle - at);
      ++found_.distances;
      const SweptClustersResult listed =
          swept_clusters(query_, part_, most, options_.budget, clusters_);
      if (listed.status == QueryStatus::kBusy) {
        end(ContactStatus::kBusy, 0, 1);
        return std::nullopt;
      }
      if (!listed.complete) {
        end(ContactStatus::kStopped, grazed_at(at), 1);
        return std::nullopt;
      }
      if (listed.fits) {
        waiting_.clear();
        for (const SweptPair& pair : clusters_) {
          waiting_.push_back({std::max(at, middle + pair.after), {pair.fixed, pair.moving}, true});
        }
        return until;
      }
      crowded_ = until;
      until = middle;
      if (halves >= kMostHalves) most *= 2;
    }
  }

  // Lets the pairs that wait go on, always the one with the least parameter. Returns whether the
  // search has ended.
  bool advance(double until) {
    std::make_heap(waiting_.begin(), waiting_.end(), Waiting::later);
    while (!waiting_.empty()) {
      std::pop_heap(waiting_.begin(), waiting_.end(), Waiting::later);
      Waiting next = waiting_.back();
      waiting_.pop_back();
      if (next.from >= until) continue;
      if (!goes_on(next.from)) return true;
      ++found_.distances;
      if (next.are_clusters) {
        split(next, until);
        continue;
      }
      if (go_on(next, until)) return true;
      if (next.from < until) wait(next);
    }
    return false;
  }
  void wait(const Waiting& pair) {
    waiting_.push_back(pair);
    std::push_heap(waiting_.begin(), waiting_.end(), Waiting::later);
  }
  // Lists the pairs of triangles of two clusters that may meet before a parameter.
  void split(const Waiting& pair, double until) {
    const double at = pair.from, most = until - at;
    const Moment now(*this, at);
    std::array<BoxOnTheWay, kClusterWidth> fixed, moving;
    const std::size_t fixed_count = members(query_.fixed(), pair.ids.fixed, fixed);
    const std::size_t moving_count = members(query_.moving(), pair.ids.moving, moving);
    BoxOnTheWay all;
    for (std::size_t k = 0; k < fixed_count; ++k) {
      fixed[k].set(fixed_corners(fixed[k].id));
      all.hold(fixed[k]);
    }
    for (std::size_t m = 0; m < moving_count; ++m) {
      moving[m].set(now.moving[moving[m].id], part_);
      if (!(moving[m].time_to(all, rounding_) < most)) continue;
      for (std::size_t k = 0; k < fixed_count; ++k) {
        const double time = moving[m].time_to(fixed[k], rounding_);
        if (time < most) wait({at + time, {fixed[k].id, moving[m].id}, false});
      }
    }
  }
  // Sets the triangles of a cluster. Returns their number.
  static std::size_t members(const SphereTree& tree, std::uint32_t cluster,
                             std::array<BoxOnTheWay, kClusterWidth>& out) {
    const TriangleClusters& clusters = parts_of(tree).triangles->clusters;
    const std::uint32_t count = clusters.child_count(-1, cluster);
    for (std::size_t k = 0; k < count; ++k) out[k].id = clusters.clusters()[cluster].id[k];
    return count;
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
      pair.from -= 0.5 * tolerance_ / way_;  // so that the last distance is more than rounding
      return false;
    }
    const double last = step(at, tolerance_);
    for (const double then : {last, std::min(last, step(at, 2 * way + rounding_ / kStuck))}) {
      if (meet(pair.ids, then)) return meets({at, then}, pair, fixed, moving);
    }
    if (way * kSlowSteps >= tolerance_) return false;
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
  std::vector<SweptPair> clusters_;  // that may meet on it
  std::vector<Waiting> waiting_;     // a heap
  double crowded_ = 0;               // the end of a part whose list was too long
  double asked_ = -1;                // the last parameter that the caller was told
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
