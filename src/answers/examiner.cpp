#include "answers/examiner.h"

#include <fmt/format.h>

#include <algorithm>

#include "answers/extents.h"
#include "ist/base/counted.h"
#include "ist/base/pose.h"

namespace ist::answers {
namespace {

// A person reads no finer: 0.01 mm of a jaw of 100 mm.
constexpr double kDefaultTolerance = 1e-4;

// Returns the box of a body without a certain inside, and an empty box for any other body.
Eigen::AlignedBox3d open_box(const SphereTree& body, bool triangles) {
  const bool certain = triangles && body.orientation() == Orientation::kOutward;
  return certain ? Eigen::AlignedBox3d() : box_of(body);
}

}  // namespace

const char* to_string(Meeting meeting) {
  switch (meeting) {
    case Meeting::kTouch:
      return "the bodies touch";
    case Meeting::kInside:
      return "one body lies in the other";
    case Meeting::kMayTouch:
      return "the bodies may touch";
    case Meeting::kMayBeInside:
      return "the surfaces are apart; whether one body lies in the other is unknown";
    case Meeting::kUnknown:
      return "whether the bodies touch is unknown: allow more --max-tests";
    default:
      return "the bodies are apart";
  }
}

Meeting Findings::meeting() const {
  if (touch == Answer::kYes) return Meeting::kTouch;
  if (inside && *inside != Inside::kNone) return Meeting::kInside;
  if (touch == Answer::kNear) return Meeting::kMayTouch;
  if (touch == Answer::kUnknown) return Meeting::kUnknown;
  return inside ? Meeting::kNone : Meeting::kMayBeInside;
}

Examiner::Examiner(const Bodies& bodies, const Questions& questions, const std::string& target)
    : bodies_(bodies),
      questions_(questions),
      budget_{questions.max_tests.value_or(Budget().tests)},
      distance_tolerance_(questions.distance.value_or(kDefaultTolerance * bodies.extent())),
      depth_tolerance_(questions.depth.value_or(kDefaultTolerance * bodies.extent())),
      query_(bodies.fixed, bodies.moving, {.policy = bodies.query_policy(), .target = target}),
      open_fixed_(open_box(bodies.fixed, query_.has_triangles())),
      open_moving_(open_box(bodies.moving, query_.has_triangles())) {
  if (questions.triangle_pairs || questions.depth || questions.escape) require_triangles(bodies);
  if (bodies.have_voxels()) manifold_.emplace(bodies.fixed, bodies.moving, bodies.policy);
  depth_.emplace(query_, bodies, depth_tolerance_);
  if (query_.has_triangles()) {
    inside_.emplace(*bodies.fixed.triangles(), *bodies.moving.triangles());
  }
}

Findings Examiner::at(const Eigen::Isometry3d& pose) {
  query_.forget();
  Findings found;
  find_distance(pose, found);
  find_touch(pose, found);
  find_inside(pose, found);
  const bool near = found.touch == Answer::kYes || found.distance->lower <= depth_->open_reach();
  found.depth = depth_->at(pose, near, budget_);
  // Open surfaces may meet although no vertex lies behind the other one.
  if (!found.depth.certain && found.touch != Answer::kNo && found.depth.at_vertices == 0.0) {
    found.depth.at_vertices.reset();
  }
  if (found.touch == Answer::kNo && !found.depth.certain && found.depth.area > 0.0) {
    found.inside.reset();
    found.notes.emplace_back(
        "apart, or in each other: a part lies behind an open surface, which has no inside");
  }
  if (!found.depth.certain && found.touch != Answer::kNo) {
    found.notes.push_back(depth_->why_none(found.depth));
  }
  if (found.depth.certain && !found.depth.complete) {
    const char* const why = found.depth.capped     ? ": the search ended after 4 million pieces"
                            : questions_.max_tests ? ": allow more --max-tests"
                                                   : "";
    found.notes.push_back(fmt::format("depth: asked to {:g}, reached {:.3g}{}", depth_tolerance_,
                                      found.depth.certain->upper - found.depth.certain->lower,
                                      why));
  }
  find_self_intersections(found);
  find_contacts(pose, found);
  if (questions_.triangle_pairs) count_triangles(pose, found);
  if (questions_.escape) find_escape(pose, found);
  return found;
}

void Examiner::find_distance(const Eigen::Isometry3d& pose, Findings& found) {
  const DistanceResult result = query_.distance(pose, distance_tolerance_, budget_);
  found.distance = result.distance;
  found.narrowest = result.narrowest;
  found.nearest = result.nearest;
  found.rotation_error = result.rotation_error;
  if (result.complete || !questions_.distance) return;
  const double width = result.distance.upper - result.distance.lower;
  found.notes.push_back(fmt::format(
      "distance: asked to {:g}, reached {:.3g}: {}", distance_tolerance_, width,
      questions_.max_tests
          ? "allow more --max-tests"
          : (query_.has_triangles() ? "the rest is rounding" : "build with triangles")));
}

void Examiner::find_touch(const Eigen::Isometry3d& pose, Findings& found) {
  const IntersectionResult result = query_.intersects(pose, budget_);
  found.touch = result.answer;
  // Within a budget nothing is called free that is not known to have a distance.
  const bool free = found.touch == Answer::kNo && found.distance->lower > 0;
  if (questions_.max_tests && found.touch == Answer::kNo && !free) found.touch = Answer::kUnknown;
  if (found.touch == Answer::kUnknown) {
    found.notes.push_back(fmt::format("stopped: {:.3g} to {:.3g} apart: allow more --max-tests",
                                      found.distance->lower, found.distance->upper));
  }
  if (found.touch == Answer::kNear) {
    found.notes.push_back(fmt::format("at most {:.3g} apart", found.distance->upper));
  }
}

void Examiner::find_inside(const Eigen::Isometry3d& pose, Findings& found) const {
  if (found.touch == Answer::kYes) found.inside = Inside::kNone;
  if (found.touch != Answer::kNo) return;
  const Eigen::Isometry3d to_fixed = *project_to_rigid(pose),
                          to_moving = to_fixed.inverse(Eigen::Isometry);
  if (!inside_) {
    if (open_fixed_.intersects(open_moving_.transformed(to_fixed))) {
      found.notes.emplace_back("inside is not known without triangles");
    } else {
      found.inside = Inside::kNone;
    }
    return;
  }
  const Inside inside = inside_->at(to_fixed);
  const bool fixed_might =
      open_fixed_.contains(to_fixed * query_.moving().triangles()->vertices.front());
  const bool moving_might =
      open_moving_.contains(to_moving * query_.fixed().triangles()->vertices.front());
  if (fixed_might || (moving_might && inside != Inside::kMoving)) {
    found.notes.push_back(fmt::format("inside is not known: {} is open or not wound consistently",
                                      name_of(!fixed_might)));
    return;
  }
  found.inside = inside;
}

void Examiner::find_self_intersections(Findings& found) const {
  if (!query_.has_triangles()) return;
  found.self_intersecting = false;
  const bool matters = found.depth.certain || (found.inside && *found.inside != Inside::kNone);
  for (const bool moving : {false, true}) {
    const std::uint64_t pairs = (moving ? query_.moving() : query_.fixed()).self_intersections();
    if (pairs == 0) continue;
    found.self_intersecting = true;
    if (!matters) continue;
    found.notes.push_back(
        fmt::format("{} intersects itself in {} of triangles: inside is by winding numbers",
                    name_of(moving), counted(pairs, "pair")));
  }
}

void Examiner::find_contacts(const Eigen::Isometry3d& pose, Findings& found) {
  if (!manifold_) return;
  const QueryResult result = query_.contacts(pose, *manifold_, budget_);
  if (!result.complete) return;
  found.contacts = manifold_->points().size();
  for (const Contact& contact : manifold_->points()) {
    found.contact_depth = std::max(found.contact_depth.value_or(contact.depth), contact.depth);
  }
}

void Examiner::find_escape(const Eigen::Isometry3d& pose, Findings& found) {
  std::uint64_t asked = 0;
  const auto goes_on = [&](double) { return asked++ < budget_.tests; };
  found.escape = escape(query_, pose, {.tolerance = depth_tolerance_, .proceed = goes_on});
  if (found.escape->status != Escape::Status::kUnknown) return;
  found.notes.emplace_back("escape: stopped before a motion was found: allow more --max-tests");
}

void Examiner::count_triangles(const Eigen::Isometry3d& pose, Findings& found) {
  const TrianglePairsResult result = query_.triangle_pairs(pose, {}, budget_);
  if (result.complete) found.triangle_pairs = result.triangle_pairs;
}

}  // namespace ist::answers
