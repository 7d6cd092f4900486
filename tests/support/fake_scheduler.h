#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace ist::test {

/// A device's thread without thread, device or waiting: it calls back as a driver would, 1,000
/// times a second of a time that is only counted. What no call comes for, or comes late, is said
/// before.
class FakeScheduler {
 public:
  /// As drivers declare it: who calls, where the handle is, and what to feel.
  using Callback = int (*)(void* user, const double pose[16], double force[3], double torque[3]);
  /// Where the handle is, column by column, `time` seconds after the start.
  using Path = std::function<void(double time, double pose[16])>;

  struct Call {
    double time;  ///< s
    int answer;
    double force[3], torque[3];
  };

  FakeScheduler(Callback callback, void* user, Path path)
      : callback_(callback), user_(user), path_(std::move(path)) {}

  /// No call for the ticks from `first` on, as where the system gave the driver no time.
  void drop(std::uint64_t first, std::uint64_t count);
  /// The call of a tick comes `seconds` late.
  void delay(std::uint64_t tick, double seconds);

  /// All calls of `ticks` ticks, in order.
  [[nodiscard]] std::vector<Call> run(std::uint64_t ticks);

 private:
  Callback callback_;
  void* user_;
  Path path_;
  std::vector<std::uint64_t> dropped_;
  std::vector<std::pair<std::uint64_t, double>> delays_;
};

}  // namespace ist::test
