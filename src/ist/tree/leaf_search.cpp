#include "ist/tree/leaf_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "ist/base/ordered_vector.h"
#include "ist/tree/nested_bounds.h"
#include "ist/tree/node_bounds.h"

namespace ist {
namespace {

using Eigen::Vector3d;

double edge_at(int level) noexcept { return static_cast<double>(std::uint64_t{1} << level); }

}  // namespace

InflatedBound::InflatedBound(const Ball& ball, const Slab& slab, double partner_radius) noexcept
    : centre_(ball.centre),
      normal_(slab.normal),
      radius_(ball.radius + partner_radius),
      square_(dot_in_order(normal_, normal_)),
      inverse_(1 / square_),
      above_(cut(slab.half + slab.offset + partner_radius)),
      below_(cut(slab.half - slab.offset + partner_radius)) {}

InflatedBound::Cut InflatedBound::cut(double height) const noexcept {
  const double radius2 = radius_ * radius_ * square_ - height * height;
  return radius2 > 0 ? Cut{height, radius2} : Cut{};
}

double InflatedBound::support(const Vector3d& normal, double length,
                              const Vector3d& from) const noexcept {
  const double along = dot_in_order(normal, normal_);
  const double centre = dot_in_order(normal, difference(centre_, from));
  const bool up = radius_ * along > above_.height * length;
  if (!up && !(radius_ * -along > below_.height * length)) return centre + radius_ * length;
  const Cut& face = up ? above_ : below_;
  const double across2 = dot_in_order(normal, normal) * square_ - along * along;
  return centre +
         ((up ? along : -along) * face.height + std::sqrt(across2 * face.radius2)) * inverse_;
}

Vector3d InflatedBound::support_point(const Vector3d& normal, double length) const noexcept {
  const double along = dot_in_order(normal, normal_);
  const bool up = radius_ * along > above_.height * length;
  if (!up && !(radius_ * -along > below_.height * length)) {
    return sum(centre_, scaled(radius_ / length, normal));
  }
  const Cut& face = up ? above_ : below_;
  const double across2 = dot_in_order(normal, normal) * square_ - along * along;
  const double out = across2 > 0 ? std::sqrt(face.radius2 / across2) : 0;
  const double lift = ((up ? face.height : -face.height) - out * along) * inverse_;
  return sum(centre_, sum(scaled(lift, normal_), scaled(out, normal)));
}

double height_of(const InflatedBound& bound, const Vector3d& normal, double length,
                 const Vector3d& from) noexcept {
  return bound.support(normal, length, from) - length * kPartnerRadius;
}

Vector3d normal_of(const PackedSlab& slab) noexcept {
  return {PackedSlab::kNormalUnit * slab.nx, PackedSlab::kNormalUnit * slab.ny,
          PackedSlab::kNormalUnit * slab.nz};
}

void LeafSearch::set_node(std::uint32_t node) noexcept {
  node_ = node;
  read(level_, node, balls_);
  if (!bounds_.slabs.empty()) read(level_, node, reached_);
}

Ball LeafSearch::saved_ball(int level, std::uint32_t node, int slot) const noexcept {
  const PackedBall ball = bounds_.balls[static_cast<std::size_t>(level - 1)][node][slot];
  const float(&from)[3] = octree_.nodes(level)[node].centre;
  return {centre_of(ball, {from[0], from[1], from[2]}, edge_at(level)),
          PackedBall::kUnit * edge_at(level) * ball.r};
}

Slab LeafSearch::saved_slab(int level, std::uint32_t node, int slot) const noexcept {
  const PackedSlab slab = bounds_.slabs[static_cast<std::size_t>(level - 1)][node][slot];
  const double unit = PackedSlab::kUnit * edge_at(level - 1);
  return {normal_of(slab), unit * slab.offset, unit * slab.half};
}

void LeafSearch::read(int level, std::uint32_t node, Ball (&children)[8]) const noexcept {
  const int count = octree_.child_count(level, node);
  for (int slot = 0; slot < count; ++slot) children[slot] = saved_ball(level, node, slot);
}

void LeafSearch::read(int level, std::uint32_t node, InflatedBound (&children)[8]) const noexcept {
  const int count = octree_.child_count(level, node);
  for (int slot = 0; slot < count; ++slot) {
    children[slot] =
        InflatedBound(saved_ball(level, node, slot), saved_slab(level, node, slot), kPartnerRadius);
  }
}

// No leaf has a greater value than a node above it: a node without a greater value is passed over.
template <typename Bound, typename Value>
void LeafSearch::raise(int level, std::uint32_t node, const Bound (&children)[8],
                       const Value& value, Greatest<Bound>& greatest) const noexcept {
  const int count = octree_.child_count(level, node);
  double values[8];
  for (int i = 0; i < count; ++i) values[i] = value(children[i]);
  while (true) {
    const auto at = std::max_element(values, values + count) - values;
    if (!(values[at] > greatest.value)) return;
    if (level == 1) {
      greatest = {values[at], children[at]};
      return;
    }
    const std::uint32_t child = octree_.first_child(level, node) + static_cast<std::uint32_t>(at);
    Bound below[8];
    read(level - 1, child, below);
    raise(level - 1, child, below, value, greatest);
    values[at] = -std::numeric_limits<double>::infinity();
  }
}

Greatest<Ball> LeafSearch::farthest(const Vector3d& from) const noexcept {
  const auto distance = [&from](const Ball& ball) {
    const Vector3d d = difference(ball.centre, from);
    return std::sqrt(dot_in_order(d, d)) + ball.radius;
  };
  Greatest<Ball> greatest{};
  raise(level_, node_, balls_, distance, greatest);
  return greatest;
}

void LeafSearch::raise_support(const Vector3d& normal, double length, const Vector3d& from,
                               Greatest<InflatedBound>& greatest) const noexcept {
  const auto height = [&](const InflatedBound& bound) {
    return height_of(bound, normal, length, from);
  };
  raise(level_, node_, reached_, height, greatest);
}

}  // namespace ist
