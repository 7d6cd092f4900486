#include "ist/measure/first_contact.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "ist/base/float_environment.h"
#include "ist/base/rigid_move.h"
#include "ist/measure/point_search.h"
#include "ist/measure/require.h"

namespace ist {
namespace {

using ContactStatus = FirstContact::Status;

// The least part of the tolerance that rounding may take from a distance.
constexpr double kStuck = 1.0 / 16;
// Within the tolerance of each other, bodies go on in so many steps at most for a way as long as
// the tolerance, each no longer than their distance is certain to be.
constexpr int kSlowSteps = 64;
// So many times the way of their distance, they are looked at as well: something thin may be there.
constexpr double kAhead = 2;
// How sharp a distance is asked for, as a part of the one before.
constexpr double kSharp = 1.0 / 16;

// Of vertices in use: others may lie anywhere.
double longest_way(const Motion& motion, const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.vertices.size());
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) used[v] = true;
  }
  std::vector<Eigen::Vector3d> points;
  points.reserve(used.size());
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v]) points.push_back(mesh.vertices[v]);
  }
  return motion.longest_way(points) * (1 + 0x1p-40);
}

bool is_inside_other(const Query& query, const Eigen::Isometry3d& pose) {
  const ClusterKernels& kernels = select_kernels(query.target()).clusters;
  const SphereTree &fixed = query.fixed(), &moving = query.moving();
  const auto holds = [&](const SphereTree& body, const SphereTree& surface,
                         const Eigen::Isometry3d& to_body) {
    if (body.orientation() != Orientation::kOutward) return false;
    const PointSearch search(body, kernels);
    return is_any_inside({surface, body, search, RigidMove(to_body)});
  };
  return holds(fixed, moving, pose) || holds(moving, fixed, inverse_of(pose));
}

// A search along one motion.
class Advance {
 public:
  Advance(Query& query, const Motion& motion, double tolerance, const FirstContactOptions& options)
      : query_(query),
        motion_(motion),
        options_(options),
        wanted_(tolerance),
        way_(longest_way(motion, *query.moving().triangles())) {
    const auto size = [](const SphereTree& tree) {
      return tree.bounding_radius() + tree.origin().cwiseAbs().maxCoeff();
    };
    // Of a pose on the way: the longest way of a point counts too.
    rounding_ = 0x1p-42 * (size(query.fixed()) + size(query.moving()) + way_ +
                           motion.at(0).translation().cwiseAbs().maxCoeff());
    found_.rotation_error = motion.rotation_error();
    limit_tolerance(0);
  }

  FirstContact run() {
    query_.forget();
    const IntersectionResult start = query_.intersects(motion_.at(0));
    if (start.status == QueryStatus::kBusy) return end(ContactStatus::kBusy, 0, 1);
    found_.verdicts = 1;
    if (start.answer == Answer::kYes) {
      name_triangles(0);
      if (is_busy_) return end(ContactStatus::kBusy, 0, 1);
      found_.distance = {0, 0};
      return end(ContactStatus::kTouchesAtStart, 0, 0);
    }
    found_.fixed_self_intersecting = query_.fixed().self_intersections() > 0;
    found_.moving_self_intersecting = query_.moving().self_intersections() > 0;
    if (is_inside_other(query_, motion_.at(0))) return end(ContactStatus::kInsideAtStart, 0, 0);
    double at = 0;
    while (at < 1) {
      if (!goes_on(at)) return end(ContactStatus::kStopped, grazed_at(at), 1);
      const double apart = distance_at(at), safe = step(at, apart);
      if (is_busy_) return end(ContactStatus::kBusy, 0, 1);
      if (apart >= tolerance_) {
        at = safe;
        continue;
      }
      const double near = step(at, tolerance_);
      for (const double then : {near, std::min(near, step(at, kAhead * found_.distance.upper))}) {
        const bool met = meet(then);
        if (met) name_triangles(then);
        if (is_busy_) return end(ContactStatus::kBusy, 0, 1);
        if (met) return end(ContactStatus::kContact, grazed_at(at), then);
      }
      if (at >= slow_until_) {
        slow_until_ = near;
        slow_steps_ = 0;
      }
      if (apart > 0 && slow_steps_++ < kSlowSteps) {
        at = safe;
        continue;
      }
      if (!found_.grazed) graze_.first = at;
      graze_.second = near;
      found_.grazed = true;
      at = near;
    }
    return found_.grazed ? end(ContactStatus::kGrazing, graze_.first, graze_.second)
                         : end(ContactStatus::kNone, 1, 1);
  }

 private:
  FirstContact end(ContactStatus status, double lower, double upper) {
    found_.status = status;
    found_.lower = lower;
    found_.upper = upper;
    return found_;
  }
  // Where the surfaces first were so near that they may have met unseen.
  [[nodiscard]] double grazed_at(double at) const { return found_.grazed ? graze_.first : at; }
  [[nodiscard]] bool goes_on(double at) const {
    if (found_.distances >= options_.budget.tests || options_.budget.is_past()) return false;
    return !options_.proceed || options_.proceed(at);
  }
  // Where the point that goes farthest is farther by so much.
  [[nodiscard]] double step(double at, double by) const {
    return by < way_ * (1 - at) ? at + by / way_ : 1;
  }
  // Rounding of a distance at one pose limits the tolerance there. It says nothing about the next
  // pose: rounding is less where the bodies are near.
  void limit_tolerance(double narrowest) {
    found_.narrowest = (narrowest + rounding_) / kStuck;
    tolerance_ = std::max(wanted_, found_.narrowest);
  }
  // No more than the distance of the surfaces, and little less.
  double distance_at(double at) {
    double sharp = kSharp * found_.distance.lower;
    do {
      sharp = std::max(sharp, kSharp * kStuck * tolerance_);
      const DistanceResult asked = query_.distance(motion_.at(at), sharp);
      if (note_busy(asked.status)) return 0;
      ++found_.distances;
      found_.distance = asked.distance;
      limit_tolerance(asked.narrowest);
      if (sharp <= kSharp * std::max(found_.distance.upper, kStuck * tolerance_)) break;
      sharp = kSharp * found_.distance.upper;
    } while (found_.distances < options_.budget.tests);
    return found_.distance.lower - rounding_;
  }
  [[nodiscard]] bool meet(double at) {
    ++found_.verdicts;
    const IntersectionResult asked = query_.intersects(motion_.at(at));
    return !note_busy(asked.status) && asked.answer == Answer::kYes;
  }
  void name_triangles(double at) {
    std::array<TrianglePair, 1> first;
    if (!note_busy(query_.triangle_pairs(motion_.at(at), first).status)) {
      found_.triangles = first[0];
    }
  }
  // Another thread uses the query: no answer counts.
  bool note_busy(QueryStatus status) {
    is_busy_ = is_busy_ || status == QueryStatus::kBusy;
    return is_busy_;
  }

  Query& query_;
  const Motion& motion_;
  const FirstContactOptions& options_;
  double wanted_;  // the tolerance that the caller gave
  double way_;     // of the point that goes farthest
  double rounding_ = 0, tolerance_ = 0;
  FirstContact found_;
  bool is_busy_ = false;
  std::pair<double, double> graze_{0, 0};
  double slow_until_ = 0;
  int slow_steps_ = 0;
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
