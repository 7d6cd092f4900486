#include "ist/query/world/near_set.h"

#include <algorithm>

#include "ist/query/world/pair_table.h"

namespace ist {

bool NearSet::is_before(const Entry& a, const Entry& b) noexcept {
  return a.prepared != b.prepared ? a.prepared : a.bodies < b.bodies;
}

void NearSet::clear() noexcept {
  pairs_.clear();
  order_.clear();
  count_ = 0;
}

void NearSet::add(const PairAtPose& pair) noexcept {
  ++count_;
  Entry entry{pair.place < PairTable::kIgnored, pair.bodies,
              static_cast<std::uint32_t>(order_.size())};
  if (order_.size() < room_) {  // both lists have this room
    pairs_.push_back(pair);
    order_.push_back(entry);
    if (order_.size() == room_) std::make_heap(order_.begin(), order_.end(), is_before);
    return;
  }
  if (room_ == 0 || !is_before(entry, order_.front())) return;
  std::pop_heap(order_.begin(), order_.end(), is_before);
  entry.at = order_.back().at;
  pairs_[entry.at] = pair;
  order_.back() = entry;
  std::push_heap(order_.begin(), order_.end(), is_before);
}

void NearSet::finish() noexcept {
  std::sort(order_.begin(), order_.end(),
            [](const Entry& a, const Entry& b) { return a.bodies < b.bodies; });
}

}  // namespace ist
