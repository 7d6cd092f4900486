// The limits that ist-import sets before it looks at foreign content.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <sstream>
#include <string>

#include "import/process_limits.h"
#include "support/temp_dir.h"

namespace ist::import {
namespace {

// Returns whether `holds` is true in a process with the limits.
bool under_limits(const std::function<bool()>& holds) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::_exit(limit_resources(0) && limit_system_calls() && holds() ? 0 : 1);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

// Returns whether a system call failed because it is not allowed.
bool refused(long result) { return result < 0 && errno == EPERM; }

TEST(ImportLimits, FilesAreReadOnly) {
  const test::TempDir folder;
  const std::string old = folder.write("old", "content"), other = (folder.path() / "new").string();
  EXPECT_TRUE(under_limits([&] {
    char byte = 0;
    const int file = ::open(old.c_str(), O_RDONLY);
    return file >= 0 && ::read(file, &byte, 1) == 1 && byte == 'c';
  }));
  EXPECT_TRUE(under_limits([&] { return refused(::open(old.c_str(), O_RDWR)); }));
  EXPECT_TRUE(under_limits([&] { return refused(::open(old.c_str(), O_RDONLY | O_TRUNC)); }));
  EXPECT_TRUE(
      under_limits([&] { return refused(::open(other.c_str(), O_WRONLY | O_CREAT, 0600)); }));
  EXPECT_TRUE(under_limits([&] { return refused(::unlink(old.c_str())); }));
  EXPECT_TRUE(under_limits([&] { return refused(::rename(old.c_str(), other.c_str())); }));
  EXPECT_TRUE(under_limits([&] { return refused(::mkdir(other.c_str(), 0700)); }));
  EXPECT_TRUE(under_limits([&] { return refused(::truncate(old.c_str(), 0)); }));
  EXPECT_EQ(std::filesystem::file_size(old), 7u);
  EXPECT_FALSE(std::filesystem::exists(other));
}

TEST(ImportLimits, NothingElseIsReached) {
  EXPECT_TRUE(under_limits([] { return refused(::socket(AF_INET, SOCK_STREAM, 0)); }));
  EXPECT_TRUE(under_limits([] { return refused(::socket(AF_UNIX, SOCK_STREAM, 0)); }));
  EXPECT_TRUE(under_limits([] { return refused(::kill(::getppid(), 0)); }));
  EXPECT_TRUE(under_limits([] { return refused(::execl("/bin/true", "true", nullptr)); }));
  EXPECT_TRUE(under_limits([] { return refused(::fork()); }));
}

TEST(ImportLimits, MemoryAndFilesOfTheHostAreOut) {
  const int inherited = ::open("/dev/null", O_RDONLY);
  EXPECT_TRUE(under_limits([&] { return ::fcntl(inherited, F_GETFD) < 0 && errno == EBADF; }));
  ::close(inherited);
  if (IST_SANITIZED) return;  // a sanitizer reserves terabytes
  EXPECT_TRUE(under_limits([] {
    return ::mmap(nullptr, std::size_t{5} << 30, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) ==
           MAP_FAILED;
  }));
}

TEST(ImportLimits, ProcessorTimeEndsBySigxcpu) {
  const pid_t child = ::fork();
  if (child == 0) {
    if (!limit_resources(0, 1)) ::_exit(1);
    for (;;) static_cast<void>(::getppid());
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) << status;
}

// The program itself, as it waits for its content.
TEST(ImportLimits, IstImportSetsThemBeforeItReads) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(ends[0], 0);
    ::close(ends[1]);
    ::execl(std::getenv("IST_IMPORT"), "ist-import", "jaw.glb", nullptr);
    ::_exit(9);
  }
  const std::string folder = "/proc/" + std::to_string(child) + "/";
  const auto reads = [&] {  // the number of the system call that it waits in
    return test::file_content(folder + "syscall").starts_with(std::to_string(SYS_read) + " 0x0 ");
  };
  for (int i = 0; i < 2000 && !reads(); ++i) ::usleep(5000);
  const std::string status = test::file_content(folder + "status"),
                    limits = test::file_content(folder + "limits");
  EXPECT_NE(status.find("\nSeccomp:\t2\n"), std::string::npos) << status;
  EXPECT_NE(status.find("\nNoNewPrivs:\t1\n"), std::string::npos) << status;
  const auto has = [&](const char* name, const std::string& soft, const std::string& hard) {
    std::istringstream lines(limits.substr(limits.find(name) + std::strlen(name)));
    std::string a, b;
    lines >> a >> b;
    EXPECT_EQ(a, soft) << name;
    EXPECT_EQ(b, hard) << name;
  };
  has("Max cpu time", "60", "65");
  has("Max core file size", "0", "0");
  has("Max file size", "0", "0");
  if (!IST_SANITIZED) has("Max address space", "4294967296", "4294967296");
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  ::close(ends[0]);
  ::close(ends[1]);
}

}  // namespace
}  // namespace ist::import
