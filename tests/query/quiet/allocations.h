#pragma once

#include <cstdint>

namespace ist::test {

/// How often memory was asked for so far, by malloc, new or any other way, on any thread. A program
/// that calls this has its malloc replaced.
[[nodiscard]] std::uint64_t allocations() noexcept;
/// The sum of the bytes that were asked for so far.
[[nodiscard]] std::uint64_t allocated_bytes() noexcept;

}  // namespace ist::test
