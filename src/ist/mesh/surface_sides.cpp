#include "ist/mesh/surface_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "ist/base/ordered_vector.h"
#include "ist/mesh/components.h"
#include "ist/mesh/orientation.h"
#include "ist/mesh/triangles_meet.h"
#include "ist/mesh/winding_number.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;
constexpr std::uint32_t kNone = 0xFFFFFFFF;

// Returns the corner of a triangle at a vertex, as a number among all corners.
std::uint32_t corner_at(const TriangleMesh& mesh, std::uint32_t triangle, std::uint32_t vertex) {
  const Triangle& t = mesh.triangles[triangle];
  return 3 * triangle +
         static_cast<std::uint32_t>(std::find(t.begin(), t.end(), vertex) - t.begin());
}

// The patches of a closed surface.
struct Patches {
  std::vector<std::uint32_t> of;  // each triangle's: its lowest triangle; kNone: none
  std::vector<bool> is_odd;       // of each vertex: its triangles do not make one fan of one patch
};

Patches patches_of(const TriangleMesh& mesh, const SelfIntersections& found) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::vector<bool> is_clean(count, found.complete);
  for (const auto& pair : found.pairs) is_clean[pair[0]] = is_clean[pair[1]] = false;
  for (std::uint32_t t = 0; t < count; ++t) {
    const Triangle& triangle = mesh.triangles[t];
    if (has_equal_indices(triangle) ||
        !has_area(
            {mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]})) {
      is_clean[t] = false;
    }
  }
  Patches patches{{}, std::vector<bool>(mesh.vertices.size())};
  DisjointSets joined(count), fans(3 * count);
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    const EdgeUse &one = edge.front(), &other = edge.back();
    if (edge.size() != 2 || one.forward == other.forward || !is_clean[one.triangle] ||
        !is_clean[other.triangle]) {
      patches.is_odd[one.low] = patches.is_odd[one.high] = true;
      return;
    }
    joined.join(one.triangle, other.triangle);
    for (const std::uint32_t v : {one.low, one.high}) {
      fans.join(corner_at(mesh, one.triangle, v), corner_at(mesh, other.triangle, v));
    }
  });
  patches.of.resize(count, kNone);
  std::vector<std::uint32_t> fan_of(mesh.vertices.size(), kNone);
  for (std::uint32_t t = 0; t < count; ++t) {
    if (!is_clean[t]) continue;
    patches.of[t] = joined.find(t);
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[t][k], fan = fans.find(3 * t + k);
      if (fan_of[v] == kNone) fan_of[v] = fan;
      if (fan_of[v] != fan) patches.is_odd[v] = true;
    }
  }
  return patches;
}

// A triangle's plane over the plane of y and z.
struct Slope {
  Slope(const TriangleMesh& mesh, std::uint32_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    at = mesh.vertices[t[0]];
    normal =
        cross_in_order(difference(mesh.vertices[t[1]], at), difference(mesh.vertices[t[2]], at));
  }
  // Its x over a point, and a bound of the rounding.
  struct Height {
    double x, error;
  };
  [[nodiscard]] Height over(const Vector& point, double extent) const {
    const double y = point[1] - at[1], z = point[2] - at[2];
    const double steep = (std::abs(normal[1]) + std::abs(normal[2])) / std::abs(normal[0]);
    return {at[0] - (normal[1] * y + normal[2] * z) / normal[0],
            0x1p-36 * extent * (1 + steep) * (1 + steep)};
  }
  Vector at, normal;
};

