#pragma once

#include <cstdint>
#include <span>

#include "ist/base/api.h"
#include "ist/query/search_plan.h"

namespace ist {

/// Takes contacts as they are found, in order, many at a time.
class IST_API ContactStream {
 public:
  /// @return whether more are wanted
  virtual bool take(std::span<const Contact> contacts) noexcept = 0;

 protected:
  ~ContactStream() = default;
};

/// Where contacts go. All are counted; the first go into a span, or all go to a stream.
class ContactSink {
 public:
  explicit ContactSink(std::span<Contact> out) noexcept : out_(out) {}
  /// Contacts pass through the window, which has room for more than kContactSlack of them.
  ContactSink(std::span<Contact> window, ContactStream& stream) noexcept
      : out_(window), stream_(&stream) {}

  /// Appends the pairs of a frontier of leaves.
  void append(const Frontier& leaves, const Kernels& kernels, const SearchPlan& plan) noexcept;
  /// Appends contacts that another sink took.
  void append(std::span<const Contact> contacts) noexcept;

  /// Contacts seen, in the span or not; of a stream those that it was given.
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// Whether the span is too short for them.
  [[nodiscard]] bool truncated() const noexcept {
    return stream_ == nullptr && count_ > out_.size();
  }
  /// Whether the stream wants no more.
  [[nodiscard]] bool stopped() const noexcept { return stopped_; }

 private:
  void hand_over(std::span<const Contact> contacts) noexcept {
    if (stopped_) return;
    count_ += contacts.size();
    stopped_ = !stream_->take(contacts);
  }

  std::span<Contact> out_;
  ContactStream* stream_ = nullptr;
  std::uint64_t count_ = 0;
  bool stopped_ = false;
};

}  // namespace ist
