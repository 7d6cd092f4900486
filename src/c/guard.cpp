#include "c/guard.h"

#include <algorithm>
#include <exception>
#include <new>
#include <stdexcept>
#include <system_error>

#include "c/status.h"
#include "ist/base/error.h"

namespace ist::capi {
namespace {

// Part of a thread's static storage, without constructor and destructor.
constinit thread_local char message[kLastErrorBytes] = {};

}  // namespace

const char* last_error() noexcept { return message; }

void Call::store(ist_status status, std::string_view text) noexcept {
  if (status_ != IST_OK) return;
  status_ = status;
  char* to = message;
  for (const std::string_view part : {std::string_view(function_), std::string_view(": "), text}) {
    const auto room = static_cast<std::size_t>(message + kLastErrorBytes - 1 - to);
    to = std::copy_n(part.data(), std::min(part.size(), room), to);
  }
  *to = '\0';
}

void Call::store_formatted(ist_status status, fmt::string_view text, fmt::format_args args) {
  char buffer[kLastErrorBytes];
  const auto end = fmt::vformat_to_n(buffer, kLastErrorBytes, text, args).out;
  store(status, {buffer, static_cast<std::size_t>(end - buffer)});
}

void Call::fail_by_exception() noexcept {
  constexpr const char* kNoMemory = "not enough memory: request less, or free unused objects";
  try {
    throw;
  } catch (const Error& error) {
    store(status_of(error.code()), error.what());
  } catch (const std::bad_alloc&) {
    store(IST_OUT_OF_MEMORY, kNoMemory);
  } catch (const std::length_error&) {  // from a vector beyond its largest size
    store(IST_OUT_OF_MEMORY, kNoMemory);
  } catch (const std::system_error& error) {
    store(IST_SYSTEM_ERROR, error.what());
  } catch (const std::exception& error) {
    store(IST_INTERNAL_ERROR, error.what());
  } catch (...) {
    store(IST_INTERNAL_ERROR, "unknown exception: report this bug");
  }
}

}  // namespace ist::capi
