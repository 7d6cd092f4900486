#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "ist/base/api.h"
#include "ist/base/error.h"

namespace ist {

/// The first bytes of a tree file, by which the readers of trees and of meshes tell it.
inline constexpr std::array<unsigned char, 8> kTreeFileMagic = {0x89, 'I',  'S',  'T',
                                                                0x0D, 0x0A, 0x1A, 0x0A};

/// Reads a regular file from front to back. Every function throws kFileUnreadable with the file and
/// the cause. Reading has cancellation points (cancellation.h).
class IST_LOOP_API InputFile {
 public:
  explicit InputFile(std::filesystem::path file);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// The size of the file when it was opened, bytes.
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

  /// Reads up to `bytes` bytes, fewer only at the end of the file. Returns the number read.
  std::size_t read(void* data, std::size_t bytes);

  /// Reads exactly `bytes` bytes from `offset` on, whatever was read before; a file that is shorter
  /// by now cannot be read. Any number of threads may call it at a time.
  void read_at(std::uint64_t offset, void* data, std::size_t bytes) const;

  /// Returns when the file was last written, ns since 1970, as the system says.
  [[nodiscard]] std::int64_t written_at() const;

  /// Reads the rest of the file at its current length, which may differ from size().
  [[nodiscard]] std::string read_rest();

 private:
  [[noreturn]] void fail(const char* cause) const;

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// Throws the error of an OutputFile that cannot be created, and creates nothing. Long work checks
/// its output so before it begins: a missing folder, a folder in the file's place, or permissions.
/// A full disk is found only when the file is written.
void require_writable(const std::filesystem::path& file);

/// A kFileUnwritable, with the system's number of the cause (errno): EPIPE of a pipe that nobody
/// reads any more is often no failure of the command that writes to it.
class UnwritableFile : public Error {
 public:
  UnwritableFile(const std::string& detail, int cause)
      : Error(ErrorCode::kFileUnwritable, detail), cause_(cause) {}
  [[nodiscard]] int cause() const noexcept { return cause_; }

 private:
  int cause_;
};

/// Writes a file whole or not at all: under a temporary name in the same folder until commit()
/// renames it. Without commit() the destructor removes the temporary file, and an older file of the
/// same name stays unchanged. A target that is not a regular file, such as /dev/stdout, is written
/// directly.
///
/// Every function throws UnwritableFile with the file and the cause. write() and commit() have
/// cancellation points. An OutputFile belongs to one thread at a time.
class IST_LOOP_API OutputFile {
 public:
  explicit OutputFile(std::filesystem::path target);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Returns the name that the file gets.
  [[nodiscard]] const std::filesystem::path& target() const noexcept { return target_; }
  void write(const void* data, std::size_t bytes);
  /// Overwrites `bytes` bytes from `offset` on, for a header that is known last.
  void write_at(std::size_t offset, const void* data, std::size_t bytes);
  void commit();
  /// Commits files together: all are stored on the disk before the first gets its name, and
  /// neither of the functions below comes between the names. So a disk that is full or fails leaves
  /// all older files. Only a name that cannot be given then, as that of a folder made meanwhile,
  /// leaves a part: the new names before it are removed again, but an older file that was replaced
  /// is lost.
  static void commit_all(std::span<OutputFile* const> files);

 private:
  // Says whether complete_output_files() gives the files their names from now on.
  static void await_names(std::span<OutputFile* const> files, bool await);
  // Brings the content to the disk. Returns what failed, with errno, or nullptr.
  const char* store();

  std::filesystem::path target_, temporary_;  // temporary_ is empty when written directly
  int descriptor_ = -1;
};

/// Removes the temporary files of all OutputFiles, for a process that a signal ends without their
/// destructors. A thread that creates, commits or destroys an OutputFile afterwards blocks for
/// ever. Not for signal handlers, because it takes a lock.
void abandon_output_files() noexcept;

/// Removes the same files, except for those whose commit waits for the disk: they are whole and get
/// their names at once. A power cut or a full network disk may still damage them, and then the
/// older files of those names are lost.
void complete_output_files() noexcept;

}  // namespace ist
