#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

#include "ist/query/workers/resident_worker.h"

namespace ist::test {

/// Stalls the resident worker wherever it reaches `point`, until it is released or destroyed.
class Stall {
 public:
  explicit Stall(HandOver point) {
    point_ = point;
    reached_ = released_ = false;
    hand_over_hook = [](HandOver at) noexcept {
      ++inside_;
      if (at == point_ && !released_) {
        reached_ = true;
        while (!released_) std::this_thread::sleep_for(std::chrono::microseconds(100));
      }
      --inside_;
    };
  }
  ~Stall() {
    hand_over_hook = nullptr;
    release();
    while (inside_ > 0) std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  Stall(const Stall&) = delete;
  Stall& operator=(const Stall&) = delete;

  [[nodiscard]] static bool reached() { return reached_; }
  [[nodiscard]] static bool released() { return released_; }
  static void release() { released_ = true; }

 private:
  static inline std::atomic<HandOver> point_;
  static inline std::atomic<bool> reached_, released_;
  static inline std::atomic<int> inside_{0};
};

/// Releases a stall when a thread waits in Job::wait_idle(), however late that is.
class ReleaseOnWait {
 public:
  ReleaseOnWait()
      : thread_([this, before = idle_naps.load()] {
          // After the second nap the wait has lasted for one nap at least.
          while (idle_naps < before + 2 && !over_) {
            std::this_thread::sleep_for(std::chrono::microseconds(50));
          }
          awaited_ = !over_;
          Stall::release();
        }) {}
  ~ReleaseOnWait() { over_ = true; }
  ReleaseOnWait(const ReleaseOnWait&) = delete;
  ReleaseOnWait& operator=(const ReleaseOnWait&) = delete;

  /// Call this when the thread does not wait any more. Returns whether it waited until the release.
  [[nodiscard]] bool awaited() {
    over_ = true;
    thread_.join();
    return awaited_;
  }

 private:
  std::atomic<bool> over_{false}, awaited_{false};
  std::jthread thread_;
};

/// Keeps the resident worker awake while it lives: an injected schedule.
class Awake {
 public:
  Awake() { always_awake = true; }
  ~Awake() { always_awake = false; }
  Awake(const Awake&) = delete;
  Awake& operator=(const Awake&) = delete;
};

}  // namespace ist::test
