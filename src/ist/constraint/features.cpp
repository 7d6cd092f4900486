#include "ist/constraint/features.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/rigid_move.h"
#include "ist/mesh/bounding_box.h"
#include "ist/query/query.h"
#include "ist/query/triangles/triangle_distance.h"
#include "ist/query/triangles/triangle_visitors.h"

namespace ist {
namespace {

// A corner is above a seam inside a plane region if its normal ascends by no more, a sine.
constexpr double kSeam = 1e-6;
// The reach of a pair's minima: a factor for the tolerance, and a part of the edges for rounding.
constexpr double kSpare = 1.001, kRounding = 2e-6;
// Cells along the diagonal of the moving body, if a list is thinned.
constexpr double kCells = 64;

std::uint64_t mixed(std::uint64_t x) noexcept {
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EB;
  return x ^ (x >> 31);
}

// NearPair::direction() in the caller's float environment.
Eigen::Vector3d direction_of(const NearPair& pair) noexcept {
  const Eigen::Vector3d way = difference(pair.moving_point, pair.fixed_point);
  const double length = length_in_order(way);
  return pair.distance > 0 && length > 0 ? scaled(1 / length, way) : Eigen::Vector3d(0, 0, 0);
}

double longest_edge(const TriangleCorners& t) noexcept {
  const double a = square_in_order(difference(t[1], t[0]));
  const double b = square_in_order(difference(t[2], t[1]));
  const double c = square_in_order(difference(t[0], t[2]));
  return std::sqrt(std::max({a, b, c}));
}

std::uint64_t number_of(const SurfacePart& part) noexcept {
  return std::uint64_t{static_cast<std::uint8_t>(part.kind)} << 32 | part.index;
}

}  // namespace

bool FeatureList::KeySet::add(const Key& key) noexcept {
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t at = mixed(key.first ^ mixed(key.second)) & mask;; at = (at + 1) & mask) {
    Slot& slot = slots_[at];
    if (slot.stamp != stamp_) {
      slot = {key, stamp_};
      ++count_;
      return true;
    }
    if (slot.key == key) return false;
  }
}

void FeatureList::KeySet::clear() noexcept {
  count_ = 0;
  if (++stamp_ != 0) return;
  for (Slot& slot : slots_) slot.stamp = 0;
  stamp_ = 1;
}

FeatureList::FeatureList(const Surface& fixed, const Surface& moving, std::size_t room)
    : fixed_(fixed),
      moving_(moving),
      cell_(length_in_order(bounding_box(moving.mesh()).diagonal()) / kCells),
      seen_(4 * room),
      cells_(room) {
  features_.reserve(room);
}

void FeatureList::clear() noexcept {
  features_.clear();
  seen_.clear();
  cells_.clear();
  thinned_ = false;
}

void FeatureList::find(std::span<const NearPair> near, const Eigen::Isometry3d& pose, double margin,
                       Which which, double tolerance) noexcept {
  const ScopedFloatEnvironment environment;
  clear();
  tolerance_ = tolerance;
  const bool minima = which == Which::kMinima;
  if (list(near, pose, margin, minima, 0)) return;
  clear();
  thinned_ = true;
  list(near, pose, margin, minima, cell_);
}

bool FeatureList::list(std::span<const NearPair> near, const Eigen::Isometry3d& pose, double margin,
                       bool minima, double cell) noexcept {
  const RigidMove move(pose);
  for (const NearPair& pair : near) {
    const auto [fixed, moving] = pair.triangles;
    if (minima) {
      // The closest points of two triangles are a minimum of the surfaces, or no part of these
      // triangles has one.
      const Eigen::Vector3d normal = direction_of(pair);
      const Eigen::Vector3d back = -(pose.linear().transpose() * normal);
      if (!fixed_.leaves(fixed_.part(fixed, pair.fixed_part), normal, tolerance_) ||
          !moving_.leaves(moving_.part(moving, pair.moving_part), back, tolerance_)) {
        continue;
      }
    }
    const TriangleCorners first = corners_of(fixed_.mesh(), fixed);
    TriangleCorners second = corners_of(moving_.mesh(), moving);
    for (Eigen::Vector3d& corner : second) corner = move(corner);
    double reach = margin;
    if (minima) {
      // At a minimum no point of the triangles is nearer by more than their slopes along its
      // normal.
      const double edges = longest_edge(first) + longest_edge(second);
      reach = std::min(reach, pair.distance + (kSpare * tolerance_ + kRounding) * edges);
    }
    std::array<NearPair, Query::kMostNearParts> parts;
    const std::size_t count = near_parts(first, second, pair.triangles, reach, parts);
    for (const NearPair& part : std::span(parts).first(count)) {
      const SurfacePart of_fixed = fixed_.part(fixed, part.fixed_part);
      const SurfacePart of_moving = moving_.part(moving, part.moving_part);
      if (!add(part, of_fixed, of_moving, pose, minima, cell)) return false;
    }
  }
  return true;
}

bool FeatureList::add(const NearPair& near, const SurfacePart& fixed, const SurfacePart& moving,
                      const Eigen::Isometry3d& pose, bool minima, double cell) noexcept {
  const bool fixed_flat = fixed_.is_flat(fixed), moving_flat = moving_.is_flat(moving);
  using Kind = SurfacePart::Kind;
  // Rounding can leave a corner above a seam beside the faces on both sides.
  if (minima && ((fixed_flat && (moving_flat || moving.kind != Kind::kVertex)) ||
                 (moving_flat && fixed.kind != Kind::kVertex))) {
    return true;
  }
  if (seen_.is_full()) return false;
  if (!seen_.add({number_of(fixed), number_of(moving)})) return true;
  const Eigen::Vector3d normal = direction_of(near);
  if (!(square_in_order(normal) > 0)) return true;
  if (minima) {
    const Eigen::Vector3d back = -(pose.linear().transpose() * normal);
    if (!fixed_.leaves(fixed, normal, fixed_flat ? kSeam : tolerance_) ||
        !moving_.leaves(moving, back, moving_flat ? kSeam : tolerance_)) {
      return true;
    }
  }
  if (cell > 0) {
    std::uint64_t octant = 0, at[3];
    for (Eigen::Index i = 0; i < 3; ++i) {
      at[i] = static_cast<std::uint64_t>(
          static_cast<std::int64_t>(std::floor(near.moving_point[i] / cell)));
      octant = 2 * octant + (normal[i] > 0 ? 1 : 0);
    }
    if (!cells_.add({at[0] << 32 ^ (at[1] & 0xFFFFFFFF), at[2] << 3 | octant})) return true;
  }
  if (features_.size() == features_.capacity()) return false;
  features_.push_back(
      {fixed, moving, near.triangles, near.fixed_point, near.moving_point, normal, near.distance});
  return true;
}

std::size_t FeatureList::bytes_for(std::size_t room) noexcept {
  return room * sizeof(Feature) + KeySet::bytes_for(4 * room) + KeySet::bytes_for(room);
}

std::size_t FeatureList::bytes() const noexcept {
  return features_.capacity() * sizeof(Feature) + seen_.bytes() + cells_.bytes();
}

}  // namespace ist
