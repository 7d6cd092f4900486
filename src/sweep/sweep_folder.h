#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

#include "sweep/row_layout.h"

namespace ist {

/// Distinguishes the rows of one sweep from those of another.
struct SweepIdentity {
  std::string hash;  ///< 32 hexadecimal digits: of trees, poses and questions
  std::uint64_t rows = 0, rows_per_part = 1;

  [[nodiscard]] std::uint64_t parts() const noexcept {
    return rows / rows_per_part + (rows % rows_per_part != 0);
  }
  [[nodiscard]] std::uint64_t rows_of(std::uint64_t part) const noexcept {
    const std::uint64_t first = part * rows_per_part;
    return rows - first < rows_per_part ? rows - first : rows_per_part;
  }
};

enum class PartState { kMissing, kDone, kGivenUp, kDamaged };

/// How a part stands in its folder.
struct PartStatus {
  PartState state = PartState::kMissing;
  int starts = 0;        ///< begun and not ended, by processes that died or still run
  bool running = false;  ///< somebody is making it now
  double seconds = std::numeric_limits<double>::quiet_NaN();  ///< that making it took; NaN: unknown
  std::string checksum;  ///< XXH3-128 of its file; empty where it is not there
};

/// The folder of a sweep. It holds
///
///     sweep.json             the sweep's hash, the version that makes it, rows and columns
///     part-000017.npy        the rows of a part: there and whole, or not there
///     part-000017.json       its checksum, and the seconds that it took
///     part-000017.start-1    somebody began the part and has not ended it
///     rows.npy               all rows, after a merge
///     manifest.json          what sweep.json holds, and the checksums of all parts
///
/// No file holds a path. Any number of processes on any machines may work in one folder at a time.
class SweepFolder {
 public:
  /// A part that was begun and lost this many times is not tried again.
  static constexpr int kMostStarts = 3;

  enum class Access { kRead, kWrite };
  /// Opens the folder of a sweep; with kWrite, makes it and its sweep.json where they are missing.
  /// Throws kInputInvalid for the folder of another sweep or version; kFileUnreadable;
  /// UnwritableFile.
  SweepFolder(std::filesystem::path folder, SweepIdentity identity, const RowLayout& layout,
              Access access);

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return folder_; }
  [[nodiscard]] const SweepIdentity& identity() const noexcept { return identity_; }
  [[nodiscard]] std::filesystem::path part_file(std::uint64_t part) const;
  [[nodiscard]] std::filesystem::path record_file(std::uint64_t part) const;
  [[nodiscard]] std::filesystem::path mark_file(std::uint64_t part, int start) const;

  /// Throws kInputInvalid where the user may not write to the folder.
  void require_writable() const;

  /// The length of a part's file, bytes.
  [[nodiscard]] std::uint64_t bytes_of_part(std::uint64_t part) const;

  /// Looks how a part stands: whether its file is there, with a record, and of the right length.
  /// Throws kInputInvalid for a part of another sweep.
  [[nodiscard]] PartStatus look(std::uint64_t part) const;
  /// Looks, and compares the checksum of the whole file too. Has cancellation points.
  [[nodiscard]] PartStatus verify(std::uint64_t part) const;

 private:
  std::filesystem::path folder_;
  SweepIdentity identity_;
  RowLayout layout_;
};

/// Throws kInputInvalid: the file of a part is not the one that was written.
[[noreturn]] void fail_damaged(const SweepFolder& folder, std::uint64_t part);

}  // namespace ist
