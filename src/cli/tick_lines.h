#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "ist/base/output_file.h"
#include "ist/haptics/tick_record.h"

namespace ist::cli {

/// Writes ticks, a line each: JSON objects, or CSV with a header where the file's name ends in
/// .csv. Times come last, so that what is before them is the same where ticks are the same. The
/// file is there, whole, after commit().
class TickWriter {
 public:
  explicit TickWriter(const std::filesystem::path& file);

  void write(const TickRecord& record);
  void commit();

 private:
  void write_json(const TickRecord& record);
  void write_csv(const TickRecord& record);
  void flush();

  OutputFile file_;
  bool csv_;
  std::string lines_;  // not yet written
};

/// Reads what TickWriter wrote as JSON, tick by tick.
class TickReader {
 public:
  /// @param dt of the ticks that are to be made again, s
  ///
  /// Throws kFileUnreadable.
  TickReader(std::filesystem::path file, double dt);

  /// Nothing at the end. Throws kInputInvalid, naming file, line and remedy, for what is no tick,
  /// or one of another length.
  [[nodiscard]] std::optional<RecordedTick> next();

  /// In the file when it was opened, and read so far.
  [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_; }
  [[nodiscard]] std::uint64_t bytes_read() const noexcept { return bytes_read_; }

 private:
  [[noreturn]] void refuse(const std::string& what) const;

  std::filesystem::path file_;
  double dt_;
  std::ifstream in_;
  std::uint64_t line_ = 0, bytes_ = 0, bytes_read_ = 0;
};

}  // namespace ist::cli
