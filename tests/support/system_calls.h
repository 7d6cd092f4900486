#pragma once

namespace ist::test {

/// Whether this kernel lets a process forbid its own system calls.
[[nodiscard]] bool can_forbid_system_calls();

/// From now on the calling thread may make no system call but end_process(): any other kills the
/// process with SIGSYS. For death tests and child processes. Other threads are not touched.
void forbid_system_calls();

/// Ends the process by that system call alone: sanitizers add others to _exit(), and before what
/// is declared not to return.
void end_process(int status);

}  // namespace ist::test
