#include <algorithm>

#include "ist/capi/ask.h"
#include "ist/capi/handle.h"
#include "ist/capi/objects.h"
#include "ist/capi/sized_struct.h"

namespace ist::capi {
namespace {

static_assert(sizeof(ist_triangle_pair) == sizeof(TrianglePair) &&
              alignof(ist_triangle_pair) == alignof(TrianglePair) &&
              offsetof(ist_triangle_pair, fixed) == offsetof(TrianglePair, fixed) &&
              offsetof(ist_triangle_pair, moving) == offsetof(TrianglePair, moving));

// For a pose that is rigid.
std::int32_t touch_of(Touch touch) {
  switch (touch) {
    case Touch::kNo:
      return IST_TOUCH_NO;
    case Touch::kPossible:
      return IST_TOUCH_POSSIBLE;
    case Touch::kYes:
      return IST_TOUCH_YES;
    case Touch::kInvalidPose:
      break;
  }
  return IST_TOUCH_UNKNOWN;
}

}  // namespace
}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_query_gap(ist_query* query, const double pose[16], double tolerance,
                         ist_gap_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status wrong = clear_sized(call, "result", result)) return wrong;
    if (const ist_status missing = call.need({{"pose", pose}})) return missing;
    if (!(tolerance >= 0)) {
      return call.fail(IST_ARGUMENT_INVALID, "tolerance is {}: give a number of at least 0",
                       tolerance);
    }
    const Held<Query> held(call, "query", query);
    if (held.status() != IST_OK) return held.status();
    const ist::GapResult found = held->query.gap(to_isometry(pose), tolerance);
    if (const ist_status wrong = status_of(call, found.status)) return wrong;
    write_sized({0, found.gap.lower, found.gap.upper, found.sphere_tests}, *result);
    return IST_OK;
  });
}

ist_status ist_query_touches(ist_query* query, const double pose[16], int32_t* touch) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status missing = call.need({{"touch", touch}})) return missing;
    *touch = IST_TOUCH_UNKNOWN;
    if (const ist_status missing = call.need({{"pose", pose}})) return missing;
    const Held<Query> held(call, "query", query);
    if (held.status() != IST_OK) return held.status();
    const ist::Touch found = held->query.touches(to_isometry(pose));
    if (found == ist::Touch::kInvalidPose) {
      return status_of(call, ist::QueryStatus::kInvalidPose);
    }
    *touch = touch_of(found);
    return IST_OK;
  });
}

ist_status ist_query_exact(ist_query* query, const double pose[16], ist_triangle_pair* pairs,
                           size_t capacity, ist_exact_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status wrong = clear_sized(call, "result", result)) return wrong;
    if (const ist_status missing = call.need({{"pose", pose}})) return missing;
    if (const ist_status missing = call.need_array("pairs", pairs, capacity)) return missing;
    const Held<Query> held(call, "query", query);
    if (held.status() != IST_OK) return held.status();
    const ist::ExactResult found = held->query.collide_exact(
        to_isometry(pose), {reinterpret_cast<ist::TrianglePair*>(pairs), capacity});
    if (const ist_status wrong = status_of(call, found.status)) return wrong;
    ist_exact_result values{};
    values.pairs = found.triangle_pairs;
    values.written = std::min<std::uint64_t>(found.triangle_pairs, capacity);
    values.sphere_tests = found.sphere_tests;
    values.truncated = found.truncated;
    write_sized(values, *result);
    return IST_OK;
  });
}
