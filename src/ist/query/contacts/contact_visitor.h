#pragma once

#include <cstdint>
#include <span>

#include "ist/query/contacts/leaf_sums.h"
#include "ist/query/traversal/visitor.h"

namespace ist {

/// The destination of a search for contacts: sums, and sums by leaf where points are wanted.
class ContactOutput {
 public:
  /// `adder` gives its terms to `leaves`, unless that is null.
  ContactOutput(const SearchPlan& plan, const Kernels& kernels, const SearchPose& pose,
                ContactAdder& adder, LeafSums* leaves) noexcept
      : plan_(plan), kernels_(kernels), pose_(pose), adder_(adder), leaves_(leaves) {}

  [[nodiscard]] ContactAdder& adder() const noexcept { return adder_; }
  [[nodiscard]] LeafSums* leaves() const noexcept { return leaves_; }

  /// Adds up the pairs that the adder keeps in its lanes.
  void flush() const noexcept { kernels_.add_contacts(plan_.steps().back(), pose_, adder_); }
  /// Adds the sums that another sink made, of pairs that follow all of this one's.
  void append(const ContactTotals& totals, std::span<const LeafSum> leaves) const noexcept {
    flush();
    adder_.totals.add(totals);
    if (leaves_ != nullptr) leaves_->append(leaves);
  }
  /// Forgets all pairs.
  void clear() const noexcept {
    adder_.clear();
    if (leaves_ != nullptr) leaves_->clear();
  }

  /// Returns the number of leaf pairs.
  [[nodiscard]] std::uint64_t count() const noexcept {
    return adder_.totals.pairs + adder_.lanes.count;
  }
  [[nodiscard]] static bool stopped() noexcept { return false; }
  [[nodiscard]] static bool truncated() noexcept { return false; }

 private:
  const SearchPlan& plan_;
  const Kernels& kernels_;
  const SearchPose& pose_;
  ContactAdder& adder_;
  LeafSums* leaves_;
};

/// Adds up all leaf pairs within a budget: the last step tests and weighs them in one.
class ContactVisitor : public MeteredVisitor {
 public:
  using Sink = ContactOutput;

  ContactVisitor(const SearchPose& pose, ContactOutput& sink, const BudgetMeter& meter = {},
                 Measured measured = Measured::kNothing) noexcept
      : MeteredVisitor(pose, meter, measured), sink_(sink) {}

  Advanced advance(const SearchBatch& batch) noexcept {
    const Advanced made =
        batch.step.last ? batch.kernels.advance_contacts(batch.step, pose_, batch.in, batch.cursor,
                                                         sink_.adder(), batch.scratch,
                                                         meter_.allow(), measured_, bounds_)
                        : batch.measure(measured_, pose_, bounds_, meter_.allow());
    meter_.spend(made.tests);
    return made;
  }
  static bool leaves(const Frontier& /*none*/) noexcept { return true; }

 private:
  ContactOutput& sink_;
};

}  // namespace ist
