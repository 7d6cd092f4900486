#pragma once

namespace ist::test {

/// Whether a sanitizer is in the program. Its own locks call the system if another thread holds
/// them.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
inline constexpr bool kSanitized =
    __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool kSanitized = false;
#endif

/// Whether this kernel lets a process forbid its own system calls.
[[nodiscard]] bool can_forbid_system_calls();

/// From now on the calling thread may make no system call but end_process(): any other kills the
/// process with SIGSYS. For death tests and child processes. Other threads are not touched.
void forbid_system_calls();

/// Ends the process by that system call alone: sanitizers add others to _exit(), and before what
/// is declared not to return.
void end_process(int status);

}  // namespace ist::test
