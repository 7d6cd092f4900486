#include "cli/recordings/line_reader.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "ist/base/throw_error.h"

namespace ist::cli {
namespace {

constexpr std::size_t kReadAtOnce = 1 << 16;  // bytes
constexpr int kNapMilliseconds = 50;

}  // namespace

LineReader::LineReader(std::filesystem::path file) : path_(std::move(file)) {
  // With O_NONBLOCK open() and read() do not wait for a pipe's writer: poll() does.
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) fail();
  struct stat status {};
  if (::fstat(descriptor_, &status) == 0) size_ = static_cast<std::uint64_t>(status.st_size);
}

LineReader::~LineReader() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::optional<std::string> LineReader::next(const std::atomic<bool>& stop) {
  std::size_t searched = begin_;
  while (true) {
    const std::size_t end = text_.find('\n', searched);
    if (end != std::string::npos) {
      const std::size_t begin = std::exchange(begin_, end + 1);
      return text_.substr(begin, end - begin);
    }
    text_.erase(0, std::exchange(begin_, 0));
    searched = text_.size();
    if (!read_more(stop)) break;
  }
  if (stop || text_.empty()) return std::nullopt;
  return std::exchange(text_, {});  // the last line has no end
}

// Returns false at the end of the file, or when asked to stop.
bool LineReader::read_more(const std::atomic<bool>& stop) {
  const std::size_t filled = text_.size();
  while (!stop) {
    pollfd ready{descriptor_, POLLIN, 0};
    if (::poll(&ready, 1, kNapMilliseconds) == 0) continue;
    text_.resize(filled + kReadAtOnce);
    const ssize_t got = ::read(descriptor_, text_.data() + filled, kReadAtOnce);
    const int cause = errno;
    text_.resize(filled + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got >= 0) return got > 0;
    if (cause != EAGAIN && cause != EINTR) {
      errno = cause;
      fail();
    }
  }
  return false;
}

void LineReader::fail() const {
  throw_error(ErrorCode::kFileUnreadable,
              "{}: cannot read the file: {}: check the name and its permissions", path_.string(),
              std::strerror(errno));
}

}  // namespace ist::cli
