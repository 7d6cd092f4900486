#include "cli/recordings/tick_recorder.h"

#include <chrono>
#include <exception>
#include <thread>
#include <utility>
#include <vector>

namespace ist::cli {
namespace {

// Capacity of the ring: enough for some seconds in which the disk does not answer.
constexpr std::size_t kRingTicks = 1 << 14;
constexpr std::size_t kTicksAtOnce = 256;
constexpr std::chrono::milliseconds kNap{5};

// Runs an action if an exception ends its scope.
template <typename Action>
class OnException {
 public:
  explicit OnException(Action action) : action_(std::move(action)) {}
  ~OnException() {
    if (std::uncaught_exceptions() > before_) action_();
  }
  OnException(const OnException&) = delete;
  OnException& operator=(const OnException&) = delete;

 private:
  Action action_;
  int before_ = std::uncaught_exceptions();
};

}  // namespace

TickRecorder::TickRecorder(TickWriter& writer, StopOnInterruption& stop)
    : writer_(writer),
      stop_(stop),
      ring_(kRingTicks),
      written_(std::async(std::launch::async, [this] { write_ticks(); })) {}

// The future's destructor waits for the thread.
TickRecorder::~TickRecorder() {
  State recording = State::kRecording;
  state_.compare_exchange_strong(recording, State::kAbandoned);
}

void TickRecorder::push(const TickRecord& record) {
  while (!ring_.push(record) && !ring_.closed()) std::this_thread::sleep_for(kNap);
}

void TickRecorder::complete() {
  state_ = State::kCompleting;
  written_.get();  // rethrows the exceptions of the thread
  // The thread did not wait for the last ticks then, so the run has nothing true to report.
  if (stop_.hurried()) stop_.await_end();
}

// Writes ticks from the ring until there are no more. On failure, asks the loop to stop and closes
// the ring, so that the loop does not wait for room.
void TickRecorder::write_ticks() {
  const OnException give_up([this] {
    ring_.close();
    stop_.ask();
  });
  std::vector<TickRecord> ticks(kTicksAtOnce);
  while (true) {
    const State state = state_;
    const bool last = state == State::kCompleting || stop_.hurried();
    if (state == State::kAbandoned) return;
    const std::size_t count = ring_.pop(ticks);
    for (std::size_t i = 0; i < count; ++i) writer_.write(ticks[i]);
    if (count > 0) continue;
    if (last) break;
    std::this_thread::sleep_for(kNap);
  }
  writer_.commit();
  hold_.reset();
}

}  // namespace ist::cli
