#include <algorithm>

#include "c/objects.h"
#include "ist/capi/ist_measure.h"
#include "ist/measure/escape.h"

namespace ist::capi {
namespace {

std::int32_t escape_code(Escape::Status status) {
  switch (status) {
    case Escape::Status::kFound:
      return IST_ESCAPE_FOUND;
    case Escape::Status::kNotNeeded:
      return IST_ESCAPE_NOT_NEEDED;
    case Escape::Status::kNotFound:
      return IST_ESCAPE_NOT_FOUND;
    default:
      return IST_ESCAPE_UNKNOWN;
  }
}

ist_escape escape_of(const Escape& found) {
  ist_escape out{};
  std::copy_n(found.motion().matrix().data(), 16, out.motion);
  std::copy_n(found.pose().matrix().data(), 16, out.pose);
  out.lower = found.lower;
  out.upper = found.upper;
  out.rotation_error = found.rotation_error;
  out.verdicts = found.verdicts;
  out.status = escape_code(found.status);
  return out;
}

}  // namespace
}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_query_escape(ist_query* query, const double pose[16], double tolerance,
                            double longest, const ist_progress* progress,
                            ist_escape* result) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "result", result);
    call.need("pose", pose);
    const Follower follower = read_follower(call, progress);
    const Held<QueryObject> held(call, "query", query);
    if (!held) return;
    ist::EscapeOptions options{tolerance, longest, {}};
    ist::Escape found;
    const bool whole = followed(follower, [&](const ist::Proceed& proceed) {
      options.proceed = proceed;
      found = ist::escape(held->query, to_isometry(pose), options);
    });
    if (!whole) return cancelled(call);
    const bool invalid = found.status == ist::Escape::Status::kInvalidPose;
    if (invalid && !answered(call, ist::QueryStatus::kInvalidPose, pose)) return;
    write_sized(escape_of(found), *result);
  });
}
