#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/parallel.h"
#include "ist/mesh/components.h"
#include "ist/mesh/mesh.h"
#include "ist/mesh/self_intersections.h"
#include "ist/mesh/winding_number.h"

namespace ist {
namespace {

// Returns the sign of the enclosed volume, or 0 if rounding could have made it. Works relative to
// the component's own vertex and extent, so that neither position nor unit matters.
int volume_sign(const TriangleMesh& mesh, const Component& component) {
  const Eigen::Vector3d origin = mesh.vertices[mesh.triangles[component.triangles[0]][0]];
  const double extent = component.box.sizes().maxCoeff();
  if (!(extent > 0)) return 0;
  double sum = 0, size = 0;
  for (const std::uint32_t t : component.triangles) {
    const Triangle& triangle = mesh.triangles[t];
    const Eigen::Vector3d a = (mesh.vertices[triangle[0]] - origin) / extent;
    const Eigen::Vector3d b = (mesh.vertices[triangle[1]] - origin) / extent;
    const Eigen::Vector3d c = (mesh.vertices[triangle[2]] - origin) / extent;
    const double sixfold = dot_in_order(a, b.cross(c));
    sum += sixfold;
    size += std::abs(sixfold);
  }
  constexpr double kDoubt = 1e-12;
  if (!(std::abs(sum) > kDoubt * size)) return 0;
  return sum > 0 ? 1 : -1;
}

// Finds the component round each component.
class Nesting {
 public:
  Nesting(const TriangleMesh& mesh, std::span<const Component> components)
      : mesh_(mesh),
        components_(components),
        clusters_(mesh, mesh.vertices[mesh.triangles[components[0].triangles[0]][0]]),
        component_of_(mesh.triangles.size(), kNone),
        meets_(components.size()) {
    const auto meet = [this](std::uint32_t a, std::uint32_t b) {
      if (a != b) meets_[a] = meets_[b] = true;
    };
    std::vector<std::uint32_t> component_at(mesh.vertices.size(), kNone);
    for (std::uint32_t k = 0; k < components.size(); ++k) {
      for (const std::uint32_t t : components[k].triangles) {
        component_of_[t] = k;
        for (const std::uint32_t v : mesh.triangles[t]) {
          if (component_at[v] == kNone) component_at[v] = k;
          meet(component_at[v], k);
        }
      }
    }
    const SelfIntersections found = find_self_intersections(mesh, clusters_);
    if (!found.complete) meets_.assign(components.size(), true);
    for (const auto& pair : found.pairs) meet(component_of_[pair[0]], component_of_[pair[1]]);
  }

  // Returns the smallest component in which component k lies with all its vertices, at least one
  // of them not on the surface; or k itself. One vertex tells of all if k meets no other component.
  [[nodiscard]] std::uint32_t parent_of(std::uint32_t k) const {
    std::vector<Around> left;
    bool is_first = true;
    for (const std::uint32_t t : components_[k].triangles) {
      for (const std::uint32_t v : mesh_.triangles[t]) {
        const std::vector<Around> here = around(mesh_.vertices[v]);
        if (is_first) {
          left = here;
          std::erase_if(left, [&](const Around& one) { return !may_hold(one.component, k); });
          for (Around& one : left) one.strictly = false;
        }
        is_first = false;
        std::erase_if(left, [&](Around& one) {
          const auto same = std::find_if(here.begin(), here.end(), [&](const Around& other) {
            return other.component == one.component;
          });
          if (same == here.end()) return true;
          one.strictly = one.strictly || same->strictly;
          return false;
        });
        if (left.empty()) return k;
        if (!meets_[k]) return smallest(left, k);
      }
    }
    return smallest(left, k);
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  struct Around {
    std::uint32_t component;
    bool strictly;  // else the point lies on its surface
  };

  [[nodiscard]] std::uint32_t smallest(std::span<const Around> left, std::uint32_t k) const {
    std::uint32_t parent = k;
    for (const Around& one : left) {
      if (one.strictly && (parent == k || is_larger(parent, one.component))) parent = one.component;
    }
    return parent;
  }

  // Returns the components round a point, and those through it.
  [[nodiscard]] std::vector<Around> around(const Eigen::Vector3d& point) const {
    struct Count {
      std::uint32_t component;
      int winding;
      bool on_surface;
    };
    std::vector<Count> counts;
    WindingNumber(mesh_, clusters_).for_each_crossed(point, [&](std::uint32_t t, Crossing how) {
      if (component_of_[t] == kNone) return;
      counts.push_back({component_of_[t], static_cast<int>(how), how == Crossing::kOnTriangle});
    });
    std::sort(counts.begin(), counts.end(),
              [](const Count& a, const Count& b) { return a.component < b.component; });
    std::vector<Around> out;
    for (std::size_t begin = 0, end = 0; begin < counts.size(); begin = end) {
      int winding = 0;
      bool on_surface = false;
      for (; end < counts.size() && counts[end].component == counts[begin].component; ++end) {
        winding += counts[end].winding;
        on_surface = on_surface || counts[end].on_surface;
      }
      if (on_surface || winding != 0) out.push_back({counts[begin].component, !on_surface});
    }
    return out;
  }

  // An order of components by size, so that none lies in itself by way of others.
  [[nodiscard]] bool is_larger(std::uint32_t a, std::uint32_t b) const {
    const double size_a = square_in_order(components_[a].box.diagonal()),
                 size_b = square_in_order(components_[b].box.diagonal());
    return size_a > size_b || (size_a == size_b && a < b);
  }
  [[nodiscard]] bool may_hold(std::uint32_t outer, std::uint32_t inner) const {
    return outer != inner && is_larger(outer, inner) &&
           components_[outer].box.contains(components_[inner].box);
  }

  const TriangleMesh& mesh_;
  std::span<const Component> components_;
  TriangleClusters clusters_;
  std::vector<std::uint32_t> component_of_;  // each triangle's
  std::vector<bool> meets_;                  // whether a component meets another one
};

// Returns each component's outermost one.
std::vector<std::uint32_t> outermost_of(const TriangleMesh& mesh,
                                        std::span<const Component> components, Progress* progress) {
  const Nesting nesting(mesh, components);
  std::vector<std::uint32_t> outer(components.size());
  parallel_for(components.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      if (progress != nullptr) progress->check();
      outer[k] = nesting.parent_of(static_cast<std::uint32_t>(k));
      if (progress != nullptr) progress->add(1);
    }
  });
  for (std::uint32_t k = 0; k < outer.size(); ++k) {
    while (outer[outer[k]] != outer[k]) outer[k] = outer[outer[k]];
  }
  return outer;
}

}  // namespace

OrientationResult orient_outward(TriangleMesh& mesh, Progress* progress) {
  const ScopedFloatEnvironment environment;
  const std::vector<Component> components = components_of(mesh);
  if (progress != nullptr) progress->begin_stage("orienting components", components.size());
  OrientationResult result;
  result.orientation = components.empty() ? Orientation::kAssumed : Orientation::kOutward;
  std::vector<int> signs;
  for (const Component& component : components) {
    signs.push_back(component.closed ? volume_sign(mesh, component) : 0);
    if (signs.back() == 0) result.orientation = Orientation::kAssumed;
  }
  if (std::count(signs.begin(), signs.end(), -1) == 0) return result;
  const std::vector<std::uint32_t> outermost = outermost_of(mesh, components, progress);
  for (std::size_t k = 0; k < components.size(); ++k) {
    if (signs[outermost[k]] >= 0) continue;
    for (const std::uint32_t t : components[k].triangles)
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    ++result.turned_components;
  }
  return result;
}

}  // namespace ist
