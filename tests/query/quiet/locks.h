#pragma once

#include <cstdint>

namespace ist::test {

/// How often this thread asked for a lock so far: a mutex, a lock of readers and writers, a spin
/// lock, a condition or a semaphore, whoever made it. A program that calls this has the functions
/// of pthread.h and semaphore.h replaced.
[[nodiscard]] std::uint64_t locks() noexcept;

}  // namespace ist::test
