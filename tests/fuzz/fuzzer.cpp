// What libFuzzer calls. Nothing is caught: an exception ends the process, and is a finding.

#include <cstddef>
#include <cstdint>

#include "fuzz/fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static_cast<void>(ist::test::IST_FUZZ_TARGET({reinterpret_cast<const char*>(data), size}));
  return 0;
}
