#include "ist/measure/free_test.h"

#include "ist/base/rigid_move.h"
#include "ist/measure/point_search.h"

namespace ist {
namespace {

// Returns whether a component of one body lies inside the other body, if that one is closed.
// Precondition: the surfaces do not intersect.
bool is_one_inside(const Query& query, const Eigen::Isometry3d& pose) {
  const ClusterKernels& kernels = select_kernels(query.target()).clusters;
  const auto holds = [&](const SphereTree& body, const SphereTree& surface,
                         const Eigen::Isometry3d& to_body) {
    if (body.orientation() != Orientation::kOutward) return false;
    const PointSearch search(body, kernels);
    return is_any_inside({surface, body, search, RigidMove(to_body)});
  };
  return holds(query.fixed(), query.moving(), pose) ||
         holds(query.moving(), query.fixed(), inverse_of(pose));
}

}  // namespace

bool FreeTest::at(const Eigen::Isometry3d& pose) {
  if (is_ended()) return false;
  // What is left to ask is not known: the part that is told approaches 1.
  const auto asked = static_cast<double>(verdicts_);
  if (proceed_ && !proceed_(asked / (asked + 256))) {
    is_stopped_ = true;
    return false;
  }
  ++verdicts_;
  const IntersectionResult surfaces = query_.intersects(pose);
  is_busy_ = surfaces.status == QueryStatus::kBusy;
  return surfaces.status == QueryStatus::kDone && surfaces.answer == Answer::kNo &&
         !is_one_inside(query_, pose);
}

}  // namespace ist
