#pragma once

#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace ist::bench {

/// While it lives, as many threads as the machine has cores stream through kMegabytes each, which
/// no core's own cache holds, and compute on it, at the priority of ordinary threads. Made before a
/// thread asks for a higher one, which they would begin with.
class NoisyNeighbour {
 public:
  static constexpr std::size_t kMegabytes = 64;
  /// @param there whether there is one at all
  explicit NoisyNeighbour(bool there);
  ~NoisyNeighbour();
  NoisyNeighbour(const NoisyNeighbour&) = delete;
  NoisyNeighbour& operator=(const NoisyNeighbour&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::atomic<unsigned> at_work_{0};
  std::vector<std::thread> threads_;
};

}  // namespace ist::bench
