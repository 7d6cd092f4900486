#include "ist/query/triangles/pair_list.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace ist {
namespace {

constexpr unsigned kDigit = 8;
// Fewer are sorted as fast without counting.
constexpr std::size_t kFew = 64;

// Sorts by one number of the pairs, digit by digit, and keeps the order of those that are equal.
// Swaps the spans after each digit, so that the result is in `pairs`.
template <class Number>
void sort_by(Number number, std::span<TrianglePair>& pairs, std::span<TrianglePair>& other) {
  std::uint32_t all = 0;
  for (const TrianglePair& pair : pairs) all |= number(pair);
  for (unsigned shift = 0; shift < static_cast<unsigned>(std::bit_width(all)); shift += kDigit) {
    std::array<std::uint32_t, 1U << kDigit> ends{};
    const auto digit = [&](const TrianglePair& pair) {
      return number(pair) >> shift & ((1U << kDigit) - 1);
    };
    for (const TrianglePair& pair : pairs) ++ends[digit(pair)];
    std::uint32_t sum = 0;
    for (std::uint32_t& end : ends) sum += std::exchange(end, sum);
    for (const TrianglePair& pair : pairs) other[ends[digit(pair)]++] = pair;
    std::swap(pairs, other);
  }
}

}  // namespace

void PairList::begin(std::span<TrianglePair> out) noexcept {
  out_ = out;
  count_ = 0;
}

// A full span is a heap of the first pairs so far, with the last of them on top.
void PairList::add(TrianglePair pair) noexcept {
  const std::uint64_t room = out_.size();
  if (count_ < room) {
    out_[count_++] = pair;
    if (count_ == room) std::make_heap(out_.begin(), out_.end());
    return;
  }
  ++count_;
  if (room == 0 || !(pair < out_[0])) return;
  std::pop_heap(out_.begin(), out_.end());
  out_.back() = pair;
  std::push_heap(out_.begin(), out_.end());
}

void PairList::finish() noexcept {
  const std::span<TrianglePair> found = out_.first(std::min<std::uint64_t>(count_, out_.size()));
  if (found.size() < kFew || found.size() > scratch_.size()) {
    std::sort(found.begin(), found.end());
    return;
  }
  std::span<TrianglePair> pairs = found, other = std::span(scratch_).first(found.size());
  sort_by([](const TrianglePair& pair) { return pair.moving; }, pairs, other);
  sort_by([](const TrianglePair& pair) { return pair.fixed; }, pairs, other);
  if (pairs.data() != found.data()) std::copy(pairs.begin(), pairs.end(), found.begin());
}

}  // namespace ist
