#include "ist/capi/handle.h"

namespace ist::capi {

ist_status fail_by_handle(const Call& call, ist_status status, const char* argument,
                          const char* kind) {
  switch (status) {
    case IST_NULL_ARGUMENT:
      return call.fail(status, "{} is NULL, and must not be", argument);
    case IST_NOT_A_HANDLE:
      return call.fail(status, "{} is no handle: pass one that this library gave", argument);
    case IST_HANDLE_KIND:
      return call.fail(status, "{} is a handle, but of no {}", argument, kind);
    case IST_HANDLE_FREED:
      return call.fail(status, "{} is a {} that was freed", argument, kind);
    case IST_HANDLE_BUSY:
      return call.fail(status, "{} is in a call of another thread: make a {} for each thread",
                       argument, kind);
    default:
      return call.fail(status, "no more than {} handles live at a time: free a {} or another one",
                       HandleTable::kSlots, kind);
  }
}

}  // namespace ist::capi
