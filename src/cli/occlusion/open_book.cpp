#include "cli/occlusion/open_book.h"

#include <cmath>

namespace ist::cli {
namespace {

using Vector = Eigen::Vector3d;

Eigen::AlignedBox3d box_of(const BiteBody& body, const Eigen::Isometry3d& place) {
  Eigen::AlignedBox3d box;
  for (const Vector& vertex : body.mesh->vertices) box.extend(place * (body.to_fixed * vertex));
  return box;
}

// The axis, with its sign, along which the middles of both boxes are farthest apart.
Vector towards_moving(const Bite& bite) {
  const Eigen::Isometry3d stay = Eigen::Isometry3d::Identity();
  const Vector way = box_of(bite.moving, stay).center() - box_of(bite.fixed, stay).center();
  Eigen::Index axis = 0;
  way.cwiseAbs().maxCoeff(&axis);
  return (way[axis] < 0 ? -1.0 : 1.0) * Vector::Unit(axis);
}

// The axis that is most nearly the one from front to back, and across `up`.
Vector hinge_across(const Vector& up, const Vector& fore_aft) {
  const Vector flat = fore_aft - fore_aft.dot(up) * up;
  Eigen::Index axis = 0;
  if (flat.cwiseAbs().maxCoeff(&axis) > 0.1) return Vector::Unit(axis);
  return Vector::Unit(std::abs(up[0]) > 0.5 ? 1 : 0);
}

Eigen::Isometry3d quarter(const Vector& axis, double sense) {
  Eigen::Matrix3d cross;
  cross << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  turn.linear() = sense * cross + axis * axis.transpose();
  return turn;
}

}  // namespace

OpenedBook opened(const Bite& bite, double gap) {
  const Vector up = towards_moving(bite), hinge = hinge_across(up, bite.fore_aft.direction);
  const Vector viewer = hinge.cross(up);  // both faces look there: fixed up, moving down, turned
  OpenedBook book{quarter(hinge, +1), quarter(hinge, -1)};
  const Eigen::AlignedBox3d fixed = box_of(bite.fixed, book.fixed),
                            moving = box_of(bite.moving, book.moving);
  // Ends of the boxes along `up` and towards the viewer.
  const auto ends = [](const Eigen::AlignedBox3d& box, const Vector& along) {
    const double middle = along.dot(box.center());
    const double half = 0.5 * along.cwiseAbs().dot(box.sizes());
    return std::pair(middle - half, middle + half);
  };
  const auto [fixed_low, fixed_high] = ends(fixed, up);
  const auto [moving_low, moving_high] = ends(moving, up);
  book.fixed.pretranslate((-0.5 * gap - fixed_high) * up - viewer.dot(fixed.center()) * viewer);
  book.moving.pretranslate((0.5 * gap - moving_low) * up - viewer.dot(moving.center()) * viewer);
  return book;
}

}  // namespace ist::cli