// Returns the winding number beside a triangle, on its outer side: by the crossings of a line
// along x through its middle. Returns nullopt if rounding could put them in another order.
std::optional<int> outer_number(const TriangleMesh& mesh, const TriangleClusters& clusters,
                                const Eigen::AlignedBox3d& box, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  Vector from =
      scaled(1.0 / 3, sum(sum(mesh.vertices[t[0]], mesh.vertices[t[1]]), mesh.vertices[t[2]]));
  const double extent = box.sizes().maxCoeff() +
                        std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  const Slope::Height own = Slope(mesh, triangle).over(from, extent);
  if (!(std::abs(own.x - from[0]) <= extent)) return {};
  from[0] = box.min()[0] - extent;
  int own_turns = 0, beyond = 0;
  bool is_certain = true;
  WindingNumber(mesh, clusters).for_each_crossed(from, [&](std::uint32_t crossed, Crossing how) {
    const int turns = static_cast<int>(how);
    if (crossed == triangle) {
      own_turns = turns;
      return;
    }
    const Slope::Height height = Slope(mesh, crossed).over(from, extent);
    const double apart = height.x - own.x;
    if (!(std::abs(apart) > height.error + own.error)) is_certain = false;
    if (apart > 0) beyond += turns;
  });
  if (!is_certain || own_turns == 0) return {};
  return own_turns > 0 ? beyond : beyond - 1;
}

// Finds the number outside each patch, by one of its triangles that are largest along x.
std::vector<std::optional<int>> outer_numbers(const TriangleMesh& mesh,
                                              const TriangleClusters& clusters,
                                              const Eigen::AlignedBox3d& box,
                                              std::span<const std::uint32_t> patch_of) {
  constexpr std::size_t kTries = 3;
  struct Candidate {
    double size;
    std::uint32_t triangle;
  };
  std::vector<std::array<Candidate, kTries>> candidates(patch_of.size(),
                                                        {{{0, 0}, {0, 0}, {0, 0}}});
  for (std::uint32_t t = 0; t < patch_of.size(); ++t) {
    if (patch_of[t] == kNone) continue;
    Candidate next{std::abs(Slope(mesh, t).normal[0]), t};
    for (Candidate& kept : candidates[patch_of[t]]) {
      if (next.size > kept.size) std::swap(next, kept);
    }
  }
  std::vector<std::optional<int>> numbers(patch_of.size());
  for (std::uint32_t patch = 0; patch < patch_of.size(); ++patch) {
    if (patch_of[patch] != patch) continue;
    for (const Candidate& candidate : candidates[patch]) {
      if (numbers[patch] || !(candidate.size > 0)) break;
      numbers[patch] = outer_number(mesh, clusters, box, candidate.triangle);
    }
  }
  return numbers;
}

}  // namespace

SurfaceSides::SurfaceSides(const TriangleMesh& mesh, const TriangleClusters& clusters)
    : normals_(mesh), self_intersections_(find_self_intersections(mesh, clusters)) {
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) box_.extend(mesh.vertices[v]);
  }
  if (!normals_.closed()) return;
  const Patches patches = patches_of(mesh, self_intersections_);
  const std::vector<std::optional<int>> numbers = outer_numbers(mesh, clusters, box_, patches.of);
  outer_.resize(mesh.triangles.size(), kAskRay);
  for (std::uint32_t t = 0; t < outer_.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    if (patches.of[t] == kNone || patches.is_odd[triangle[0]] || patches.is_odd[triangle[1]] ||
        patches.is_odd[triangle[2]]) {
      continue;
    }
    const std::optional<int> number = numbers[patches.of[t]];
    if (number && std::abs(*number) < 100) outer_[t] = static_cast<std::int8_t>(*number);
  }
  if (std::all_of(outer_.begin(), outer_.end(), [](std::int8_t number) { return number == 0; })) {
    outer_ = {};
  }
}

Side SurfaceSides::of(const TriangleMesh& mesh, const TriangleClusters& clusters,
                      const Vector& point, std::uint32_t triangle,
                      const NearestPoint& on) const noexcept {
  if (is_beyond(point)) return Side::kOutside;
  const int outer = outer_.empty() ? 0 : outer_[triangle];
  const std::optional<Vector> normal =
      outer == kAskRay ? std::nullopt : normals_.at(mesh, triangle, on);
  int winding;
  if (normal) {
    winding = outer + (dot_in_order(*normal, difference(point, on.point)) < 0 ? 1 : 0);
  } else if (normals_.closed()) {
    winding = WindingNumber(mesh, clusters).at(point).value_or(0);
  } else {
    return Side::kUnknown;
  }
  return winding != 0 ? Side::kInside : Side::kOutside;
}

}  // namespace ist
