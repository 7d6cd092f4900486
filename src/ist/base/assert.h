#pragma once

#ifdef IST_ASSERTS
#include <cstdio>
#include <cstdlib>
/// Checks a precondition whose breach is a bug in the caller. On in the test presets, which are
/// optimised like the release, because that is where bugs that change values show.
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
