#pragma once

#include <cstddef>
#include <functional>

namespace ist::test {

/// The most bytes that any one `new` asks for while `action` runs, on any thread. A program that
/// calls this has its operator new replaced.
[[nodiscard]] std::size_t largest_allocation(const std::function<void()>& action);

/// The most bytes that `new` has given out at once while `action` runs, on any thread, beyond those
/// given out before.
[[nodiscard]] std::size_t peak_allocation(const std::function<void()>& action);

}  // namespace ist::test
