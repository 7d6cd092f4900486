#include "query/contacts/closed_forms.h"

#include <algorithm>
#include <cmath>

#include "ist/tree/sphere_tree.h"
#include "query/contacts/contact_cases.h"
#include "query/query_cases.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Solid sphere(double radius) {
  return {[radius](double edge) {
            int level = 0;
            for (double longest = 1.26 * radius; longest > edge; longest /= 2) ++level;
            return icosphere(level, radius);
          },
          [radius](const Vector3d& p) { return p.norm() - radius; },
          [radius](const Vector3d&, double least) { return radius > least; }};
}

// Each face has two triangles at any edge length, because they are exact. It is smooth away from
// its edges.
Solid block(const Vector3d& half) {
  return {[half](double) { return box(-half, half); },
          [half](const Vector3d& p) {
            const Vector3d out = p.cwiseAbs() - half;
            return out.maxCoeff() > 0 ? out.cwiseMax(0).norm() : out.maxCoeff();
          },
          [half](const Vector3d& p, double least) {
            const Vector3d out = (p.cwiseAbs() - half).cwiseAbs();  // from each pair of planes
            Vector3d sorted = out;
            std::sort(sorted.begin(), sorted.end());
            return sorted[1] > least / 4;
          }};
}

// A tube, or a cylinder if `inner` is 0. The distance is to its inner wall, or to its only one.
Solid wall(double inner, double outer, double half) {
  return {[=](double edge) { return tube(inner, outer, half, edge); },
          [=](const Vector3d& p) {
            const double radius = std::hypot(p[0], p[1]);
            return inner > 0 ? inner - radius : radius - outer;
          },
          [=](const Vector3d& p, double least) {
            return (inner > 0 ? inner : outer) > least && half - std::abs(p[2]) > least / 4;
          }};
}

Solid ring(double radius, double tube) {
  return {
      [=](double edge) {
        const auto parts = [edge](double r) {
          return static_cast<int>(std::ceil(6.283185307179586 * r / edge));
        };
        return torus(radius, tube, parts(radius + tube), parts(tube));
      },
      [=](const Vector3d& p) { return std::hypot(std::hypot(p[0], p[1]) - radius, p[2]) - tube; },
      [=](const Vector3d& p, double least) {
        // The radii of curvature of the tube, and along the ring: R / cos + r, negative on the
        // inside.
        const double out = (std::hypot(p[0], p[1]) - radius) / tube;
        return tube > least && (out == 0 || std::abs(radius / out + tube) > least);
      }};
}

// The same, its mesh and its surface turned.
Solid turned(const Solid& solid, const Matrix3d& by) {
  return {[=](double edge) { return test::turned(solid.mesh(edge), by); },
          [=](const Vector3d& p) { return solid.distance(by.transpose() * p); },
          [=](const Vector3d& p, double least) { return solid.smooth(by.transpose() * p, least); }};
}

// Turns both bodies and their pose. `pose` is the pose before the turn.
ClosedForm turned(const ClosedForm& form, const Matrix3d& fixed, const Matrix3d& moving) {
  return {form.name, turned(form.fixed, fixed), turned(form.moving, moving), [=](double depth) {
            return pose_of(fixed, Vector3d::Zero()) * form.pose(depth) *
                   pose_of(moving.transpose(), Vector3d::Zero());
          }};
}

std::vector<ClosedForm> make() {
  const auto along = [](const Vector3d& from, const Vector3d& direction) {
    return [=](double depth) { return shift(from - depth * direction); };
  };
  const Vector3d x = Vector3d::UnitX(), z = Vector3d::UnitZ();
  Matrix3d tipped;  // an edge of the moving box downwards
  const double half_root = std::sqrt(0.5);
  tipped << half_root, 0, half_root, 0, 1, 0, -half_root, 0, half_root;

  const Solid cube = block({2, 2, 2}), table = block({4, 4, 1});
  std::vector<ClosedForm> forms;
  forms.push_back({"boxes_in_the_grid", table, cube, along({0.3, 0.2, 3}, z)});
  Random random(3);
  const auto add = [&](const ClosedForm& form) {
    const Matrix3d fixed = random.rotation();
    forms.push_back(turned(form, fixed, random.rotation()));
  };
  add({"sphere_on_sphere", sphere(4), sphere(3.5), along({0, 0, 7.5}, z)});
  add({"sphere_on_plane", table, sphere(4), along({0.3, 0.2, 5}, z)});
  add({"sphere_under_plane", sphere(4), table, along({0.3, 0.2, 5}, z)});
  add({"cylinder_in_a_bore", wall(4, 5, 2), wall(0, 3.9, 2), along({0.1, 0, 0.7}, -x)});
  add({"box_on_box", table, cube, along({0.3, 0.2, 3}, z)});
  add({"edge_on_box", table, cube, [=](double depth) {
         return pose_of(tipped, {0.3, 0.2, 1 + std::sqrt(8.0) - depth});
       }});
  add({"torus_on_torus", ring(6, 3.5), ring(6.2, 3.3), along({0.3, 0.1, 6.8}, z)});
  add({"torus_beside_torus", ring(6, 3.5), ring(6.2, 3.3), along({19, 0, 0.2}, x)});
  return forms;
}

}  // namespace

Vector3d Solid::normal(const Vector3d& at) const {
  constexpr double kStep = 1e-5;
  Vector3d gradient;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Vector3d step = kStep * Vector3d::Unit(i);
    gradient[i] = (distance(at + step) - distance(at - step)) / (2 * kStep);
  }
  return gradient.normalized();
}

double ClosedForm::depth(const Isometry3d& placed, const Vector3d& at) const {
  return -(fixed.distance(at) + moving.distance(placed.inverse() * at));
}

Vector3d ClosedForm::normal(const Isometry3d& placed, const Vector3d& at) const {
  return (fixed.normal(at) - placed.linear() * moving.normal(placed.inverse() * at)).normalized();
}

const std::vector<ClosedForm>& closed_forms() {
  static const std::vector<ClosedForm> forms = make();
  return forms;
}

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
