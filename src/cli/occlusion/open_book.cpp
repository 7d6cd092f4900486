#include "cli/occlusion/open_book.h"

#include <algorithm>
#include <limits>

#include "cli/occlusion/bite_direction.h"

namespace ist::cli {
namespace {

using Vector = Eigen::Vector3d;

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
};

// How far a body reaches along a direction, where it is placed.
Range range_of(const BiteBody& body, const Eigen::Isometry3d& place, const Vector& along) {
  const Eigen::Isometry3d whole = place * body.to_fixed;
  Range range;
  for (const Vector& vertex : body.mesh->vertices) {
    const double at = along.dot(whole * vertex);
    range = {std::min(range.low, at), std::max(range.high, at)};
  }
  return range;
}

Eigen::Isometry3d quarter(const Vector& axis, double sense) {
  Eigen::Matrix3d cross;
  cross << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  turn.linear() = sense * cross + axis * axis.transpose();
  return turn;
}

}  // namespace

OpenedBook opened(const Bite& bite, double gap, BookLayout layout) {
  const BiteDirections directions = directions_of(bite);
  const Vector &towards = directions.towards, &front = directions.front;
  const bool beside = layout == BookLayout::kBeside;
  const Vector hinge = beside ? Vector(-front) : towards.cross(front);
  // Both faces look at the viewer: the fixed body's looked `towards`, the moving body's against it.
  const Vector viewer = hinge.cross(towards);
  OpenedBook book{quarter(hinge, +1), quarter(hinge, -1), viewer,
                  beside ? front : Vector(-towards)};
  const auto shift = [&](const BiteBody& body, Eigen::Isometry3d& place, double aside) {
    place.pretranslate(aside * towards - range_of(body, place, viewer).middle() * viewer);
  };
  shift(bite.fixed, book.fixed, -0.5 * gap - range_of(bite.fixed, book.fixed, towards).high);
  shift(bite.moving, book.moving, 0.5 * gap - range_of(bite.moving, book.moving, towards).low);
  return book;
}

}  // namespace ist::cli
