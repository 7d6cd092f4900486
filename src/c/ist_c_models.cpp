#include <memory>

#include "c/objects.h"
#include "ist/base/float_environment.h"
#include "ist/capi/ist_models.h"
#include "ist/models/models.h"

using namespace ist::capi;

ist_status ist_jaw_create(int32_t jaw, uint64_t seed, ist_mesh** mesh) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.clear("mesh", mesh);
    if (jaw != IST_JAW_LOWER && jaw != IST_JAW_UPPER) {
      call.fail(IST_ARGUMENT_INVALID, "jaw is {}: pass IST_JAW_LOWER or IST_JAW_UPPER", jaw);
    }
    if (call.status() != IST_OK) return;
    const ist::Jaw made = jaw == IST_JAW_UPPER ? ist::Jaw::kUpper : ist::Jaw::kLower;
    give(call, std::make_unique<Mesh>(ist::make_jaw(made, seed)), mesh);
  });
}
