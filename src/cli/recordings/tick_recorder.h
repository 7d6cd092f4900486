#pragma once

#include <atomic>
#include <future>
#include <optional>

#include "cli/interruption.h"
#include "cli/recordings/tick_lines.h"
#include "ist/haptics/recording.h"

namespace ist::cli {

/// Records ticks in a thread of its own, so that the thread that makes them never waits for the
/// disk. The file appears, whole, after complete(), or when a later signal ends the process: then
/// it has every tick that was pushed before. Else the file does not appear.
class TickRecorder {
 public:
  /// @param writer its file is open; the recorder commits it
  /// @param stop asked to stop if the file cannot be written
  TickRecorder(TickWriter& writer, StopOnInterruption& stop);
  ~TickRecorder();
  TickRecorder(const TickRecorder&) = delete;
  TickRecorder& operator=(const TickRecorder&) = delete;

  /// The ring that one thread pushes ticks to. It is closed if the file cannot be written.
  [[nodiscard]] TickRing<TickRecord>& ring() noexcept { return ring_; }
  /// Pushes a tick, and waits for room. Drops the tick if the ring is closed.
  void push(const TickRecord& record);

  /// Commits the file with all ticks pushed. Throws kFileUnwritable, also for earlier failures.
  void complete();

 private:
  enum class State { kRecording, kCompleting, kAbandoned };

  void write_ticks();

  TickWriter& writer_;
  StopOnInterruption& stop_;
  TickRing<TickRecord> ring_;
  std::atomic<State> state_{State::kRecording};
  std::optional<HoldEnd> hold_{std::in_place};  // until the file is committed
  std::future<void> written_;
};

}  // namespace ist::cli
