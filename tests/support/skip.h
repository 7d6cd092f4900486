#pragma once

#include <gtest/gtest.h>

#include <cstdlib>

/// Leaves a test that needs something which is not here. The skip is shown; with IST_REQUIRE_ALL=1
/// in the environment it is a failure instead.
#define IST_SKIP(reason)                                                        \
  do {                                                                          \
    const char* require_all = std::getenv("IST_REQUIRE_ALL");                   \
    if (require_all != nullptr && require_all[0] == '1')                        \
      FAIL() << "IST_REQUIRE_ALL is set, and this test cannot run: " << reason; \
    GTEST_SKIP() << reason;                                                     \
  } while (false)
