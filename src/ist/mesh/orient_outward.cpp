#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/parallel.h"
#include "ist/mesh/bounding_box.h"
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
  Nesting(const TriangleMesh& mesh, std::span<const Component> components, Progress* progress)
      : mesh_(mesh),
        components_(components),
        progress_(progress),
        aside_(aside_of(bounding_box(mesh))),
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
    if (!has_usable_extent(bounding_box(mesh))) {
      meets_.assign(components.size(), true);
      return;
    }
    const SelfIntersections found = find_self_intersections(mesh, clusters_, progress);
    if (!found.complete) meets_.assign(components.size(), true);
    for (const auto& pair : found.pairs) meet(component_of_[pair[0]], component_of_[pair[1]]);
  }

  // Returns the smallest component in which component k lies, or k itself. It lies in a component
  // if all its vertices lie in it or on its surface. If all lie on the surface, the middles of its
  // triangles decide. If k meets no other component, one vertex is enough.
  [[nodiscard]] std::uint32_t parent_of(std::uint32_t k) const {
    const Eigen::Vector3d& first = mesh_.vertices[mesh_.triangles[components_[k].triangles[0]][0]];
    const bool meets = meets_[k];
    std::vector<Holder> left;
    for (const Around& one : meets ? around_nearly(first) : around(first)) {
      if (may_hold(one.component, k)) left.push_back({one.component, !meets && one.strictly});
    }
    if (meets) narrow(left, k);
    std::uint32_t parent = k;
    for (const Holder& one : left) {
      if ((one.is_certain || middles_lie_in(one.component, k)) &&
          (parent == k || is_larger(parent, one.component))) {
        parent = one.component;
      }
    }
    return parent;
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  struct Around {
    std::uint32_t component;
    bool strictly;  // else the point lies on its surface
  };

  static double aside_of(const Eigen::AlignedBox3d& box) {
    return 0x1p-40 * box.sizes().maxCoeff() +
           0x1p-48 * box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  }

  struct Holder {
    std::uint32_t component;
    bool is_certain;  // a vertex lies in it, off its surface
  };
  enum class Place { kOutside, kOnSurface, kInside };

  // Leaves the holders in which, or on which, all vertices of k lie.
  void narrow(std::vector<Holder>& holders, std::uint32_t k) const {
    for (const std::uint32_t t : components_[k].triangles) {
      if (progress_ != nullptr) progress_->check();
      for (const std::uint32_t v : mesh_.triangles[t]) {
        const std::vector<Around> here = around(mesh_.vertices[v]);
        std::erase_if(holders, [&](Holder& one) {
          if (one.is_certain && holds(here, one.component)) return false;
          const Place place = place_in(one.component, mesh_.vertices[v]);
          one.is_certain = one.is_certain || place == Place::kInside;
          return place == Place::kOutside;
        });
        if (holders.empty()) return;
      }
    }
  }

  // Returns whether the first triangle of k whose middle is off a component's surface lies in it.
  [[nodiscard]] bool middles_lie_in(std::uint32_t component, std::uint32_t k) const {
    for (const std::uint32_t t : components_[k].triangles) {
      const Triangle& triangle = mesh_.triangles[t];
      const Place place = place_in(
          component,
          scaled(1.0 / 3, sum(sum(mesh_.vertices[triangle[0]], mesh_.vertices[triangle[1]]),
                              mesh_.vertices[triangle[2]])));
      if (place != Place::kOnSurface) return place == Place::kInside;
    }
    return false;
  }

  // Returns six points round a point, farther from it than rounding moves a vertex. Round a point
  // of the surface they lie on both sides.
  [[nodiscard]] std::array<Eigen::Vector3d, 6> points_beside(const Eigen::Vector3d& point) const {
    std::array<Eigen::Vector3d, 6> points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] = point;
      points[i][static_cast<Eigen::Index>(i / 2)] += i % 2 == 0 ? aside_ : -aside_;
    }
    return points;
  }

  [[nodiscard]] Place place_in(std::uint32_t component, const Eigen::Vector3d& point) const {
    const auto points = points_beside(point);
    const auto held = std::count_if(points.begin(), points.end(), [&](const Eigen::Vector3d& p) {
      return holds(around(p), component);
    });
    return held == 0 ? Place::kOutside : held == 6 ? Place::kInside : Place::kOnSurface;
  }

  // Returns the components that hold one of the points beside.
  [[nodiscard]] std::vector<Around> around_nearly(const Eigen::Vector3d& point) const {
    std::vector<Around> all;
    for (const Eigen::Vector3d& p : points_beside(point)) {
      for (const Around& one : around(p)) {
        const bool is_new = std::none_of(all.begin(), all.end(), [&](const Around& other) {
          return other.component == one.component;
        });
        if (is_new) all.push_back(one);
      }
    }
    return all;
  }

  static bool holds(std::span<const Around> here, std::uint32_t component) {
    return std::any_of(here.begin(), here.end(), [&](const Around& one) {
      return one.component == component && one.strictly;
    });
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
           inflated(components_[outer].box).contains(components_[inner].box);
  }

  [[nodiscard]] Eigen::AlignedBox3d inflated(Eigen::AlignedBox3d box) const {
    box.min().array() -= aside_;
    box.max().array() += aside_;
    return box;
  }

  const TriangleMesh& mesh_;
  std::span<const Component> components_;
  Progress* progress_;
  double aside_;
  TriangleClusters clusters_;
  std::vector<std::uint32_t> component_of_;  // each triangle's
  std::vector<bool> meets_;                  // whether a component meets another one
};

// Returns each component's outermost one.
std::vector<std::uint32_t> outermost_of(const TriangleMesh& mesh,
                                        std::span<const Component> components, Progress* progress) {
  const Nesting nesting(mesh, components, progress);
  std::vector<std::uint32_t> outer(components.size());
  parallel_for(components.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
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
  OrientationResult result;
  if (!mesh.triangles.empty()) require_valid(mesh);
  const std::vector<Component> components = components_of(mesh);
  if (progress != nullptr) progress->begin_stage("orienting components", components.size());
  std::vector<int> signs;
  bool all_closed = true, any_volume = false;
  for (const Component& component : components) {
    signs.push_back(component.closed ? volume_sign(mesh, component) : 0);
    all_closed = all_closed && component.closed;
    any_volume = any_volume || signs.back() != 0;
  }
  if (all_closed && any_volume) result.orientation = Orientation::kOutward;
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
