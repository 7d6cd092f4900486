#pragma once

namespace ist::test {

/// From now on the calling thread may make no system call but end_process(): any other kills the
/// process with SIGSYS. For death tests. Other threads are not touched.
void forbid_system_calls();

/// Ends the process by that system call alone: sanitizers add others to _exit(), and before what
/// is declared not to return.
void end_process(int status);

}  // namespace ist::test
