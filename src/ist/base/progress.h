#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <utility>

#include "ist/base/error.h"

namespace ist {

/// Is told now and then what part of a measure is done, 0 to 1, as far as that is known, and says
/// whether to go on. Called on the caller's thread; an exception reaches the caller.
using Proceed = std::function<bool(double part)>;

/// Holds the progress of a build. The building threads write it; any thread may read it, and end
/// the build, at any time.
class Progress {
 public:
  /// Begins a stage of `total` items. `name` must outlive this object, as a literal does.
  void begin_stage(const char* name, std::uint64_t total) noexcept {
    done_.store(0, std::memory_order_relaxed);
    total_.store(total, std::memory_order_relaxed);
    stage_.store(name, std::memory_order_relaxed);
    stages_.fetch_add(1, std::memory_order_relaxed);
    if (watcher_) watcher_();
  }
  /// Counts `done` more items of the stage. Any building thread may call it.
  void add(std::uint64_t done) noexcept {
    done_.fetch_add(done, std::memory_order_relaxed);
    if (watcher_) watcher_();
  }

  /// Calls `watcher` at each step, on the thread that makes it: for a program without a thread of
  /// its own to look with. To be set before the build; it must not throw.
  void watch(std::function<void()> watcher) { watcher_ = std::move(watcher); }

  /// Asks the build to end: it throws kCancelled soon.
  void stop() noexcept { stopped_.store(true, std::memory_order_relaxed); }
  /// Throws kCancelled where the build was asked to end. The building threads call it.
  void check() const {
    if (stopped_.load(std::memory_order_relaxed)) {
      throw Error(ErrorCode::kCancelled, "the build was ended by its caller");
    }
  }

  /// Returns the number of stages begun.
  [[nodiscard]] unsigned stages() const noexcept { return stages_.load(std::memory_order_relaxed); }
  /// Returns the name of the stage; "" before the first.
  [[nodiscard]] const char* stage() const noexcept {
    return stage_.load(std::memory_order_relaxed);
  }
  /// Returns the part of the stage that is done, 0 to 1; 0 for a stage without items.
  [[nodiscard]] double fraction() const noexcept {
    const auto total = static_cast<double>(total_.load(std::memory_order_relaxed));
    const auto done = static_cast<double>(done_.load(std::memory_order_relaxed));
    return total > 0 ? (done < total ? done / total : 1.0) : 0.0;
  }

 private:
  std::atomic<const char*> stage_{""};
  std::atomic<std::uint64_t> done_{0}, total_{0};
  std::atomic<unsigned> stages_{0};
  std::atomic<bool> stopped_{false};
  std::function<void()> watcher_;
};

}  // namespace ist
