#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>

#include "c/guard.h"
#include "ist/base/api.h"
#include "ist/base/progress.h"

namespace ist::capi {

/// A caller's function that follows a call; empty: nobody does.
using Follower = std::optional<ist_progress>;

/// Converts a caller's progress. NULL, and one without a function, leave nobody.
[[nodiscard]] IST_LOOP_API Follower read_follower(Call& call, const ist_progress* given);

/// Returns the time between two reports, 20 ms. Tests shorten it, so that short calls report too.
std::atomic<std::chrono::microseconds>& time_between_reports() noexcept;

/// Runs `work` to its end. The follower's function is called first and every 20 ms meanwhile on the
/// calling thread, and `work` then runs on a thread of its own; from the first answer other than 0
/// on its `proceed` says no, and it ends at its next cancellation point. Another exception of
/// `work` reaches the caller.
///
/// Returns whether the follower let it come to its end.
IST_LOOP_API bool followed(const Follower& follower,
                           const std::function<void(const Proceed& proceed)>& work);

/// Runs a build of so many stages, as followed() does.
IST_LOOP_API bool followed(const Follower& follower, Progress& progress, unsigned stages,
                           const std::function<void()>& work);

/// Stores the message of a call that its follower ended.
IST_LOOP_API void cancelled(Call& call);

}  // namespace ist::capi
