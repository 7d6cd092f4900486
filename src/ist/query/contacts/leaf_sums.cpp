#include "ist/query/contacts/leaf_sums.h"

#include <algorithm>

#include "ist/base/assert.h"

namespace ist {
namespace {

// Adds the pairs [begin, end), of one leaf, one after the other, so that it does not matter where a
// batch ends.
void add(const ContactTerms& terms, std::size_t begin, std::size_t end, LeafSum& sum) noexcept {
  double weight = sum.weight, depth = sum.depth;
  double x = sum.position[0], y = sum.position[1], z = sum.position[2];
  double fx = sum.force[0], fy = sum.force[1], fz = sum.force[2];
  for (std::size_t i = begin; i < end; ++i) {
    const double w = terms.weight[i];
    weight += w;
    depth += w * terms.depth[i];
    x += w * terms.x[i];
    y += w * terms.y[i];
    z += w * terms.z[i];
    fx += terms.force_x[i];
    fy += terms.force_y[i];
    fz += terms.force_z[i];
  }
  sum.weight = weight;
  sum.depth = depth;
  sum.position = {x, y, z};
  sum.force = {fx, fy, fz};
}

}  // namespace

LeafSums::LeafSums(const LinearOctree& octree, std::size_t most)
    : LeafSums(bytes_for(octree, most) / sizeof(LeafSum)) {
  bind(octree, most);
}

void LeafSums::bind(const LinearOctree& octree, std::size_t most) noexcept {
  IST_ASSERT(most > 0 && static_cast<std::size_t>(octree.depth()) < kMostLevels);
  octree_ = &octree;
  room_ = std::min<std::size_t>(most, octree.leaf_count());
  IST_ASSERT(room_ <= nodes_.size());
  clear();
}

std::size_t LeafSums::bytes_for(const LinearOctree& octree, std::size_t most) noexcept {
  return std::min<std::size_t>(most, octree.leaf_count()) * sizeof(LeafSum);
}

void LeafSums::clear() noexcept {
  shorten(0);
  level_ = 0;
  parents_.fill(0);
}

void LeafSums::take(const ContactTerms& terms) noexcept {
  for (std::size_t i = 0; i < terms.count;) {
    const std::uint32_t leaf = terms.fixed[i];
    std::size_t begin = i;
    while (++i < terms.count && terms.fixed[i] == leaf) {
    }
    while (begin < i && !(terms.weight[begin] > 0)) ++begin;
    if (begin == i) continue;
    if (!open_ || last_.node != leaf) {
      close();
      const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
      last_ = {leaf, {terms.force_x[begin], terms.force_y[begin], terms.force_z[begin]}, 0, 0, zero,
               zero};
      open_ = true;
    }
    add(terms, begin, i, last_);
  }
}

void LeafSums::append(std::span<const LeafSum> leaves) noexcept {
  close();
  for (const LeafSum& leaf : leaves) push(leaf);
}

void LeafSums::close() noexcept {
  if (open_) push(last_);
  open_ = false;
}

void LeafSums::push(const LeafSum& leaf) noexcept {
  while (true) {
    std::uint32_t node = leaf.node;
    for (int level = 0; level < level_; ++level) node = parent_of(level, node);
    if (count_ > 0 && nodes_[count_ - 1].node == node) {
      nodes_[count_ - 1].add(leaf);
      return;
    }
    if (count_ < room_) {
      nodes_[count_] = leaf;
      nodes_[count_++].node = node;
      return;
    }
    if (octree_ == nullptr) {
      short_ = true;
      return;
    }
    coarsen();
  }
}

// Nodes are asked for in ascending order, so a parent is looked for from the last one on, in steps
// that double.
std::uint32_t LeafSums::parent_of(int level, std::uint32_t node) noexcept {
  if (level == 0) return node / 8;
  const std::span<const OctreeNode> above = octree_->nodes(level + 1);
  std::uint32_t& parent = parents_[static_cast<std::size_t>(level)];
  std::size_t low = parent, step = 1;
  while (low + step < above.size() && above[low + step].first_child <= node) {
    low += step;
    step *= 2;
  }
  const auto from = above.begin() + static_cast<std::ptrdiff_t>(low);
  const auto to = above.begin() + static_cast<std::ptrdiff_t>(std::min(low + step, above.size()));
  const auto after = std::upper_bound(
      from, to, node,
      [](std::uint32_t n, const OctreeNode& candidate) { return n < candidate.first_child; });
  parent = static_cast<std::uint32_t>(after - above.begin() - 1);
  return parent;
}

void LeafSums::coarsen() noexcept {
  IST_ASSERT(level_ < octree_->depth());
  const std::size_t before = count_;
  count_ = 0;
  parents_[static_cast<std::size_t>(level_)] = 0;
  for (std::size_t i = 0; i < before; ++i) {
    const std::uint32_t node = parent_of(level_, nodes_[i].node);
    if (count_ > 0 && nodes_[count_ - 1].node == node) {
      nodes_[count_ - 1].add(nodes_[i]);
    } else {
      if (count_ != i) nodes_[count_] = nodes_[i];
      nodes_[count_++].node = node;
    }
  }
  ++level_;
}

void LeafSums::take_out(std::span<const std::size_t> places) noexcept {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (std::find(places.begin(), places.end(), i) != places.end()) continue;
    if (kept != i) nodes_[kept] = nodes_[i];
    ++kept;
  }
  count_ = kept;
}

void LeafSums::shorten(std::size_t count) noexcept {
  count_ = count;
  open_ = short_ = false;
}

}  // namespace ist
