#include "ist/mesh/import/import_run.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>
#include <vector>

#include "ist/base/cancellation.h"
#include "ist/base/throw_error.h"
#include "ist/mesh/import/import_message.h"

namespace ist {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kMostOutput = std::size_t{1} << 30;
constexpr std::size_t kAtOnce = std::size_t{1} << 18;  // bytes, between two cancellation points

[[noreturn]] void fail_to_start(const std::filesystem::path& importer,
                                const std::filesystem::path& file, int reason) {
  throw_error(ErrorCode::kFileUnreadable,
              "{}: ist-import at {} cannot be started: {}; install it again, or {}", file.string(),
              importer.string(), std::strerror(reason), kConvert);
}

// A file descriptor above 2, which a program started here does not inherit. A host may have closed
// its own stdin: a descriptor of that number would be in the way.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {
    if (number < 0 || number > 2) return;
    number_ = ::fcntl(number, F_DUPFD_CLOEXEC, 3);
    ::close(number);
  }
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  void close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

// A running program. The destructor kills it and waits for its end.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  ~Child() {
    if (has_ended()) return;
    ::kill(-id_, SIGKILL);
    while (::waitpid(id_, nullptr, 0) < 0 && errno == EINTR) continue;
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Does not wait. The status stays unknown if the host ignores SIGCHLD or waits for all children.
  bool has_ended() {
    if (ended_) return true;
    const pid_t got = ::waitpid(id_, &status_, WNOHANG);
    known_ = got == id_;
    ended_ = known_ || (got < 0 && errno == ECHILD);
    return ended_;
  }
  void tell(ImportRun& run) const {
    if (!known_) return;
    run.end = WIFSIGNALED(status_) ? ImportRun::End::kSignal : ImportRun::End::kExit;
    run.code = WIFSIGNALED(status_) ? WTERMSIG(status_) : WEXITSTATUS(status_);
  }

 private:
  pid_t id_;
  int status_ = 0;
  bool ended_ = false, known_ = false;
};

// Returns a file in memory that holds the content, at its beginning.
int memory_file(std::string_view content) {
  const int file = ::memfd_create("ist-import", MFD_CLOEXEC);
  for (std::size_t at = 0; file >= 0 && at < content.size();) {
    const ssize_t done = ::write(file, content.data() + at, content.size() - at);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) {
      const int reason = errno;
      ::close(file);
      errno = reason;
      return -1;
    }
    at += static_cast<std::size_t>(done);
  }
  if (file >= 0) ::lseek(file, 0, SEEK_SET);
  return file;
}

// Starts the program with default signals. Returns an error number.
int start(const std::filesystem::path& importer, const std::filesystem::path& file, int content,
          int answer, pid_t& id) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawnattr_init(&attributes);
  ::posix_spawn_file_actions_adddup2(&actions, content, 0);
  ::posix_spawn_file_actions_adddup2(&actions, answer, 1);
  ::posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  ::posix_spawnattr_setsigmask(&attributes, &none);
  ::posix_spawnattr_setsigdefault(&attributes, &all);
  ::posix_spawnattr_setpgroup(&attributes, 0);
  ::posix_spawnattr_setflags(
      &attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  std::string program = importer.string(), name = file.string(), locale = "LC_ALL=C";
  if (name.starts_with('-')) name.insert(0, "./");  // no option
  std::array<char*, 3> arguments = {program.data(), name.data(), nullptr};
  std::array<char*, 2> environment = {locale.data(), nullptr};
  const int reason = ::posix_spawn(&id, program.c_str(), &actions, &attributes, arguments.data(),
                                   environment.data());
  ::posix_spawn_file_actions_destroy(&actions);
  ::posix_spawnattr_destroy(&attributes);
  return reason;
}

// Reads the answer until the program closes the pipe or exceeds a limit.
void take_answer(int pipe, Clock::time_point deadline, ImportRun& run) {
  std::vector<char> buffer(kAtOnce);
  for (;;) {
    cancellation_point();
    if (Clock::now() >= deadline) {
      run.end = ImportRun::End::kTooLate;
      return;
    }
    pollfd ready{pipe, POLLIN, 0};
    if (::poll(&ready, 1, 20) <= 0) continue;
    const ssize_t got = ::read(pipe, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return;
    run.answer.append(buffer.data(), static_cast<std::size_t>(got));
    if (run.answer.size() > kMostOutput) {
      run.end = ImportRun::End::kTooMuch;
      return;
    }
  }
}

}  // namespace

ImportRun run_importer(const std::filesystem::path& importer, std::string_view content,
                       const std::filesystem::path& file, std::chrono::milliseconds time) {
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail_to_start(importer, file, errno);
  const Descriptor from(ends[0]);
  Descriptor to(ends[1]);
  ::fcntl(from.number(), F_SETPIPE_SZ, static_cast<int>(kAtOnce));  // quicker, if it is allowed
  const Descriptor memory(memory_file(content));
  if (from.number() < 0 || to.number() < 0 || memory.number() < 0)
    fail_to_start(importer, file, errno);
  pid_t id = 0;
  if (const int reason = start(importer, file, memory.number(), to.number(), id); reason != 0)
    fail_to_start(importer, file, reason);
  Child child(id);
  to.close();

  ImportRun run;
  const Clock::time_point deadline = Clock::now() + time;
  take_answer(from.number(), deadline, run);
  // Without a complete answer the end of the program tells the cause.
  while (run.end == ImportRun::End::kUnknown && !is_complete_import(run.answer) &&
         !child.has_ended()) {
    cancellation_point();
    if (Clock::now() >= deadline) run.end = ImportRun::End::kTooLate;
    ::poll(nullptr, 0, 1);
  }
  if (run.end == ImportRun::End::kUnknown) child.tell(run);
  return run;
}

}  // namespace ist
