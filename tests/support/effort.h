#pragma once

#include <concepts>
#include <cstdlib>

namespace ist::test {

/// The share of its samples that a property test draws: IST_EFFORT, or 1 if it is not set. The fast
/// tests set 0.2, long runs 20 and more. A value that is not a positive number ends the program.
[[nodiscard]] double effort();

/// The number of samples that a property test draws: `all` times `effort()`, rounded up. Use it as
/// the end of the loop over seeds, random poses or rounds. Expectations on totals must scale with
/// it too, or use `least`.
[[nodiscard]] double scaled_by_effort(double all);
template <std::integral Count>
[[nodiscard]] Count samples(Count all) {
  return static_cast<Count>(scaled_by_effort(static_cast<double>(all)));
}

/// The total that a property test must exceed to have tried anything: `full` with all samples,
/// `few` with less.
template <typename Total>
[[nodiscard]] Total least(Total full, Total few) {
  return effort() < 1 ? few : full;
}

}  // namespace ist::test

/// Leaves a test that takes long even with one sample to runs with full effort. Write it as the
/// first line of the test.
#define IST_SLOW()                                                                          \
  do {                                                                                      \
    if (ist::test::effort() < 1) GTEST_SKIP() << "slow: it runs with IST_EFFORT=1 or more"; \
  } while (false)

/// Leaves a test that needs something which is not here. The skip is shown; with IST_REQUIRE_ALL=1
/// in the environment it is a failure instead.
#define IST_SKIP(reason)                                                        \
  do {                                                                          \
    const char* require_all = std::getenv("IST_REQUIRE_ALL");                   \
    if (require_all != nullptr && require_all[0] == '1')                        \
      FAIL() << "IST_REQUIRE_ALL is set, and this test cannot run: " << reason; \
    GTEST_SKIP() << reason;                                                     \
  } while (false)
