#include "ist/capi/guard.h"

#include <exception>
#include <new>
#include <stdexcept>
#include <system_error>

#include "ist/base/error.h"
#include "ist/capi/status.h"

namespace ist::capi {

ist_status Call::fail_by_exception() const noexcept {
  const auto fail_as = [this](ist_status status, const char* text) {
    set_last_error(function_, text);
    return status;
  };
  constexpr const char* kNoMemory = "not enough memory: ask for less, or free what is not needed";
  try {
    throw;
  } catch (const Error& error) {
    return fail_as(status_of(error.code()), error.what());
  } catch (const std::bad_alloc&) {
    return fail_as(IST_OUT_OF_MEMORY, kNoMemory);
  } catch (const std::length_error&) {  // of a vector that no memory could hold
    return fail_as(IST_OUT_OF_MEMORY, kNoMemory);
  } catch (const std::system_error& error) {
    return fail_as(IST_SYSTEM_ERROR, error.what());
  } catch (const std::exception& error) {
    return fail_as(IST_INTERNAL_ERROR, error.what());
  } catch (...) {
    return fail_as(IST_INTERNAL_ERROR, "an exception that is none of the standard's");
  }
}

}  // namespace ist::capi
