#include "ist/query/contacts/leaf_sums.h"

#include <algorithm>

#include "ist/base/assert.h"

namespace ist {

LeafSums::LeafSums(const NodeParents& parents, std::size_t most)
    : parents_(parents),
      place_(most > 0 ? parents.leaf_count() : 0, 0),
      nodes_(std::min(most, parents.leaf_count())) {}

void LeafSums::clear() noexcept {
  count_ = 0;
  level_ = 0;
}

void LeafSums::insert(std::uint32_t leaf, const PairTerms& pair) noexcept {
  while (count_ == nodes_.size()) {
    coarsen();
    if (LeafSum* found = find(parents_.of_leaf(leaf, level_)); found != nullptr) {
      found->add(pair);
      return;
    }
  }
  const std::uint32_t node = parents_.of_leaf(leaf, level_);
  place_[node] = static_cast<std::uint32_t>(count_);
  nodes_[count_++] = LeafSum(node, pair);
}

void LeafSums::coarsen() noexcept {
  IST_ASSERT(level_ < parents_.depth());
  const std::size_t before = count_;
  count_ = 0;
  for (std::size_t i = 0; i < before; ++i) {
    LeafSum node = nodes_[i];
    node.node = parents_.of(level_, node.node);
    if (LeafSum* found = find(node.node); found != nullptr) {
      found->add(node);
    } else {
      place_[node.node] = static_cast<std::uint32_t>(count_);
      nodes_[count_++] = node;
    }
  }
  ++level_;
}

void LeafSums::take_out(std::span<const std::size_t> places) noexcept {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (std::find(places.begin(), places.end(), i) != places.end()) continue;
    place_[nodes_[i].node] = static_cast<std::uint32_t>(kept);
    nodes_[kept++] = nodes_[i];
  }
  count_ = kept;
}

std::size_t LeafSums::bytes() const noexcept {
  return place_.size() * sizeof(std::uint32_t) + nodes_.size() * sizeof(LeafSum);
}

}  // namespace ist
