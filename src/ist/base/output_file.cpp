#include "ist/base/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <mutex>
#include <set>
#include <system_error>
#include <utility>

#include "ist/base/error.h"

namespace ist {
namespace {

// The temporary files that there are. Each comes and goes on disk while its owner holds the lock,
// so that whoever holds it knows them all.
struct Temporaries {
  std::mutex mutex;
  std::set<std::filesystem::path> paths;

  // Never destroyed: a thread may still write while the process ends.
  static Temporaries& all() {
    static auto& temporaries = *new Temporaries;
    return temporaries;
  }
};

}  // namespace

OutputFile::OutputFile(std::filesystem::path target) : target_(std::move(target)) {
  std::error_code ignored;
  const auto status = std::filesystem::status(target_, ignored);
  const bool direct = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
  if (direct) {
    descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    // Writing to a link must not replace the link.
    const auto real = std::filesystem::canonical(target_, ignored);
    if (!ignored) target_ = real;
    auto& [mutex, paths] = Temporaries::all();
    const std::lock_guard lock(mutex);
    for (int attempt = 0; attempt < 100 && descriptor_ < 0; ++attempt) {
      temporary_ = target_;
      temporary_ += fmt::format(".{}-{}.tmp", ::getpid(), attempt);
      const auto [listed, is_new] = paths.insert(temporary_);
      if (!is_new) continue;
      descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (descriptor_ >= 0) break;
      const int cause = errno;
      paths.erase(listed);
      errno = cause;
      if (cause != EEXIST) break;
    }
  }
  if (descriptor_ < 0) {
    temporary_.clear();
    fail("create");
  }
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (temporary_.empty()) return;
  auto& [mutex, paths] = Temporaries::all();
  const std::lock_guard lock(mutex);
  ::unlink(temporary_.c_str());
  paths.erase(temporary_);
}

void OutputFile::write(const void* data, std::size_t bytes) {
  const char* next = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written = ::write(descriptor_, next, bytes);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("write");
    next += written;
    bytes -= static_cast<std::size_t>(written);
  }
}

void OutputFile::write_at(std::size_t offset, const void* data, std::size_t bytes) {
  const char* next = static_cast<const char*>(data);
  auto at = static_cast<off_t>(offset);
  while (bytes > 0) {
    const ssize_t written = ::pwrite(descriptor_, next, bytes, at);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("write");
    next += written;
    at += written;
    bytes -= static_cast<std::size_t>(written);
  }
}

void OutputFile::commit() {
  // What a full disk swallowed shows here at the latest, before an older file is replaced.
  if (!temporary_.empty() && ::fsync(descriptor_) != 0) fail("write");
  const int closed = ::close(std::exchange(descriptor_, -1));
  if (closed != 0) fail("close");
  if (temporary_.empty()) return;
  auto& [mutex, paths] = Temporaries::all();
  const std::lock_guard lock(mutex);
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("rename");
  paths.erase(temporary_);
  temporary_.clear();
}

void OutputFile::fail(const char* doing) const {
  throw Error(ErrorCode::kFileUnwritable,
              fmt::format("{}: cannot {} the file: {}: check the folder, its permissions and the "
                          "space on the disk",
                          target_.string(), doing, std::strerror(errno)));
}

void abandon_output_files() noexcept {
  auto& [mutex, paths] = Temporaries::all();
  mutex.lock();  // and never unlocked: nothing is to follow
  for (const std::filesystem::path& path : paths) ::unlink(path.c_str());
}

}  // namespace ist
