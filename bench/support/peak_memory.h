#pragma once

namespace ist::bench {

/// The most memory that this process has had in use since reset, in MB. Linux counts it; where it
/// does not, the answer is 0.
void reset_peak_memory();
[[nodiscard]] double peak_memory_mb();

}  // namespace ist::bench
