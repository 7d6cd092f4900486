#include "ist/capi/handles/handle.h"

namespace ist::capi {

ist_status fail_by_handle(const Call& call, ist_status status, const char* argument,
                          const char* kind) {
  switch (status) {
    case IST_NULL_ARGUMENT:
      return call.fail(status, "{} is NULL: pass a {}", argument, kind);
    case IST_NOT_A_HANDLE:
      return call.fail(status, "{} is not a handle: pass a {} that this library created", argument,
                       kind);
    case IST_HANDLE_KIND:
      return call.fail(status, "{} is a handle of another kind: pass a {}", argument, kind);
    case IST_HANDLE_FREED:
      return call.fail(status,
                       "{} is a {} that was freed: do not use a handle after its ist_..._free",
                       argument, kind);
    case IST_HANDLE_BUSY:
      return call.fail(status, "another thread is using {}: create a {} for each thread", argument,
                       kind);
    default:
      return call.fail(status,
                       "{} handles are alive, the most possible: free a {} or another object",
                       HandleTable::kSlots, kind);
  }
}

}  // namespace ist::capi
