#pragma once

#include <cstdint>

namespace ist::test {

/// How often this thread asked for a lock so far, whoever made it: by the functions of pthread.h
/// and semaphore.h that locks.cpp replaces, which wait without a limit of time, or try a mutex.
[[nodiscard]] std::uint64_t locks() noexcept;

}  // namespace ist::test
