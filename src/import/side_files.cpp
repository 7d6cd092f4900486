#include "import/side_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <cstring>
#include <memory>
#include <system_error>
#include <utility>

#include "ist/mesh/format/percent.h"

namespace ist::import {
namespace {

constexpr off_t kMostBytes = off_t{1} << 30;

// A file in memory, its own or one that outlives it.
class MemoryStream : public Assimp::IOStream {
 public:
  explicit MemoryStream(const std::string& content) : content_(content) {}
  explicit MemoryStream(std::unique_ptr<std::string> own) : own_(std::move(own)), content_(*own_) {}

  size_t Read(void* to, size_t size, size_t count) override {
    const std::size_t left = content_.size() - at_;
    const std::size_t whole = size == 0 ? 0 : std::min(count, left / size);
    std::memcpy(to, content_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }
  size_t Write(const void*, size_t, size_t) override { return 0; }
  aiReturn Seek(size_t offset, aiOrigin origin) override {
    const std::size_t from = origin == aiOrigin_SET   ? 0
                             : origin == aiOrigin_CUR ? at_
                                                      : content_.size();
    const std::size_t to = from + offset;  // a negative offset wraps, as assimp passes it
    if (to > content_.size()) return aiReturn_FAILURE;
    at_ = to;
    return aiReturn_SUCCESS;
  }
  [[nodiscard]] size_t Tell() const override { return at_; }
  [[nodiscard]] size_t FileSize() const override { return content_.size(); }
  void Flush() override {}

 private:
  std::unique_ptr<std::string> own_;
  const std::string& content_;
  std::size_t at_ = 0;
};

// Returns the content of a regular file, or null.
std::unique_ptr<std::string> content_of(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return nullptr;
  struct stat status {};
  std::unique_ptr<std::string> content;
  if (::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) &&
      status.st_size <= kMostBytes) {
    content = std::make_unique<std::string>(static_cast<std::size_t>(status.st_size), '\0');
    std::size_t at = 0;
    for (ssize_t got = 1; at < content->size() && got > 0; at += static_cast<std::size_t>(got)) {
      got = std::max<ssize_t>(0, ::read(descriptor, content->data() + at, content->size() - at));
    }
    content->resize(at);
  }
  ::close(descriptor);
  return content;
}

}  // namespace

SideFiles::SideFiles(const Input& input, std::string_view extension) : input_(input) {
  std::error_code unknown;
  const std::filesystem::path folder = input.path.parent_path();
  folder_ = std::filesystem::canonical(folder.empty() ? "." : folder, unknown);
  main_ = (folder_ / "(main file).").string() + std::string(extension);
}

// Returns the canonical path of a side file, or an empty one if it is not to be opened. A glTF
// writes names as parts of URIs: a blank is %20.
std::filesystem::path SideFiles::allowed(std::string_view file) const {
  if (folder_.empty()) return {};
  for (const std::string& name : {std::string(file), percent_decoded(file)}) {
    std::error_code missing;
    const auto path = std::filesystem::canonical(folder_ / name, missing);
    if (missing) continue;
    const auto [end, rest] =
        std::mismatch(folder_.begin(), folder_.end(), path.begin(), path.end());
    if (end == folder_.end() && std::filesystem::is_regular_file(path, missing)) return path;
  }
  return {};
}

bool SideFiles::Exists(const char* file) const { return file == main_ || !allowed(file).empty(); }

Assimp::IOStream* SideFiles::Open(const char* file, const char* mode) {
  if (std::string_view(mode).find_first_of("wa+") != std::string_view::npos) return nullptr;
  if (file == main_) return new MemoryStream(input_.content);
  const std::filesystem::path path = allowed(file);
  auto content = path.empty() ? nullptr : content_of(path);
  if (content == nullptr) {
    missing_ = std::filesystem::path(file).lexically_proximate(folder_).string();
    return nullptr;
  }
  return new MemoryStream(std::move(content));
}

void SideFiles::Close(Assimp::IOStream* stream) { delete stream; }

}  // namespace ist::import
