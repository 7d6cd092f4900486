#pragma once

#include <atomic>
#include <chrono>
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
  static void release() { released_ = true; }

 private:
  static inline std::atomic<HandOver> point_;
  static inline std::atomic<bool> reached_, released_;
  static inline std::atomic<int> inside_{0};
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
