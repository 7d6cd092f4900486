#pragma once

#include <cfenv>
#include <cstdint>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace ist::test {

/// The caller's arithmetic while it lives: a rounding of its own, and perhaps zero in place of each
/// denormal number, as programs that are compiled for fast arithmetic set it.
class HostArithmetic {
 public:
  HostArithmetic(int rounding, bool flushes) : saved_(control()) {
    std::fesetround(rounding);
    if (flushes) write(control() | kFlushes);
    set_ = control();
  }
  ~HostArithmetic() {
    std::fesetround(FE_TONEAREST);
    write(saved_);
  }
  HostArithmetic(const HostArithmetic&) = delete;
  HostArithmetic& operator=(const HostArithmetic&) = delete;
  /// Whether it is as it was set.
  [[nodiscard]] bool is_kept() const { return control() == set_; }

 private:
#if defined(__x86_64__)
  static constexpr std::uint64_t kFlushes = 0x8040;  // FTZ and DAZ of MXCSR
  static std::uint64_t control() { return _mm_getcsr() & ~0x3FU; }
  static void write(std::uint64_t control) { _mm_setcsr(static_cast<unsigned>(control)); }
#elif defined(__aarch64__)
  static constexpr std::uint64_t kFlushes = 1 << 24;  // FZ of FPCR
  static std::uint64_t control() {
    std::uint64_t control = 0;
    asm volatile("mrs %0, fpcr" : "=r"(control));
    return control;
  }
  static void write(std::uint64_t control) {
    asm volatile("msr fpcr, %0" : : "r"(control) : "memory");
  }
#endif

  std::uint64_t saved_, set_;
};

}  // namespace ist::test
