#pragma once

#include <fmt/format.h>
#include <valgrind/callgrind.h>

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

namespace ist::test {

/// The answer of the queries that were counted.
struct Answer {
  std::uint64_t found, sphere_tests;
  friend bool operator==(const Answer&, const Answer&) = default;
};

/// Counts what `query` does, and prints a line of it. Callgrind counts only between START and STOP,
/// and all else runs several times as fast. The query is asked once before, so that neither the
/// linker's work nor a first allocation counts.
inline void count(const std::string& name, const std::function<Answer()>& query) {
  const Answer before = query();
  CALLGRIND_START_INSTRUMENTATION;
  const Answer answer = query();
  CALLGRIND_STOP_INSTRUMENTATION;
  CALLGRIND_DUMP_STATS_AT(name.c_str());
  if (answer != before) throw std::runtime_error(name + " was asked twice, and answers differ");
  fmt::print("{} {} {}\n", name, answer.found, answer.sphere_tests);
}

}  // namespace ist::test
