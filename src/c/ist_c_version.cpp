#include <iterator>

#include "c/guard.h"
#include "c/status.h"
#include "ist/capi/ist_c.h"

namespace {

// The codes that no ErrorCode has, from IST_OK on.
constexpr const char* kNames[] = {"ok",
                                  "null-argument",
                                  "struct-size",
                                  "argument-invalid",
                                  "not-a-handle",
                                  "handle-kind",
                                  "handle-freed",
                                  "handle-busy",
                                  "too-many-handles",
                                  "out-of-memory",
                                  "system-error",
                                  "internal-error",
                                  "not-prepared",
                                  "servo-fault",
                                  "cancelled",
                                  "change-refused"};
static_assert(IST_OK == 0 && std::size(kNames) == IST_CHANGE_REFUSED + 1);

}  // namespace

uint32_t ist_abi_version(void) IST_NOEXCEPT { return IST_ABI_VERSION; }

const char* ist_version_string(void) IST_NOEXCEPT { return IST_VERSION; }

const char* ist_status_name(ist_status status) IST_NOEXCEPT {
  const auto code = ist::capi::error_code_of(status);
  if (code) return ist::to_string(*code);
  return status >= IST_OK && status <= IST_CHANGE_REFUSED ? kNames[status] : "unknown";
}

const char* ist_last_error_message(void) IST_NOEXCEPT { return ist::capi::last_error(); }
