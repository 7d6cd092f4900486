#include "query/contacts/form_errors.h"

#include <algorithm>
#include <cmath>

#include "ist/tree/sphere_tree.h"
#include "query/contacts/contact_cases.h"

namespace ist::test {

void FormErrors::add(const FormErrors& other) {
  points += other.points;
  smooth += other.smooth;
  finite = finite && other.finite;
  depth = std::max(depth, other.depth);
  depths += other.depths;
  normal = std::max(normal, other.normal);
  normals += other.normals;
  deepest = std::max(deepest, other.deepest);
}

SphereTree tree_of_solid(const Solid& solid, double voxel_size) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  return build_tree(solid.mesh(voxel_size), options);
}

FormErrors form_errors(const ClosedForm& form, const SphereTree& fixed, const SphereTree& moving,
                       SpherePolicy policy, double depth, std::size_t most) {
  constexpr double kDegrees = 57.29577951308232;
  const double s = fixed.voxel_size();
  const Eigen::Isometry3d pose = form.pose(depth * s);
  FormErrors errors;
  for (const Contact& p : find_contacts(fixed, moving, policy, pose, most).points) {
    ++errors.points;
    errors.finite = errors.finite && p.position.allFinite() && p.normal.allFinite() &&
                    std::isfinite(p.depth) && std::isfinite(p.weight);
    errors.deepest = std::max(errors.deepest, p.depth / s);
    if (p.weight < 0.05 * s * s) continue;  // normals that cancel have no direction
    if (!form.fixed.smooth(p.position, 10 * s) ||
        !form.moving.smooth(pose.inverse() * p.position, 10 * s)) {
      continue;
    }
    const double truth = std::clamp(form.depth(pose, p.position), -2 * s, s);
    const double off = std::abs(p.depth - truth) / s;
    const double cosine = p.normal.dot(form.normal(pose, p.position));
    const double tilt = kDegrees * std::acos(std::min(1.0, cosine));
    ++errors.smooth;
    errors.depth = std::max(errors.depth, off);
    errors.depths += off;
    errors.normal = std::max(errors.normal, tilt);
    errors.normals += tilt;
  }
  return errors;
}

}  // namespace ist::test
