#pragma once

#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace ist {

/// The vector instructions of x86-64 that the processor has and that the system saves the registers
/// of. Each set holds those before it, and all that Highway lets a compiler use for the target of
/// the same name; on other processors all are false.
struct InstructionSets {
  bool ssse3 = false;
  bool sse4 = false;  ///< with 4.1, 4.2, AES and carry-less products
  bool avx2 = false;  ///< with BMI, BMI2, FMA and half floats
  bool avx3 = false;  ///< AVX-512 F, VL, DQ and BW
};

[[nodiscard]] inline InstructionSets instruction_sets() {
  InstructionSets sets;
#if defined(__x86_64__)
  const auto all = [](auto... has) { return (... && (has != 0)); };
  __builtin_cpu_init();
  sets.ssse3 = all(__builtin_cpu_supports("ssse3"));
  sets.sse4 = sets.ssse3 && all(__builtin_cpu_supports("sse4.1"), __builtin_cpu_supports("sse4.2"),
                                __builtin_cpu_supports("aes"), __builtin_cpu_supports("pclmul"));
  // clang 14 knows no name of half floats.
  unsigned a = 0, b = 0, c = 0, d = 0;
  const bool f16c = __get_cpuid(1, &a, &b, &c, &d) != 0 && (c & bit_F16C) != 0;
  sets.avx2 = sets.sse4 && f16c &&
              all(__builtin_cpu_supports("avx2"), __builtin_cpu_supports("bmi"),
                  __builtin_cpu_supports("bmi2"), __builtin_cpu_supports("fma"));
  sets.avx3 =
      sets.avx2 && all(__builtin_cpu_supports("avx512f"), __builtin_cpu_supports("avx512vl"),
                       __builtin_cpu_supports("avx512dq"), __builtin_cpu_supports("avx512bw"));
#endif
  return sets;
}

}  // namespace ist
