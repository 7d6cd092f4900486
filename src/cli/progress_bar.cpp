#include "cli/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <stop_token>
#include <string>
#include <utility>

namespace ist::cli {
namespace {

constexpr std::chrono::seconds kPatience{2};
constexpr std::chrono::milliseconds kPeriod{100};
constexpr std::size_t kWidth = 30;

// The terminal's last line, of which there is one.
std::mutex line_mutex;
bool line_is_drawn = false;

void draw(const Progress& progress) {
  const double fraction = progress.fraction();
  const auto filled = static_cast<std::size_t>(fraction * static_cast<double>(kWidth));
  const std::string line =
      fmt::format("\r\033[K[{}{}] {:3.0f} %  {}", std::string(filled, '#'),
                  std::string(kWidth - filled, '.'), 100 * fraction, progress.stage());
  const std::lock_guard lock(line_mutex);
  line_is_drawn = true;
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

void clear_line() {
  if (!std::exchange(line_is_drawn, false)) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

void show(const Progress& progress, const std::stop_token& end) {
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
  clear_line();
}

}  // namespace

ProgressBar::ProgressBar() {
  if (isatty(STDERR_FILENO) == 0) return;
  thread_ = std::jthread([this](const std::stop_token& end) { show(*this, end); });
}

void abandon_progress_bar() noexcept {
  line_mutex.lock();  // never unlocked, so that nothing is drawn after it
  clear_line();
}

}  // namespace ist::cli
