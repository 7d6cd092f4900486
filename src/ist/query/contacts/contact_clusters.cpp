#include "ist/query/contacts/contact_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ist {
namespace {

// Normals whose sum is shorter than this part of their weight have no common direction.
constexpr double kCancelled = 1e-6;
constexpr std::size_t kMarked = 7;  // the deepest and six extremes

// Returns the contact of a node, in the fixed tree's frame.
Contact point_of(const LeafSum& node) noexcept {
  const double length = std::sqrt(dot_in_order(node.normal, node.normal));
  const bool cancelled = length <= kCancelled * node.weight;
  return {node.position / node.weight, cancelled ? node.deepest_normal : node.normal / length,
          node.depth / node.weight, node.weight};
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
Marks find_marks(std::span<const LeafSum> nodes) noexcept {
  std::array<std::size_t, kMarked> best{};
  std::array<double, kMarked> most{};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const LeafSum& node = nodes[i];
    const Eigen::Vector3d p = node.position / node.weight;
    const std::array<double, kMarked> of{
        node.depth / node.weight, -p[0], p[0], -p[1], p[1], -p[2], p[2]};
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

std::size_t cluster(LeafSums& sums, const Eigen::Vector3d& origin,
                    std::span<Contact> out) noexcept {
  if (sums.nodes().empty() || out.empty()) return 0;
  Marks marks = find_marks(sums.nodes());
  const Contact deepest = point_of(sums.nodes()[marks.places[0]]);
  if (sums.nodes().size() > out.size()) marks.count = std::min(marks.count, out.size() - 1);

  std::size_t count = 0;
  const auto marked = std::span(marks.places).first(marks.count);
  for (const std::size_t place : marked) out[count++] = point_of(sums.nodes()[place]);
  sums.take_out(marked);
  while (sums.nodes().size() > out.size() - count) sums.coarsen();
  for (const LeafSum& node : sums.nodes()) out[count++] = point_of(node);
  if (out.size() == 1) {
    const double weight = out[0].weight;
    out[0] = deepest;
    out[0].weight = weight;
  }
  for (Contact& point : out.first(count)) point.position += origin;
  return count;
}

}  // namespace ist
