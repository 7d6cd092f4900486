#pragma once

#include <cstdint>
#include <filesystem>

#include "sweep/sweep_folder.h"

namespace ist {

/// Counts the starts of a part that were lost, and says whether somebody is making it now.
struct PartStarts {
  int lost = 0;  ///< by processes that died
  bool live = false;
};
[[nodiscard]] PartStarts starts_of(const SweepFolder& folder, std::uint64_t part);

/// Throws kPartBusy: another process is making the part.
[[noreturn]] void fail_overlap(const SweepFolder& folder, std::uint64_t part);

/// A mark beside a part that is being made: part-000017.start-1. It outlives a process that is
/// killed, and so counts the starts that were lost. While its process lives the mark is locked
/// (flock), so that others see that the part is being made.
class StartMark {
 public:
  /// Makes the mark. Throws kPartBusy if another process, or thread, is making the part;
  /// UnwritableFile. Precondition: fewer than kMostStarts starts were lost.
  StartMark(const SweepFolder& folder, std::uint64_t part);
  /// Removes the mark: this start ended in order.
  ~StartMark();
  StartMark(const StartMark&) = delete;
  StartMark& operator=(const StartMark&) = delete;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// A mark beside a table that is being merged: rows.start. At most one object in all processes
/// holds it, by a lock (flock). A process that is killed leaves the mark without the lock, and the
/// next merge takes it over. On a file system without locks every object holds its mark: merges at
/// the same time write the same bytes.
class MergeMark {
 public:
  /// Tries to take the mark. Throws UnwritableFile.
  explicit MergeMark(const SweepFolder& folder);
  /// Removes the mark that this object holds.
  ~MergeMark();
  MergeMark(const MergeMark&) = delete;
  MergeMark& operator=(const MergeMark&) = delete;

  [[nodiscard]] bool is_held() const noexcept { return descriptor_ >= 0; }

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// Removes the marks of all starts of a part that is there now.
void remove_marks(const SweepFolder& folder, std::uint64_t part) noexcept;

}  // namespace ist
