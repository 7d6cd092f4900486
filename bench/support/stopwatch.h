#pragma once

#include <chrono>

namespace ist::bench {

/// Wall time since it was made.
class Stopwatch {
 public:
  [[nodiscard]] double microseconds() const {
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin_)
        .count();
  }
  [[nodiscard]] double milliseconds() const { return 1e-3 * microseconds(); }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace ist::bench
