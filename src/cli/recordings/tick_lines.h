#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/recordings/line_reader.h"
#include "cli/recordings/recording_header.h"
#include "ist/base/files.h"
#include "ist/haptics/recording.h"

namespace ist::cli {

/// Writes ticks, one a line: JSON objects below a header, or CSV below the columns' names if the
/// file's name ends in .csv. A body that the hand takes or releases has a line of its own in JSON,
/// before that of its tick. Times come last, so lines of equal ticks differ only at their end. The
/// file appears, complete, after commit().
class TickWriter {
 public:
  TickWriter(const std::filesystem::path& file, const RecordingHeader& header);

  void write(const TickRecord& record);
  void commit();

 private:
  void flush();

  void append_change(const TickRecord& record);

  OutputFile file_;
  bool csv_;
  std::vector<std::string> names_;  // of the bodies
  std::string lines_;               // not yet written
};

/// Reads the JSON lines of a TickWriter, tick by tick.
class TickReader {
 public:
  /// Opens the file. Throws kFileUnreadable.
  /// @param header of the scene that replays it
  TickReader(std::filesystem::path file, RecordingHeader header);

  /// Returns the next tick, or nothing at the end, or when `stop` is set while it waits for a pipe.
  /// Throws kInputInvalid, naming file, line and remedy, for a header of another scene, a line that
  /// is no tick or has another time step; kFileUnreadable.
  [[nodiscard]] std::optional<RecordedTick> next(const std::atomic<bool>& stop);

  /// The size of the file when it was opened, and the bytes read so far.
  [[nodiscard]] std::uint64_t bytes() const noexcept { return lines_.size(); }
  [[nodiscard]] std::uint64_t bytes_read() const noexcept { return bytes_read_; }

 private:
  [[noreturn]] void refuse(const std::string& what) const;
  [[nodiscard]] std::optional<std::string> next_line(const std::atomic<bool>& stop);

  LineReader lines_;
  RecordingHeader header_;
  std::uint64_t line_ = 0, bytes_read_ = 0;
};

}  // namespace ist::cli
