#include "sweep/start_mark.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "ist/base/files.h"
#include "ist/base/throw_error.h"

namespace ist {
namespace {

// Whether the process that made a mark still lives: it holds a lock. Whoever looks takes a shared
// one, so that two who look at a time do not see each other; NFS gives that to a reader too.
bool is_live(int descriptor) {
  if (::flock(descriptor, LOCK_SH | LOCK_NB) != 0) return errno == EWOULDBLOCK;
  ::flock(descriptor, LOCK_UN);
  return false;
}

// Locks a mark that this process made just now. For a moment somebody may be looking at it. If a
// file system lacks locks, the mark still counts lost starts, and nobody sees shares that overlap.
void lock(int descriptor) {
  while (::flock(descriptor, LOCK_EX) != 0 && errno == EINTR) continue;
}

[[noreturn]] void fail_to_create(const std::filesystem::path& file) {
  throw UnwritableFile(fmt::format("{}: cannot create the file: {}: check the folder, its "
                                   "permissions and the space on the disk",
                                   file.string(), std::strerror(errno)),
                       errno);
}

// Whether a file is still the one with that name.
bool has_name(int descriptor, const std::filesystem::path& name) {
  struct stat opened = {}, named = {};
  return ::fstat(descriptor, &opened) == 0 && ::stat(name.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

}  // namespace

void fail_overlap(const SweepFolder& folder, std::uint64_t part) {
  throw_error(ErrorCode::kPartBusy,
              "{}: another process is making this part now: shares overlap; give each "
              "process a share of its own (--share k/N), or wait for the other one",
              folder.part_file(part).string());
}

PartStarts starts_of(const SweepFolder& folder, std::uint64_t part) {
  PartStarts starts;
  for (int start = 1; start <= SweepFolder::kMostStarts; ++start) {
    const int descriptor =
        ::open(folder.mark_file(part, start).c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) continue;
    if (is_live(descriptor)) {
      starts.live = true;
    } else {
      ++starts.lost;
    }
    ::close(descriptor);
  }
  return starts;
}

StartMark::StartMark(const SweepFolder& folder, std::uint64_t part) {
  for (int start = 1; start <= SweepFolder::kMostStarts; ++start) {
    file_ = folder.mark_file(part, start);
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_EXCL, 0666);
    if (descriptor_ >= 0) {
      // Between its making and its lock a mark looks lost. Who begins meanwhile makes the same
      // bytes, so this costs time alone.
      lock(descriptor_);
      return;
    }
    if (errno != EEXIST) fail_to_create(file_);
  }
  fail_overlap(folder, part);  // somebody was faster
}

StartMark::~StartMark() {
  ::unlink(file_.c_str());
  ::close(descriptor_);
}

MergeMark::MergeMark(const SweepFolder& folder) : file_(folder.path() / "rows.start") {
  while (true) {
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail_to_create(file_);
    const bool is_taken = ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (!is_taken && has_name(descriptor_, file_)) return;
    ::close(descriptor_);
    descriptor_ = -1;
    if (is_taken) return;
    // The holder before removed the file after this process opened it.
  }
}

MergeMark::~MergeMark() {
  if (!is_held()) return;
  ::unlink(file_.c_str());
  ::close(descriptor_);
}

void remove_marks(const SweepFolder& folder, std::uint64_t part) noexcept {
  for (int start = 1; start <= SweepFolder::kMostStarts; ++start) {
    ::unlink(folder.mark_file(part, start).c_str());
  }
}

}  // namespace ist
