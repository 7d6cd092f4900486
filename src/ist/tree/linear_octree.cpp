#include "ist/tree/linear_octree.h"

#include <bit>

#include "ist/base/assert.h"

namespace ist {

LinearOctree::LinearOctree(std::span<const std::uint64_t> leaf_codes, int depth)
    : leaf_count_(static_cast<std::uint32_t>(leaf_codes.size())),
      levels_(static_cast<std::size_t>(depth)) {
  IST_ASSERT(!leaf_codes.empty() && leaf_codes.size() <= UINT32_MAX);
  IST_ASSERT(leaf_codes.back() >> 3 * depth == 0);
  std::vector<std::uint64_t> below, parents;
  for (Level& level : levels_) {
    const std::span<const std::uint64_t> children = below.empty() ? leaf_codes : below;
    parents.clear();
    for (std::size_t child = 0; child < children.size(); ++child) {
      const std::uint64_t parent = children[child] >> 3;
      if (parents.empty() || parents.back() != parent) {
        parents.push_back(parent);
        level.first_child.push_back(static_cast<std::uint32_t>(child));
        level.masks.push_back(0);
      }
      level.masks.back() =
          static_cast<std::uint8_t>(level.masks.back() | 1u << (children[child] & 7));
    }
    level.first_child.shrink_to_fit();
    level.masks.shrink_to_fit();
    std::swap(below, parents);
  }
}

LinearOctree::LinearOctree(std::vector<std::vector<std::uint8_t>> masks) : levels_(masks.size()) {
  IST_ASSERT(is_tree(masks));
  for (std::size_t i = 0; i < masks.size(); ++i) {
    Level& level = levels_[i];
    level.masks = std::move(masks[i]);
    level.first_child.resize(level.masks.size());
    std::uint32_t children = 0;
    for (std::size_t node = 0; node < level.masks.size(); ++node) {
      level.first_child[node] = children;
      children += static_cast<std::uint32_t>(std::popcount(level.masks[node]));
    }
    if (i == 0) leaf_count_ = children;
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
  std::uint64_t count = leaf_count_;
  for (const Level& level : levels_) count += level.masks.size();
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
  for (const Level& level : levels_) {
    bytes += level.masks.capacity() + level.first_child.capacity() * sizeof(std::uint32_t);
  }
  return bytes;
}

}  // namespace ist
