#include "ist/base/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "ist/base/error.h"

namespace ist {

InputFile::InputFile(std::filesystem::path file) : path_(std::move(file)) {
  // Not to block on a pipe that nobody writes to: it is refused below.
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) fail(std::strerror(errno));
  struct stat status {};
  const bool known = ::fstat(descriptor_, &status) == 0;
  if (!known || !S_ISREG(status.st_mode)) {
    ::close(std::exchange(descriptor_, -1));
    fail(known ? (S_ISDIR(status.st_mode) ? "it is a folder" : "it is no regular file")
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
    const ssize_t got = ::read(descriptor_, next, left);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(std::strerror(errno));
    if (got == 0) break;
    next += got;
    left -= static_cast<std::size_t>(got);
  }
  return bytes - left;
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
  throw Error(ErrorCode::kFileUnreadable,
              fmt::format("{}: cannot read the file: {}: check the name and its permissions",
                          path_.string(), cause));
}

}  // namespace ist
