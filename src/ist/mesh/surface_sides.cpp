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

Vector normal_of(const std::array<Vector, 3>& t) {
  return cross_in_order(difference(t[1], t[0]), difference(t[2], t[0]));
}

// Returns the range of x in which a line along x through `point` certainly crosses a triangle.
std::array<double, 2> range_on_line(const std::array<Vector, 3>& t, const Vector& point,
                                    double extent) {
  const Vector normal = normal_of(t);
  const double steep = (std::abs(normal[1]) + std::abs(normal[2])) / std::abs(normal[0]);
  double longest = 0;  // a square
  for (std::size_t k = 0; k < 3; ++k) {
    longest = std::max(longest, square_in_order(difference(t[(k + 1) % 3], t[k])));
  }
  const auto [least, greatest] = std::minmax({t[0][0], t[1][0], t[2][0]});
  // The normal of a needle is not known well enough.
  if (!(length_in_order(normal) > 1e-3 * longest)) return {least, greatest};
  const double y = point[1] - t[0][1], z = point[2] - t[0][2];
  const double x = t[0][0] - (normal[1] * y + normal[2] * z) / normal[0];
  const double error = 0x1p-36 * extent * (1 + steep) * (1 + steep);
  return {std::max(least, x - error), std::min(greatest, x + error)};
}

// Returns the winding number beside a triangle, on its outer side: by the crossings of a line
// along x through its middle. Returns nullopt if another triangle crosses the line in the range in
// which this one does. Exact predicates decide.
std::optional<int> outer_number(const TriangleMesh& mesh, const TriangleClusters& clusters,
                                const Eigen::AlignedBox3d& box, std::uint32_t triangle) {
  const auto corners = [&](std::uint32_t index) -> std::array<Vector, 3> {
    const Triangle& t = mesh.triangles[index];
    return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
  };
  const std::array<Vector, 3> own = corners(triangle);
  Vector from = scaled(1.0 / 3, sum(sum(own[0], own[1]), own[2]));
  const double extent = box.sizes().maxCoeff() +
                        std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  const auto range = range_on_line(own, from, extent);
  from[0] = box.min()[0] - extent;
  int own_turns = 0, beyond = 0;
  bool is_certain = true;
  WindingNumber(mesh, clusters).for_each_crossed(from, [&](std::uint32_t crossed, Crossing how) {
    const int turns = static_cast<int>(how);
    if (crossed == triangle) {
      own_turns = turns;
      return;
    }
    const auto [a, b, c] = corners(crossed);
    const int side = orientation(a, b, c, {range[0], from[1], from[2]});
    if (side == 0 || side != orientation(a, b, c, {range[1], from[1], from[2]})) is_certain = false;
    if (side == turns) beyond += turns;
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
    const Triangle& triangle = mesh.triangles[t];
    const Vector normal = normal_of(
        {mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]});
    Candidate next{std::abs(normal[0]), t};
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
                      const Vector& point, const NearestTriangle& nearest) const noexcept {
  if (is_beyond(point)) return Side::kOutside;
  const int outer = outer_.empty() ? 0 : outer_[nearest.triangle];
  const bool asks_ray = outer == kAskRay || (nearest.is_tied && normals_.closed());
  const std::optional<Vector> normal =
      asks_ray ? std::nullopt : normals_.at(mesh, nearest.triangle, nearest.on);
  int winding;
  if (normal) {
    winding = outer + (dot_in_order(*normal, difference(point, nearest.on.point)) < 0 ? 1 : 0);
  } else if (normals_.closed()) {
    winding = WindingNumber(mesh, clusters).at(point).value_or(0);
  } else {
    return Side::kUnknown;
  }
  return winding != 0 ? Side::kInside : Side::kOutside;
}

}  // namespace ist
