#pragma once

#include <cstdint>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace ist {

/// A thread's control of floating point arithmetic, and the exceptions that its arithmetic has
/// raised: MXCSR on x86-64, FPCR and FPSR on ARM64. WebAssembly has neither: its arithmetic is
/// always that of IEEE 754.
class FloatRegisters {
 public:
  /// Round to nearest, no flush to zero, no denormals are zero, no exception raised or trapped.
  FloatRegisters() = default;

  [[nodiscard]] static FloatRegisters read() noexcept {
    FloatRegisters now;
#if defined(__x86_64__)
    now.control_ = _mm_getcsr();
#elif defined(__aarch64__)
    asm volatile("mrs %0, fpcr" : "=r"(now.control_));
    asm volatile("mrs %0, fpsr" : "=r"(now.raised_));
#endif
    return now;
  }

  void write() const noexcept {
#if defined(__x86_64__)
    _mm_setcsr(static_cast<unsigned>(control_));
#elif defined(__aarch64__)
    asm volatile("msr fpcr, %0" : : "r"(control_) : "memory");
    asm volatile("msr fpsr, %0" : : "r"(raised_) : "memory");
#endif
  }

 private:
#if defined(__x86_64__)
  std::uint64_t control_ = 0x1F80;  // all exceptions masked, nothing else set
#elif defined(__aarch64__)
  std::uint64_t control_ = 0, raised_ = 0;
#endif
};

}  // namespace ist
