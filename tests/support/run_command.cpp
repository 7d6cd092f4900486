#include "support/run_command.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>

extern char** environ;

namespace ist::test {

Process::Process(const std::string& program, const std::vector<std::string>& arguments,
                 const std::string& terminal) {
  // Files, not pipes: a pipe that nobody reads while the other is read would stop the program.
  const std::string out = dir_.path() / "out", err = dir_.path() / "err";
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  constexpr int kWrite = O_WRONLY | O_CREAT | O_TRUNC;
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), kWrite, 0600);
  if (terminal.empty()) {
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), kWrite, 0600);
  } else {
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, terminal.c_str(),
                                       O_WRONLY | O_NOCTTY, 0);
  }
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  sigset_t signals;
  sigfillset(&signals);
  ::posix_spawnattr_setsigdefault(&attributes, &signals);
  sigemptyset(&signals);
  ::posix_spawnattr_setsigmask(&attributes, &signals);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) {
    argv.push_back(const_cast<char*>(argument.c_str()));
  }
  argv.push_back(nullptr);
  const int failed =
      ::posix_spawn(&id_, program.c_str(), &actions, &attributes, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::posix_spawnattr_destroy(&attributes);
  if (failed != 0) throw std::runtime_error("cannot start " + program);
}

Process::~Process() {
  if (status_) return;
  ::kill(id_, SIGKILL);
  ::waitpid(id_, nullptr, 0);
}

void Process::signal(int signal) const {
  if (!status_) ::kill(id_, signal);
}

bool Process::is_running() {
  int status = 0;
  if (!status_ && ::waitpid(id_, &status, WNOHANG) == id_) status_ = status;
  return !status_;
}

CommandResult Process::wait() {
  int status = 0;
  if (!status_) {
    if (::waitpid(id_, &status, 0) != id_) throw std::runtime_error("lost a process");
    status_ = status;
  }
  return {WIFEXITED(*status_) ? WEXITSTATUS(*status_) : 128 + WTERMSIG(*status_),
          file_content(dir_.path() / "out"), file_content(dir_.path() / "err")};
}

CommandResult run_command(const std::string& program, const std::vector<std::string>& arguments) {
  return Process(program, arguments).wait();
}

}  // namespace ist::test
