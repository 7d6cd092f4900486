#include "cli/occlusion/bite_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <tuple>
#include <utility>
#include <vector>

#include "answers/occlusion/bite_direction.h"

namespace ist::cli {

using namespace answers;

namespace {

using Vector = Eigen::Vector3d;
using Box = Eigen::AlignedBox3d;

// Returns the smallest pixels by which a picture of that size holds a box with some room round it.
double pixel_of(const Box& box, double room, int width, int height) {
  const double wide = box.sizes()[0], high = box.sizes()[1], around = room * std::max(wide, high);
  return std::max((wide + 2 * around) / width, (high + 2 * around) / height);
}

// Where along an axis all but a fiftieth of an area lies, at each end.
class Middle {
 public:
  void add(double at, double area) { parts_.emplace_back(at, area), all_ += area; }
  [[nodiscard]] bool empty() const { return parts_.empty(); }
  [[nodiscard]] std::pair<double, double> range() {
    std::sort(parts_.begin(), parts_.end());
    return {reached(parts_.begin(), parts_.end()), reached(parts_.rbegin(), parts_.rend())};
  }

 private:
  template <typename Iterator>
  [[nodiscard]] double reached(Iterator part, Iterator end) const {
    for (double rest = 0.02 * all_; part + 1 != end && (rest -= part->second) > 0;) ++part;
    return part->first;
  }

  std::vector<std::pair<double, double>> parts_;
  double all_ = 0;
};

// The part of a picture in which the bodies face each other, and all regions touch; empty where
// nothing does.
Box opposed(const Bite& bite, const Eigen::Matrix3d& to_picture, const Vector& towards) {
  Box box;
  std::array<Middle, 3> middle;
  for (const BiteBody* body : {&bite.fixed, &bite.moving}) {
    const Vector outwards = body == &bite.fixed ? towards : Vector(-towards);
    for (const NearTriangle& one : near_triangles(*body)) {
      const double area = one.area.norm();
      if (one.area.dot(outwards) < 0.5 * area) continue;
      const Vector point = to_picture * one.corner;
      for (std::size_t i = 0; i < 3; ++i) middle[i].add(point[static_cast<int>(i)], area);
    }
    for (const ContactRegion& region : body->surface.regions) {
      box.extend(to_picture * region.closest);
    }
  }
  if (middle[0].empty()) return box;
  const auto [x, y, z] = std::tuple(middle[0].range(), middle[1].range(), middle[2].range());
  return box.extend(Vector(x.first, y.first, z.first)).extend(Vector(x.second, y.second, z.second));
}

}  // namespace

BiteViews bite_views(const Bite& bite, int width, int height) {
  BiteView fixed;
  const BiteDirections directions = directions_of(bite);
  fixed.towards = directions.towards;
  fixed.across = directions.across;
  fixed.up = fixed.towards.cross(fixed.across);
  Eigen::Matrix3d axes;
  axes << fixed.across, fixed.up, fixed.towards;
  Box shown;
  for (const BiteBody* body : {&bite.fixed, &bite.moving}) {
    for (const Vector& v : body->mesh->vertices) {
      shown.extend(axes.transpose() * (body->to_fixed * v));
    }
  }
  fixed.pixel = pixel_of(shown, 0.03, width, height);
  if (!(fixed.pixel > 0)) fixed.pixel = 1;  // both are seen as one point
  const Box part = opposed(bite, axes.transpose(), fixed.towards);
  if (!part.isEmpty()) {
    // No larger than three times, so that one sees where it is.
    const double pixel = std::max(pixel_of(part, 0.12, width, height), fixed.pixel / 3);
    if (pixel < 0.8 * fixed.pixel) {
      fixed.pixel = pixel;
      shown = part;
    }
  }
  fixed.middle = axes * shown.center();
  BiteView moving = fixed;
  moving.towards = -fixed.towards;
  moving.up = -fixed.up;
  return {fixed, moving};
}

}  // namespace ist::cli
