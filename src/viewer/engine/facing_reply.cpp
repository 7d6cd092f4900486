#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "answers/extents.h"
#include "answers/measure_progress.h"
#include "answers/occlusion/bite_direction.h"
#include "answers/occlusion/sides.h"
#include "ist/measure/occlusion.h"
#include "viewer/engine/replies.h"

namespace ist::viewer {
namespace {

// How far to look, of the smaller body's extent: 2 mm of a jaw, which is quick; then 10 mm, for
// jaws that are open.
constexpr double kReaches[] = {0.02, 0.1};
constexpr double kLongestEdge = 0.02;

bool any_near(const SurfaceOcclusion& surface) {
  return std::any_of(surface.vertices.begin(), surface.vertices.end(),
                     [](const SurfaceDistance& one) { return !std::isnan(one.distance); });
}

nlohmann::ordered_json numbers_of(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

}  // namespace

void fill_facing(const answers::Bodies& bodies, const Asked& asked, Progress& progress,
                 Reply& reply) {
  reply.json = {{"known", false}};
  if (bodies.fixed.triangles() == nullptr || bodies.moving.triangles() == nullptr) return;
  Query query(bodies.fixed, bodies.moving, {.policy = bodies.query_policy()});
  const Eigen::Isometry3d pose = asked.pose("pose");
  const double extent = bodies.extent();
  OcclusionOptions options;
  options.limits.clear();
  options.contact = options.foundation = options.change = 0;
  options.longest_edge = kLongestEdge * extent;
  options.proceed = answers::shown_by(progress, "looking where the bodies face each other");
  Occlusion found;
  for (const double part : kReaches) {
    options.reach = part * extent;
    found = occlusion(query, pose, options);
    if (any_near(found.fixed) || any_near(found.moving)) break;
  }
  answers::SideOptions named;
  named.frame = asked.text_or_none("frame");
  const auto [sides, fore_aft] =
      answers::divisions(named, bodies.frame(), answers::box_of(bodies.fixed));
  const answers::FacingBody fixed(*bodies.fixed.triangles(), found.fixed.vertices,
                                  Eigen::Isometry3d::Identity());
  const answers::FacingBody moving(*bodies.moving.triangles(), found.moving.vertices, pose);
  const answers::BiteDirections ways =
      answers::directions_of(fixed, moving, options.reach, sides, fore_aft);
  Eigen::Index upright = 0;
  ways.towards.cwiseAbs().maxCoeff(&upright);
  reply.json = {{"known", any_near(found.fixed) || any_near(found.moving)},
                {"towards", numbers_of(ways.towards)},
                {"front", numbers_of(ways.front)},
                {"upper", ways.towards[upright] > 0 ? "moving" : "fixed"}};
}

}  // namespace ist::viewer
