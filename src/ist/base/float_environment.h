#pragma once

#include <xmmintrin.h>

namespace ist {

/// Arithmetic as IEEE 754 has it (round to nearest, no flush to zero, no denormals are zero) while
/// this object lives; the caller's setting comes back after, with its flags. What reads, builds or
/// asks holds one in each thread, constructors too, so that a host that changed MXCSR gets the same
/// bits as one that did not.
class ScopedFloatEnvironment {
 public:
  ScopedFloatEnvironment() noexcept : saved_(_mm_getcsr()) { _mm_setcsr(kDefault); }
  ~ScopedFloatEnvironment() { _mm_setcsr(saved_); }
  ScopedFloatEnvironment(const ScopedFloatEnvironment&) = delete;
  ScopedFloatEnvironment& operator=(const ScopedFloatEnvironment&) = delete;

 private:
  static constexpr unsigned kDefault = 0x1F80;  // all exceptions masked, nothing else set
  unsigned saved_;
};

}  // namespace ist
