#pragma once

#ifdef IST_ASSERTS
#include <cstdio>
#include <cstdlib>
/// Aborts if a precondition fails, which is a bug of the caller. Enabled in the test presets, which
/// are optimised like the release so that bugs that optimisation exposes appear there.
#define IST_ASSERT(condition)                                                                \
  do {                                                                                       \
    if (!(condition)) {                                                                      \
      std::fprintf(stderr, "%s:%d: assertion failed: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                          \
    }                                                                                        \
  } while (false)
#else
#define IST_ASSERT(condition) static_cast<void>(0)
#endif
