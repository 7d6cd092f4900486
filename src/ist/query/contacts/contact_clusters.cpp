#include "ist/query/contacts/contact_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ist {
namespace {

// Normals whose sum is shorter than this part of their weight have no common direction.
constexpr double kCancelled = 1e-5;
constexpr std::size_t kMarked = 7;  // the deepest and six extremes

double length_of(const Eigen::Vector3d& v) noexcept { return std::sqrt(dot_in_order(v, v)); }

Eigen::Vector3d position_of(const LeafSum& node, const LeafSumUnits& units) noexcept {
  return sum(units.origin, moved(units.pose, scaled(units.lever / node.weight, node.position)));
}

double depth_of(const LeafSum& node, const LeafSumUnits& units) noexcept {
  return std::clamp(units.least + node.depth / node.weight, units.least, units.most);
}

Contact point_of(const LeafSum& node, const LeafSumUnits& units) noexcept {
  const double length = length_of(node.force);
  const Eigen::Vector3d first(node.first[0], node.first[1], node.first[2]);
  const Eigen::Vector3d normal = length <= kCancelled * node.weight
                                     ? scaled(1 / length_of(first), first)
                                     : scaled(1 / length, node.force);
  return {position_of(node, units), turned(units.pose, normal), depth_of(node, units),
          units.area * node.weight};
}

// The places of the nodes that stay apart, each once.
struct Marks {
  std::array<std::size_t, kMarked> places;
  std::size_t count = 0;

  void add(std::size_t place) noexcept {
    const auto end = places.begin() + static_cast<std::ptrdiff_t>(count);
    if (std::find(places.begin(), end, place) == end) places[count++] = place;
  }
};

// Of equal nodes the first is marked.
Marks find_marks(std::span<const LeafSum> nodes, const LeafSumUnits& units) noexcept {
  std::array<std::size_t, kMarked> best{};
  std::array<double, kMarked> most{};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const LeafSum& node = nodes[i];
    const Eigen::Vector3d p = position_of(node, units);
    const std::array<double, kMarked> of{
        depth_of(node, units), -p[0], p[0], -p[1], p[1], -p[2], p[2]};
    for (std::size_t k = 0; k < kMarked; ++k) {
      if (i > 0 && of[k] <= most[k]) continue;
      most[k] = of[k];
      best[k] = i;
    }
  }
  Marks marks;
  for (const std::size_t place : best) marks.add(place);
  return marks;
}

}  // namespace

std::size_t cluster(LeafSums& sums, const LeafSumUnits& units, std::span<Contact> out) noexcept {
  if (sums.nodes().empty() || out.empty()) return 0;
  Marks marks = find_marks(sums.nodes(), units);
  const Contact deepest = point_of(sums.nodes()[marks.places[0]], units);
  if (sums.nodes().size() > out.size()) marks.count = std::min(marks.count, out.size() - 1);

  std::size_t count = 0;
  const auto marked = std::span(marks.places).first(marks.count);
  for (const std::size_t place : marked) out[count++] = point_of(sums.nodes()[place], units);
  sums.take_out(marked);
  while (sums.nodes().size() > out.size() - count) sums.coarsen();
  for (const LeafSum& node : sums.nodes()) out[count++] = point_of(node, units);
  if (out.size() == 1) {
    const double weight = out[0].weight;
    out[0] = deepest;
    out[0].weight = weight;
  }
  return count;
}

}  // namespace ist
