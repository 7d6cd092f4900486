#include "ist/capi/last_error.h"

#include <algorithm>

namespace ist::capi {
namespace {

// A thread gets it with its stack, and has nothing to make and nothing to destroy.
constinit thread_local char message[kLastErrorBytes] = {};

}  // namespace

void set_last_error(std::string_view place, std::string_view text) noexcept {
  char* to = message;
  for (const std::string_view part : {place, std::string_view(": "), text}) {
    const auto room = static_cast<std::size_t>(message + kLastErrorBytes - 1 - to);
    to = std::copy_n(part.data(), std::min(part.size(), room), to);
  }
  *to = '\0';
}

const char* last_error() noexcept { return message; }

}  // namespace ist::capi
