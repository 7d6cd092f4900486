#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/bench/samples.h"
#include "ist/base/progress.h"

namespace ist::cli {

/// A pose that everybody is asked at.
struct BenchPose {
  std::string key;    ///< for programs
  std::string words;  ///< for people: at most 14 characters
  Eigen::Isometry3d pose;
};

/// One way to ask one question.
struct Contestant {
  /// An answer: its time, and how much it lists.
  struct Answer {
    double microseconds;
    std::optional<std::uint64_t> listed;  ///< pairs in the answer; empty: none are asked for
  };

  std::string question;  ///< "leaf pairs", "contacts", "touch", "triangle pairs" or "distance"
  std::string way;       ///< who answers, in words
  std::string spheres;   ///< the policy; empty: bounds are no spheres
  int workers = 1;
  std::function<Answer(std::size_t pose)> ask;  ///< at a pose of the contest, by its number
};

/// A contestant's answers at one pose.
struct Score {
  Samples times;
  std::optional<std::uint64_t> listed;
};

/// All contestants in one run.
class Contest {
 public:
  /// Says what time it is, in seconds since any moment.
  using Clock = std::function<double()>;

  /// @param now a test's clock; by default the system's
  Contest(std::vector<Contestant> contestants, std::vector<BenchPose> poses,
          Clock now = system_seconds);

  /// Asks everybody at all poses, in turns, until `seconds` have passed and everybody had three
  /// turns. The next turn is that of the contestant who has used the least time so far, so
  /// everybody gets as much of it. A turn begins with one round that does not count and brings the
  /// contestant's data back into the caches. Between turns the fixed loop runs.
  void hold(double seconds, const Proceed& proceed);

  [[nodiscard]] const std::vector<Contestant>& contestants() const { return contestants_; }
  [[nodiscard]] const std::vector<BenchPose>& poses() const { return poses_; }
  /// Precondition: hold() has returned.
  [[nodiscard]] const Score& score(std::size_t contestant, std::size_t pose) const {
    return scores_[contestant][pose];
  }
  /// Seconds that hold() took.
  [[nodiscard]] double taken() const { return taken_; }
  /// The times of the fixed loop.
  [[nodiscard]] const Samples& loop() const { return loop_; }

 private:
  static double system_seconds();
  [[nodiscard]] double seconds_since(double begin) const { return now_() - begin; }
  void take_turn(std::size_t contestant);

  Clock now_;
  std::vector<Contestant> contestants_;
  std::vector<BenchPose> poses_;
  std::vector<std::vector<Score>> scores_;
  Samples loop_;
  double taken_ = 0;
};

}  // namespace ist::cli
