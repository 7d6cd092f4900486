#include "ist/query/traversal/visitor.h"

#include <algorithm>

namespace ist {
namespace {

// Writes a frontier's leaf pairs into a span, from where the last call ended: whole groups by
// vectors, which write past their end, and the rest one by one.
class Writer {
 public:
  Writer(const Frontier& leaves, const Kernels& kernels, const SearchPlan& plan)
      : leaves_(leaves), kernels_(kernels), plan_(plan) {}

  [[nodiscard]] bool done() const { return moving_ == leaves_.moving_count; }

  // Writes as many pairs as fit and returns their number.
  std::size_t write(std::span<LeafPair> out) {
    std::size_t written = moving_ == 0 ? write_groups(out) : 0;
    while (!done() && written < out.size()) {
      const SearchGroup group = leaves_.groups[group_];
      while (moving_ < group.end && written < out.size()) {
        out[written++] = {group.fixed, leaves_.moving[moving_++]};
      }
      if (moving_ == group.end) ++group_;
    }
    plan_.resolve(out.first(written));
    return written;
  }

 private:
  std::size_t write_groups(std::span<LeafPair> out) {
    Frontier whole = leaves_;
    const auto end = [&] {
      return whole.group_count == 0 ? 0 : whole.groups[whole.group_count - 1].end;
    };
    while (whole.group_count > 0 && end() + kLeafPairSpare > out.size()) --whole.group_count;
    kernels_.write_leaf_pairs(whole, out.data());
    group_ = whole.group_count;
    moving_ = end();
    return moving_;
  }

  const Frontier& leaves_;
  const Kernels& kernels_;
  const SearchPlan& plan_;
  std::size_t group_ = 0;
  std::uint32_t moving_ = 0;
};

}  // namespace

void LeafPairSink::append(const Frontier& leaves) noexcept {
  Writer writer(leaves, kernels_, plan_);
  if (stream_ == nullptr) {
    writer.write(out_.subspan(std::min<std::size_t>(count_, out_.size())));
    count_ += leaves.moving_count;
  } else {
    while (!writer.done() && !stopped_) hand_over(out_.first(writer.write(out_)));
  }
}

void LeafPairSink::append(std::span<const LeafPair> leaf_pairs) noexcept {
  if (stream_ == nullptr) {
    const std::size_t begin = std::min<std::size_t>(count_, out_.size());
    const std::size_t fit = std::min(leaf_pairs.size(), out_.size() - begin);
    std::copy_n(leaf_pairs.begin(), fit, out_.begin() + static_cast<std::ptrdiff_t>(begin));
    count_ += leaf_pairs.size();
  } else {
    hand_over(leaf_pairs);
  }
}

}  // namespace ist
