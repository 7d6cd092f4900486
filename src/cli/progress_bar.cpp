#include "cli/progress_bar.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <stop_token>
#include <string>
#include <string_view>

namespace ist::cli {
namespace {

constexpr std::chrono::seconds kPatience{2};
constexpr std::chrono::milliseconds kPeriod{100};
constexpr std::size_t kWidth = 30;
constexpr std::string_view kClear = "\r\033[K";

// The terminal's last line, of which there is one.
std::mutex line_mutex;
bool line_is_drawn = false;

void draw(const ProgressBar& progress) {
  const double fraction = progress.drawn_fraction();
  const auto filled = static_cast<std::size_t>(fraction * static_cast<double>(kWidth));
  const std::string line =
      fmt::format("{}[{}{}] {:3.0f} %  {}", kClear, std::string(filled, '#'),
                  std::string(kWidth - filled, '.'), 100 * fraction, progress.stage());
  const std::lock_guard lock(line_mutex);
  line_is_drawn = true;
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

void show(const ProgressBar& progress, const std::stop_token& end) {
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any ended;
  const auto ends_within = [&](std::chrono::milliseconds time) {
    ended.wait_for(lock, end, time, [] { return false; });
    return end.stop_requested();
  };
  if (ends_within(kPatience)) return;
  do {
    draw(progress);
  } while (!ends_within(kPeriod));
  const std::lock_guard line(line_mutex);
  line_is_drawn = false;
  std::fwrite(kClear.data(), 1, kClear.size(), stderr);
  std::fflush(stderr);
}

}  // namespace

ProgressBar::ProgressBar(unsigned parts) : parts_(parts) {
  if (isatty(STDERR_FILENO) == 0) return;
  thread_ = std::jthread([this](const std::stop_token& end) { show(*this, end); });
}

double ProgressBar::drawn_fraction() const noexcept {
  if (parts_ == 0) return fraction();
  return std::min(1.0, static_cast<double>(parts_done_.load(std::memory_order_relaxed)) / parts_);
}

void print_past_progress_bar(const std::string& lines) {
  const std::lock_guard lock(line_mutex);
  const std::string text = (line_is_drawn ? std::string(kClear) : std::string()) + lines;
  line_is_drawn = false;
  std::fwrite(text.data(), 1, text.size(), stderr);
}

void abandon_progress_bar() noexcept {
  // A thread that draws on a terminal that is stopped, as by Ctrl-S, holds the lock for ever. (No
  // timed lock: ThreadSanitizer of g++ 12 does not see it.)
  constexpr std::chrono::milliseconds kNap{1};
  for (auto waited = kNap; !line_mutex.try_lock(); waited += kNap) {
    if (waited > kPeriod) return;
    std::this_thread::sleep_for(kNap);
  }
  // The lock is kept, so that nothing is drawn any more.
  pollfd terminal{STDERR_FILENO, POLLOUT, 0};
  if (!line_is_drawn || ::poll(&terminal, 1, 0) != 1) return;
  // A terminal that goes away with its line needs no clearing.
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, kClear.data(), kClear.size());
}

}  // namespace ist::cli
