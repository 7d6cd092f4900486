// The limits that ist-import sets before it looks at foreign content.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <functional>
#include <string>

#include "import/process_limits.h"
#include "support/temp_dir.h"

namespace ist::import {
namespace {

// Returns whether `holds` is true in a process with the limits.
bool under_limits(const std::function<bool()>& holds) {
  const pid_t child = ::fork();
  if (child == 0) {
    limit_resources(0);
    ::_exit(limit_system_calls() && holds() ? 0 : 1);
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

}  // namespace
}  // namespace ist::import
