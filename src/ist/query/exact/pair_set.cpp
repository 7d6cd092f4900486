#include "ist/query/exact/pair_set.h"

#include <algorithm>
#include <bit>

namespace ist {

PairSet::PairSet(std::size_t most)
    : slots_(std::bit_ceil(std::max<std::size_t>(2 * most, 2)), kNone),
      used_(most),
      shift_(64 - std::countr_zero(slots_.size())) {}

void PairSet::clear() noexcept {
  for (std::size_t i = 0; i < used_count_; ++i) slots_[used_[i]] = kNone;
  used_count_ = 0;
}

}  // namespace ist
