#include "sweep/start_mark.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
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

// Locks a mark that this process made just now: for a moment somebody may be looking at it. Where a
// file system has no locks, the mark counts lost starts all the same, and shares that overlap are
// not seen.
void lock(int descriptor) {
  while (::flock(descriptor, LOCK_EX) != 0 && errno == EINTR) continue;
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
    if (errno != EEXIST) {
      throw UnwritableFile(fmt::format("{}: cannot create the file: {}: check the folder, its "
                                       "permissions and the space on the disk",
                                       file_.string(), std::strerror(errno)),
                           errno);
    }
  }
  fail_overlap(folder, part);  // somebody was faster
}

StartMark::~StartMark() {
  ::unlink(file_.c_str());
  ::close(descriptor_);
}

void remove_marks(const SweepFolder& folder, std::uint64_t part) noexcept {
  for (int start = 1; start <= SweepFolder::kMostStarts; ++start) {
    ::unlink(folder.mark_file(part, start).c_str());
  }
}

}  // namespace ist
