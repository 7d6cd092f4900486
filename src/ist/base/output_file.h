#pragma once

#include <cstddef>
#include <filesystem>

namespace ist {

/// A file that is there whole or not at all: written under a temporary name in the same folder, and
/// renamed by commit(). Where that never comes, the temporary file is removed and an older file of
/// the same name stays as it was. A target that is no regular file, such as /dev/stdout, is written
/// directly.
///
/// Every function throws kFileUnwritable, naming the file and the cause. One file belongs to one
/// thread at a time.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path target);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(const void* data, std::size_t bytes);
  /// Overwrites from `offset`; for headers that are known last.
  void write_at(std::size_t offset, const void* data, std::size_t bytes);
  void commit();

 private:
  [[noreturn]] void fail(const char* doing) const;

  std::filesystem::path target_, temporary_;  // temporary_ is empty when written directly
  int descriptor_ = -1;
};

/// Removes the temporary files of all OutputFiles, for a process that ends without their
/// destructors, by a signal: a thread that tries to make, commit or destroy one waits from then on
/// for ever. Not for signal handlers: it takes a lock.
void abandon_output_files() noexcept;

}  // namespace ist
