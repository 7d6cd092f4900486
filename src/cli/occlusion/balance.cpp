#include "cli/occlusion/balance.h"

#include <cmath>

namespace ist::cli {
namespace {

// The part of a sum that lies on the first side of a plane.
struct Parted {
  double first = 0, all = 0;

  void add(double pressed, double part) {
    first += part * pressed;
    all += pressed;
  }
  [[nodiscard]] Balance::Shares shares() const {
    if (!(all > 0)) return {};
    const double percent = 100 * first / all;
    return {percent, 100 - percent, std::abs(2 * percent - 100)};
  }
};

}  // namespace

std::optional<Balance> balance_of(const SurfaceOcclusion& surface, const TriangleMesh& mesh,
                                  const Eigen::Isometry3d& to_fixed, const Division& division) {
  Parted parted, thinner, thicker;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const ContactRegion& region : surface.regions) {
    for (const ContactTriangle& contact : region.triangles) {
      const Triangle& corners = mesh.triangles[contact.triangle];
      const Eigen::Vector3d middle =
          to_fixed * Eigen::Vector3d((mesh.vertices[corners[0]] + mesh.vertices[corners[1]] +
                                      mesh.vertices[corners[2]]) /
                                     3);
      const double beyond = division.direction.dot(middle) - division.at;
      const double part = beyond > 0 ? 1 : beyond < 0 ? 0 : 0.5;
      parted.add(contact.pressed, part);
      thinner.add(contact.pressed_thinner, part);
      thicker.add(contact.pressed_thicker, part);
      moment += contact.pressed * middle;
    }
  }
  if (!(parted.all > 0)) return {};
  return Balance{parted.shares(), thinner.shares(), thicker.shares(), moment / parted.all};
}

}  // namespace ist::cli
