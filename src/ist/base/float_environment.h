#pragma once

#include <xmmintrin.h>

namespace ist {

/// Sets IEEE 754 arithmetic (round to nearest, no flush to zero, no denormals are zero) in the
/// calling thread while this object lives, and then restores the caller's MXCSR with its flags.
/// Every function that reads, builds or queries holds one in each thread, constructors included, so
/// a host that changed MXCSR gets the same bits as any other.
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
