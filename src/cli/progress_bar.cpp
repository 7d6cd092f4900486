#include "cli/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <string>
#include <utility>

namespace ist::cli {
namespace {

constexpr std::chrono::seconds kPatience{2};
constexpr std::chrono::milliseconds kPeriod{100};
constexpr std::size_t kWidth = 30;

// The terminal's last line, which there is one of.
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

}  // namespace

ProgressBar::ProgressBar(const Progress& progress) : progress_(progress) {
  if (isatty(STDERR_FILENO) != 0) thread_ = std::thread([this] { show(); });
}

ProgressBar::~ProgressBar() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  ended_.notify_one();
  thread_.join();
}

void ProgressBar::show() {
  std::unique_lock lock(mutex_);
  if (ended_.wait_for(lock, kPatience, [this] { return end_; })) return;
  do {
    draw(progress_);
  } while (!ended_.wait_for(lock, kPeriod, [this] { return end_; }));
  const std::lock_guard line(line_mutex);
  clear_line();
}

void abandon_progress_bar() noexcept {
  line_mutex.lock();  // and never unlocked: nothing is to follow
  clear_line();
}

}  // namespace ist::cli
