#include "ist/mesh/file_bytes.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <new>
#include <system_error>

#include "ist/base/error.h"

namespace ist {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

std::string reason(int error) { return std::generic_category().message(error); }

[[noreturn]] void fail_read(const std::filesystem::path& file, const std::string& cause) {
  throw Error(ErrorCode::kFileUnreadable,
              fmt::format("{}: the file cannot be read: {}; check its name and its permissions",
                          file.string(), cause));
}

// A file under a name of its own, which goes away unless it is put in place.
class PartialFile {
 public:
  explicit PartialFile(const std::filesystem::path& target) : target_(target), partial_(target) {
    static std::atomic<unsigned> counter{0};
    partial_ += fmt::format(".partial-{}-{}", ::getpid(), counter++);
    file_.reset(std::fopen(partial_.c_str(), "wbx"));  // x: never someone else's file
    if (!file_) fail(errno);
  }
  ~PartialFile() {
    file_.reset();
    std::error_code ignored;
    if (!in_place_) std::filesystem::remove(partial_, ignored);
  }
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  void write(std::string_view bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) fail(errno);
  }

  void put_in_place() {
    // A full disk may show only when the last of the buffer is written.
    if (std::fclose(file_.release()) != 0) fail(errno);
    std::error_code error;
    std::filesystem::rename(partial_, target_, error);
    if (error) fail(error.value());
    in_place_ = true;
  }

 private:
  // In a constructor the destructor does not run: there is no file yet then.
  [[noreturn]] void fail(int error) const {
    throw Error(ErrorCode::kFileUnwritable,
                fmt::format("{}: the file cannot be written: {}; check the folder, its permissions "
                            "and the space on its disk",
                            target_.string(), reason(error)));
  }

  std::filesystem::path target_;
  std::filesystem::path partial_;
  File file_;
  bool in_place_ = false;
};

}  // namespace

std::string read_file(const std::filesystem::path& file) try {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) fail_read(file, error ? error.message() : reason(ENOENT));
  if (std::filesystem::is_directory(status)) fail_read(file, "it is a folder");
  if (!std::filesystem::is_regular_file(status)) fail_read(file, "it is no regular file");
  const File stream(std::fopen(file.c_str(), "rb"));
  if (!stream) fail_read(file, reason(errno));
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) fail_read(file, error.message());

  // The file may grow or shrink meanwhile: what is read now is what counts.
  std::string bytes;
  std::size_t filled = 0;
  std::size_t ask = size + 1;
  do {
    bytes.resize(filled + ask);
    const std::size_t got = std::fread(bytes.data() + filled, 1, ask, stream.get());
    filled += got;
    if (got < ask) break;
    ask = filled;
  } while (true);
  if (std::ferror(stream.get()) != 0) fail_read(file, reason(errno));
  bytes.resize(filled);
  return bytes;
} catch (const std::bad_alloc&) {
  fail_read(file, "it is larger than the memory");
} catch (const std::length_error&) {
  fail_read(file, "it is larger than the memory");
}

void write_file(const std::filesystem::path& file, std::string_view bytes) {
  PartialFile partial(file);
  partial.write(bytes);
  partial.put_in_place();
}

}  // namespace ist
