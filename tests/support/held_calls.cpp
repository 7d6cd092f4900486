// Preloaded into a command under test. The test and the command tell each other by files in the
// folder IST_SIGNS how far they are, so that no test waits for a time.
//
// IST_HOLD names a call of the command. The first IST_HOLD_AFTER calls of it return as usual.
// IST_HOLD_HOW says what the later ones do:
//   stand  make the file `held`, and return when the file `go` is there: a disk, a clock or a
//          terminal that stands still
//   tell   make the file `held`, and return as usual
//   fail   fail by EIO; rename() fails by ENOSPC, as in a folder that has to grow on a full disk
//
// The thread that waits for signals has a clock of its own: the size of the file `clock`, in
// milliseconds. The file `heard` grows by one byte each time this thread begins to wait for a
// signal. The file `waits` is there when the thread waits for other threads.

#undef _FORTIFY_SOURCE  // it would define some of these functions itself

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

namespace {

constinit thread_local bool waits_for_signals = false, has_drawn = false;

const char* variable(const char* name) {
  const char* const value = std::getenv(name);
  if (value == nullptr) std::abort();
  return value;
}

std::string sign(const char* name) { return std::string(variable("IST_SIGNS")) + '/' + name; }

// Opens a file past open(), which may be held itself.
int open_file(const char* file, int flags, mode_t mode) {
  return static_cast<int>(::syscall(SYS_openat, AT_FDCWD, file, flags, mode));
}

// Makes a file one byte longer.
void extend(const char* name) {
  const int file = open_file(sign(name).c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (::write(file, "+", 1) != 1) std::abort();
  ::close(file);
}

// Counts a call, and holds it if it is the one to hold. Returns whether it shall fail.
bool fails(std::string_view call) {
  static std::atomic<long> calls{0};
  const std::string_view how = variable("IST_HOLD_HOW");
  if (call != variable("IST_HOLD")) return false;
  if (++calls <= std::atol(variable("IST_HOLD_AFTER"))) return false;
  if (how == "fail") return true;
  extend("held");
  while (how == "stand" && ::access(sign("go").c_str(), F_OK) != 0) ::usleep(1000);
  return false;
}

int fail_by(int cause) {
  errno = cause;
  return -1;
}

// Returns the function that the command would have called.
template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

timespec own_time() {
  struct stat clock {};
  ::stat(sign("clock").c_str(), &clock);
  return {clock.st_size / 1000, clock.st_size % 1000 * 1'000'000};
}

}  // namespace

extern "C" int fsync(int descriptor) {
  if (fails("fsync")) return fail_by(EIO);
  return static_cast<int>(::syscall(SYS_fsync, descriptor));
}

extern "C" int flock(int descriptor, int operation) noexcept {
  if (fails("flock")) return fail_by(EIO);
  return static_cast<int>(::syscall(SYS_flock, descriptor, operation));
}

extern "C" int rename(const char* from, const char* to) noexcept {
  if (fails("rename")) return fail_by(ENOSPC);
  return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

// Counts pipes that are opened for writing, and no other files.
extern "C" int open(const char* file, int flags, ...) {
  mode_t mode = 0;
  if ((flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE) {
    va_list more;
    va_start(more, flags);
    mode = va_arg(more, mode_t);
    va_end(more);
  }
  struct stat status {};
  const bool is_pipe =
      (flags & O_ACCMODE) == O_WRONLY && ::stat(file, &status) == 0 && S_ISFIFO(status.st_mode);
  if (is_pipe && fails("open")) return fail_by(EIO);
  return open_file(file, flags, mode);
}

// Counts what is written to stderr, as a progress bar is.
extern "C" int fputs(const char* text, FILE* stream) {
  static const auto real = next<int(const char*, FILE*)>("fputs");
  if (stream == stderr && fails("fputs")) {
    errno = EIO;
    return EOF;
  }
  has_drawn = has_drawn || stream == stderr;
  return real(text, stream);
}

extern "C" int clock_nanosleep(clockid_t clock, int flags, const timespec* request,
                               timespec* remain) {
  if (fails("clock_nanosleep")) return EIO;
  // The call returns the error, and ::syscall() puts it into errno.
  const bool slept = ::syscall(SYS_clock_nanosleep, clock, flags, request, remain) == 0;
  return slept ? 0 : errno;
}

extern "C" int sigwait(const sigset_t* signals, int* signal) {
  waits_for_signals = true;
  extend("heard");
  while ((*signal = ::sigwaitinfo(signals, nullptr)) < 0) {
    if (errno != EINTR) return errno;
  }
  return 0;
}

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  if (waits_for_signals) {
    *time = own_time();
    return 0;
  }
  return static_cast<int>(::syscall(SYS_clock_gettime, clock, time));
}

// Counts the waits of a thread that has drawn a progress bar.
extern "C" int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                                      clockid_t clock, const timespec* end) {
  static const auto real = next<int(pthread_cond_t*, pthread_mutex_t*, clockid_t, const timespec*)>(
      "pthread_cond_clockwait");
  if (has_drawn && fails("pthread_cond_clockwait")) return EIO;
  if (!waits_for_signals) return real(condition, mutex, clock, end);
  extend("waits");
  const timespec now = own_time();
  if (now.tv_sec > end->tv_sec || (now.tv_sec == end->tv_sec && now.tv_nsec >= end->tv_nsec)) {
    return ETIMEDOUT;
  }
  // It looks at its clock again soon. Callers expect that a wait ends without a cause.
  timespec soon;
  ::syscall(SYS_clock_gettime, CLOCK_MONOTONIC, &soon);
  soon.tv_nsec += 1'000'000;
  if (soon.tv_nsec >= 1'000'000'000) {
    ++soon.tv_sec;
    soon.tv_nsec -= 1'000'000'000;
  }
  real(condition, mutex, CLOCK_MONOTONIC, &soon);
  return 0;
}
