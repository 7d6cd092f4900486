#pragma once

#include "ist/base/platform/float_registers.h"

namespace ist {

/// Sets IEEE 754 arithmetic (FloatRegisters()) in the calling thread while this object lives, and
/// then restores the caller's, with its flags. Every function that reads, builds or queries holds
/// one in each thread, constructors included, so a host that changed its arithmetic gets the same
/// bits as any other.
class ScopedFloatEnvironment {
 public:
  ScopedFloatEnvironment() noexcept : saved_(FloatRegisters::read()) { FloatRegisters().write(); }
  ~ScopedFloatEnvironment() { saved_.write(); }
  ScopedFloatEnvironment(const ScopedFloatEnvironment&) = delete;
  ScopedFloatEnvironment& operator=(const ScopedFloatEnvironment&) = delete;

 private:
  FloatRegisters saved_;
};

}  // namespace ist
