#include "import/process_limits.h"

#include <fcntl.h>
#include <seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace ist::import {
namespace {

// At the limit of processor time the kernel sends SIGXCPU, and after the grace SIGKILL.
bool limit(int resource, rlim_t most, rlim_t grace = 0) {
  const rlimit both{most, most + grace};
  return ::setrlimit(static_cast<__rlimit_resource>(resource), &both) == 0;
}

}  // namespace

bool limit_resources(std::size_t content_bytes, unsigned seconds) {
  bool done = ::prctl(PR_SET_PDEATHSIG, SIGKILL) == 0;
  done &= ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0;
  done &= ::close_range(3, ~0U, 0) == 0;
  // A sanitizer reserves terabytes of addresses.
  if (!IST_SANITIZED) done &= limit(RLIMIT_AS, (rlim_t{4} << 30) + content_bytes);
  done &= limit(RLIMIT_CPU, seconds, 5);
  done &= limit(RLIMIT_CORE, 0);
  // The answer may go to a file, if a person asked for it.
  struct stat output {};
  const bool to_file = ::fstat(STDOUT_FILENO, &output) == 0 && S_ISREG(output.st_mode);
  return done & limit(RLIMIT_FSIZE, to_file ? rlim_t{2} << 30 : 0);
}

bool limit_system_calls() {
  const scmp_filter_ctx filter = ::seccomp_init(SCMP_ACT_ERRNO(EPERM));
  if (filter == nullptr) return false;
  constexpr const char* kAllowed[] = {"read",
                                      "readv",
                                      "pread64",
                                      "write",
                                      "writev",
                                      "close",
                                      "lseek",
                                      "fstat",
                                      "stat",
                                      "lstat",
                                      "newfstatat",
                                      "statx",
                                      "readlink",
                                      "readlinkat",
                                      "access",
                                      "faccessat",
                                      "faccessat2",
                                      "getcwd",
                                      "fcntl",
                                      "mmap",
                                      "munmap",
                                      "mremap",
                                      "mprotect",
                                      "madvise",
                                      "brk",
                                      "futex",
                                      "rt_sigaction",
                                      "rt_sigprocmask",
                                      "rt_sigreturn",
                                      "sigaltstack",
                                      "getpid",
                                      "gettid",
                                      "clock_gettime",
                                      "gettimeofday",
                                      "getrandom",
                                      "sysinfo",
                                      "uname",
                                      "sched_yield",
                                      "sched_getaffinity",
                                      "getrusage",
                                      "exit",
                                      "exit_group"};
  bool done = true;
  for (const char* name : kAllowed) {
    const int call = ::seccomp_syscall_resolve_name(name);  // some exist on other processors alone
    if (call >= 0) done &= ::seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0) == 0;
  }
  // Only for reading, and no file that is not there.
  const scmp_arg_cmp reads{2, SCMP_CMP_MASKED_EQ, O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND,
                           0};
  done &= ::seccomp_rule_add_array(filter, SCMP_ACT_ALLOW, SCMP_SYS(openat), 1, &reads) == 0;
  // A failed assertion ends this process by a signal to itself.
  const scmp_arg_cmp itself{0, SCMP_CMP_EQ, static_cast<scmp_datum_t>(::getpid()), 0};
  done &= ::seccomp_rule_add_array(filter, SCMP_ACT_ALLOW, SCMP_SYS(tgkill), 1, &itself) == 0;
  done = done && ::seccomp_load(filter) == 0;
  ::seccomp_release(filter);
  return done;
}

}  // namespace ist::import
