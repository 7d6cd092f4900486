#pragma once

namespace ist {

/// Tells the processor that the thread polls, for some tens of nanoseconds. Does nothing where a
/// processor has no such instruction.
inline void pause_briefly() noexcept {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("isb" ::: "memory");
#endif
}

}  // namespace ist
