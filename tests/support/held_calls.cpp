// Preloaded into a command under test, so that system calls of it do not return: a disk or a clock
// that stands still. IST_HOLD names the call, IST_HOLD_AFTER says how many of them return before,
// and IST_HOLD_SIGN names a file that then appears. With IST_HOLD_FAILS they fail instead, by EIO,
// and rename() by ENOSPC, as where a folder has to grow on a full disk.

#include <fcntl.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <string_view>

namespace {

// Returns whether the call shall fail.
bool hold(std::string_view call) {
  static std::atomic<long> calls{0};
  const char *held = std::getenv("IST_HOLD"), *after = std::getenv("IST_HOLD_AFTER"),
             *sign = std::getenv("IST_HOLD_SIGN"), *fails = std::getenv("IST_HOLD_FAILS");
  if (held == nullptr || after == nullptr || sign == nullptr || fails == nullptr) std::abort();
  if (call != held || ++calls <= std::atol(after)) return false;
  if (*fails != '\0') return true;
  ::close(::open(sign, O_WRONLY | O_CREAT | O_CLOEXEC, 0600));
  while (true) ::pause();
}

}  // namespace

extern "C" int fsync(int descriptor) {
  if (hold("fsync")) {
    errno = EIO;
    return -1;
  }
  return static_cast<int>(::syscall(SYS_fsync, descriptor));
}

extern "C" int rename(const char* from, const char* to) noexcept {
  if (hold("rename")) {
    errno = ENOSPC;
    return -1;
  }
  return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

extern "C" int clock_nanosleep(clockid_t clock, int flags, const timespec* request,
                               timespec* remain) {
  if (hold("clock_nanosleep")) return EIO;
  // The call returns the error, and ::syscall() puts it into errno.
  const bool slept = ::syscall(SYS_clock_nanosleep, clock, flags, request, remain) == 0;
  return slept ? 0 : errno;
}
