#include "ist/capi/ist.h"
#include "ist/capi/last_error.h"
#include "ist/capi/status.h"

namespace {

const char* name_of(ist_status status) noexcept {
  switch (status) {
    case IST_OK:
      return "ok";
    case IST_NULL_ARGUMENT:
      return "null-argument";
    case IST_STRUCT_SIZE:
      return "struct-size";
    case IST_ARGUMENT_INVALID:
      return "argument-invalid";
    case IST_NOT_A_HANDLE:
      return "not-a-handle";
    case IST_HANDLE_KIND:
      return "handle-kind";
    case IST_HANDLE_FREED:
      return "handle-freed";
    case IST_HANDLE_BUSY:
      return "handle-busy";
    case IST_TOO_MANY_HANDLES:
      return "too-many-handles";
    case IST_OUT_OF_MEMORY:
      return "out-of-memory";
    case IST_SYSTEM_ERROR:
      return "system-error";
    case IST_INTERNAL_ERROR:
      return "internal-error";
    case IST_NOT_PREPARED:
      return "not-prepared";
    case IST_SERVO_FAULT:
      return "servo-fault";
    default:
      return "unknown";
  }
}

}  // namespace

uint32_t ist_abi_version(void) IST_NOEXCEPT { return IST_ABI_VERSION; }

const char* ist_version_string(void) IST_NOEXCEPT { return IST_VERSION; }

const char* ist_status_name(ist_status status) IST_NOEXCEPT {
  const auto code = ist::capi::error_code_of(status);
  return code ? ist::to_string(*code) : name_of(status);
}

const char* ist_last_error_message(void) IST_NOEXCEPT { return ist::capi::last_error(); }
