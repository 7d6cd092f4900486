#include "ist/tree/linear_octree.h"

#include <bit>

#include "ist/base/assert.h"

namespace ist {
namespace {

using Masks = std::vector<std::vector<std::uint8_t>>;

Masks fold(std::span<const std::uint64_t> leaf_codes, int depth) {
  IST_ASSERT(!leaf_codes.empty() && leaf_codes.size() <= UINT32_MAX);
  IST_ASSERT(leaf_codes.back() >> 3 * depth == 0);
  Masks masks(static_cast<std::size_t>(depth));
  std::vector<std::uint64_t> below, parents;
  for (std::vector<std::uint8_t>& level : masks) {
    parents.clear();
    for (const std::uint64_t child : below.empty() ? leaf_codes : below) {
      if (parents.empty() || parents.back() != child >> 3) {
        parents.push_back(child >> 3);
        level.push_back(0);
      }
      level.back() = static_cast<std::uint8_t>(level.back() | 1u << (child & 7));
    }
    std::swap(below, parents);
  }
  return masks;
}

// Appends the children of `parents`, each with its centre; `half` is half the children's edge.
void place_children(std::span<const OctreeNode> parents, std::span<const std::uint8_t> masks,
                    float half, std::vector<OctreeNode>& nodes) {
  for (std::size_t parent = 0; parent < masks.size(); ++parent) {
    const float(&from)[3] = parents[parent].centre;
    for (unsigned bits = masks[parent]; bits != 0; bits &= bits - 1) {
      const int k = std::countr_zero(bits);
      nodes.push_back(
          {{from[0] + ((k & 1) != 0 ? half : -half), from[1] + ((k & 2) != 0 ? half : -half),
            from[2] + ((k & 4) != 0 ? half : -half)},
           0});
    }
  }
}

}  // namespace

LinearOctree::LinearOctree(std::span<const std::uint64_t> leaf_codes, int depth)
    : LinearOctree(fold(leaf_codes, depth)) {}

LinearOctree::LinearOctree(Masks of_levels)
    : masks_(std::move(of_levels)), nodes_(masks_.size() + 1) {
  IST_ASSERT(is_tree(masks_));
  for (std::vector<std::uint8_t>& level : masks_) {
    level.insert(level.end(), kMaskSpare, 0);
    level.shrink_to_fit();
  }
  nodes_.back() = {{{0, 0, 0}, 0}, {{0, 0, 0}, 1}};
  for (int level = depth(); level >= 1; --level) {
    std::vector<OctreeNode>& here = nodes_[index(level)];
    here.reserve(std::size_t{node_count(level)} + 1);
    if (level == depth()) {
      here.push_back({{0, 0, 0}, 0});
    } else {
      place_children(nodes(level + 1), masks(level + 1),
                     static_cast<float>(std::uint64_t{1} << (level - 1)), here);
    }
    std::uint32_t children = 0;
    for (std::uint32_t node = 0; node < node_count(level); ++node) {
      here[node].first_child = children;
      children += static_cast<std::uint32_t>(std::popcount(mask(level, node)));
    }
    here.push_back({{0, 0, 0}, children});
  }
}

bool LinearOctree::is_tree(std::span<const std::vector<std::uint8_t>> masks) noexcept {
  std::uint64_t expected = 1;
  for (auto level = masks.rbegin(); level != masks.rend(); ++level) {
    if (level->size() != expected) return false;
    std::uint64_t children = 0;
    bool empty = false;
    for (const std::uint8_t mask : *level) {
      children += static_cast<std::uint64_t>(std::popcount(mask));
      empty |= mask == 0;
    }
    if (empty || children > UINT32_MAX) return false;
    expected = children;
  }
  return true;
}

std::uint64_t LinearOctree::node_count() const noexcept {
  std::uint64_t count = leaf_count();
  for (int level = 1; level <= depth(); ++level) count += node_count(level);
  return count;
}

std::vector<std::uint64_t> LinearOctree::codes(int level) const {
  std::vector<std::uint64_t> codes{0}, children;
  for (int above = depth(); above > level; --above) {
    children.clear();
    children.reserve(node_count(above - 1));
    for (std::uint32_t node = 0; node < node_count(above); ++node) {
      for (unsigned bits = mask(above, node); bits != 0; bits &= bits - 1) {
        children.push_back(codes[node] << 3 | static_cast<unsigned>(std::countr_zero(bits)));
      }
    }
    std::swap(codes, children);
  }
  return codes;
}

std::uint64_t LinearOctree::bytes() const noexcept {
  std::uint64_t bytes = 0;
  for (const auto& level : masks_) bytes += level.capacity();
  for (const auto& level : nodes_) bytes += level.capacity() * sizeof(OctreeNode);
  return bytes;
}

}  // namespace ist
