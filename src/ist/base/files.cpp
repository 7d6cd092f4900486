#include "ist/base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <mutex>
#include <system_error>
#include <utility>
#include <vector>

#include "ist/base/cancellation.h"
#include "ist/base/throw_error.h"

namespace ist {
namespace {

// The most bytes read or written between two cancellation points.
constexpr std::size_t kAtOnce = 4 << 20;

// All temporary files of the process. A file is created and removed only under the lock, so the
// list is complete for whoever holds the lock.
struct Temporaries {
  std::mutex mutex;
  // By the file's own path, the path that it still waits to get: empty until all is written.
  std::map<std::filesystem::path, std::filesystem::path> targets;

  // Never destroyed: a thread may still write while the process ends.
  static Temporaries& all() {
    static auto& temporaries = *new Temporaries;
    return temporaries;
  }
};

[[noreturn]] void fail_output(const std::filesystem::path& file, const char* doing, int cause) {
  throw UnwritableFile(
      fmt::format("{}: cannot {} the file: {}: check the folder, its permissions and the "
                  "space on the disk",
                  file.string(), doing, std::strerror(cause)),
      cause);
}

// Whether the file is there and no regular one, such as /dev/stdout. Such files are written
// directly.
bool is_special(const std::filesystem::path& file) {
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

// The file that a link leads to. Writing to a link must not replace the link.
std::filesystem::path without_link(const std::filesystem::path& file) {
  std::error_code unknown;
  auto real = std::filesystem::canonical(file, unknown);
  return unknown ? file : real;
}

}  // namespace

InputFile::InputFile(std::filesystem::path file) : path_(std::move(file)) {
  // With O_NONBLOCK a pipe without a writer does not block open(); the pipe is refused below.
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) fail(std::strerror(errno));
  struct stat status {};
  const bool known = ::fstat(descriptor_, &status) == 0;
  if (!known || !S_ISREG(status.st_mode)) {
    ::close(std::exchange(descriptor_, -1));
    fail(known ? (S_ISDIR(status.st_mode) ? "it is a folder" : "it is not a regular file")
               : std::strerror(errno));
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::size_t InputFile::read(void* data, std::size_t bytes) {
  char* next = static_cast<char*>(data);
  std::size_t left = bytes;
  while (left > 0) {
    cancellation_point();
    const ssize_t got = ::read(descriptor_, next, std::min(left, kAtOnce));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(std::strerror(errno));
    if (got == 0) break;
    next += got;
    left -= static_cast<std::size_t>(got);
  }
  return bytes - left;
}

void InputFile::read_at(std::uint64_t offset, void* data, std::size_t bytes) const {
  char* next = static_cast<char*>(data);
  auto at = static_cast<off_t>(offset);
  while (bytes > 0) {
    cancellation_point();
    const ssize_t got = ::pread(descriptor_, next, std::min(bytes, kAtOnce), at);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(std::strerror(errno));
    if (got == 0) fail("it ends too early");
    next += got;
    at += got;
    bytes -= static_cast<std::size_t>(got);
  }
}

std::int64_t InputFile::written_at() const {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) fail(std::strerror(errno));
  return status.st_mtim.tv_sec * std::int64_t{1'000'000'000} + status.st_mtim.tv_nsec;
}

std::string InputFile::read_rest() {
  std::string bytes;
  std::size_t filled = 0, ask = size_ + 1;
  while (true) {
    bytes.resize(filled + ask);
    const std::size_t got = read(bytes.data() + filled, ask);
    filled += got;
    if (got < ask) break;
    ask = filled;
  }
  bytes.resize(filled);
  return bytes;
}

void InputFile::fail(const char* cause) const {
  throw_error(ErrorCode::kFileUnreadable,
              "{}: cannot read the file: {}: check the name and its permissions", path_.string(),
              cause);
}

void require_writable(const std::filesystem::path& file) {
  std::error_code unknown;
  if (std::filesystem::is_directory(file, unknown)) fail_output(file, "create", EISDIR);
  const bool special = is_special(file);
  // The dot refuses a file in the folder's place.
  const std::filesystem::path written = special ? file : without_link(file).parent_path() / ".";
  const int way = special ? W_OK : W_OK | X_OK;
  if (::access(written.c_str(), way) != 0) fail_output(file, "create", errno);
}

OutputFile::OutputFile(std::filesystem::path target) : target_(std::move(target)) {
  if (is_special(target_)) {
    descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    target_ = without_link(target_);
    auto& [mutex, targets] = Temporaries::all();
    const std::lock_guard lock(mutex);
    for (int attempt = 0; attempt < 100 && descriptor_ < 0; ++attempt) {
      temporary_ = target_;
      temporary_ += fmt::format(".{}-{}.tmp", ::getpid(), attempt);
      const auto [listed, is_new] = targets.try_emplace(temporary_);
      if (!is_new) continue;
      descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (descriptor_ >= 0) break;
      const int cause = errno;
      targets.erase(listed);
      errno = cause;
      if (cause != EEXIST) break;
    }
  }
  if (descriptor_ < 0) {
    const int cause = errno;
    temporary_.clear();
    fail_output(target_, "create", cause);
  }
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (temporary_.empty()) return;
  auto& [mutex, targets] = Temporaries::all();
  const std::lock_guard lock(mutex);
  ::unlink(temporary_.c_str());
  targets.erase(temporary_);
}

void OutputFile::write(const void* data, std::size_t bytes) {
  const char* next = static_cast<const char*>(data);
  while (bytes > 0) {
    cancellation_point();
    const ssize_t written = ::write(descriptor_, next, std::min(bytes, kAtOnce));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_output(target_, "write", errno);
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
    if (written < 0) fail_output(target_, "write", errno);
    next += written;
    at += written;
    bytes -= static_cast<std::size_t>(written);
  }
}

void OutputFile::commit() {
  cancellation_point();
  OutputFile* const alone = this;
  commit_all({&alone, 1});
}

void OutputFile::commit_all(std::span<OutputFile* const> files) {
  await_names(files, true);
  for (OutputFile* file : files) {
    const char* const failed = file->store();
    if (failed == nullptr) continue;
    const int cause = errno;
    await_names(files, false);
    fail_output(file->target_, failed, cause);
  }
  auto& [mutex, targets] = Temporaries::all();
  const std::lock_guard lock(mutex);
  std::vector<const OutputFile*> added;  // renamed where no older file was
  added.reserve(files.size());
  for (const OutputFile* file : files) {
    if (file->temporary_.empty()) continue;
    const bool replaces = ::access(file->target_.c_str(), F_OK) == 0;
    if (::rename(file->temporary_.c_str(), file->target_.c_str()) != 0) {
      const int cause = errno;
      for (const OutputFile* other : added) ::unlink(other->target_.c_str());
      for (const OutputFile* other : files) {
        if (!other->temporary_.empty()) targets[other->temporary_].clear();
      }
      fail_output(file->target_, "rename", cause);
    }
    if (!replaces) added.push_back(file);
  }
  for (OutputFile* file : files) {
    targets.erase(file->temporary_);
    file->temporary_.clear();
  }
}

void OutputFile::await_names(std::span<OutputFile* const> files, bool await) {
  auto& [mutex, targets] = Temporaries::all();
  const std::lock_guard lock(mutex);
  for (const OutputFile* file : files) {
    if (file->temporary_.empty()) continue;
    targets[file->temporary_] = await ? file->target_ : std::filesystem::path();
  }
}

const char* OutputFile::store() {
  // fsync reports a full disk before an older file is replaced.
  if (!temporary_.empty() && ::fsync(descriptor_) != 0) return "write";
  return ::close(std::exchange(descriptor_, -1)) == 0 ? nullptr : "close";
}

void abandon_output_files() noexcept {
  auto& [mutex, targets] = Temporaries::all();
  mutex.lock();  // never unlocked: the process is ending
  for (const auto& [path, target] : targets) ::unlink(path.c_str());
}

void complete_output_files() noexcept {
  auto& [mutex, targets] = Temporaries::all();
  mutex.lock();  // never unlocked: the process is ending
  for (const auto& [path, target] : targets) {
    if (target.empty() || ::rename(path.c_str(), target.c_str()) != 0) ::unlink(path.c_str());
  }
}

}  // namespace ist
