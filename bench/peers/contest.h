#pragma once

#include <optional>
#include <string>
#include <vector>

#include "peers/peer.h"
#include "peers/poses.h"
#include "support/latencies.h"

namespace ist::bench {

/// An answer of anybody; the pairs are candidates where these were asked for.
struct Answer {
  bool meets = false;
  std::uint64_t pairs = 0;
  DistanceInterval gap{};
  std::optional<double> apart{};  ///< how far the nearest points are apart, if they are given
};

/// Whether a contestant's answer is as IST's: no fewer candidates; distances that may be the same;
/// for one who samples, distances within a voxel. Nearest points are as far apart as the surfaces,
/// to within the peer's interval, if the surfaces are apart.
[[nodiscard]] bool agree(Question question, const Answer& ist, const Answer& peer,
                         Guarantee guarantee);

/// Returns the fault of IST's answer where the truth is known, or nothing.
[[nodiscard]] std::optional<std::string> untrue(Question question, const Answer& ist,
                                                const NamedPose& pose);

/// A question, and all who answer it. Who has used the least time so far is asked all poses next,
/// so that everybody gets as much of it, and who is quick is measured oftener.
class Contest {
 public:
  struct Player {
    Peer& peer;
    std::vector<Answer> answers;       ///< one a pose
    std::vector<Latencies> latencies;  ///< one a pose
    int rounds = 0;
    double spent = 0;  ///< s, with what is not counted
  };

  /// Of those who answer `question`; the first is IST. The poses must outlive it.
  Contest(Question question, const std::vector<Peer*>& all, const std::vector<NamedPose>& poses);

  [[nodiscard]] Question question() const { return question_; }
  [[nodiscard]] const std::vector<NamedPose>& poses() const { return poses_; }
  [[nodiscard]] std::vector<Player>& players() { return players_; }

  /// Asks everybody `fewest` times or more, until `seconds` have passed. Does nothing when it has
  /// been called before.
  void hold(double seconds, int fewest);

 private:
  void take_turn(Player& player);

  Question question_;
  const std::vector<NamedPose>& poses_;
  std::vector<Player> players_;
};

}  // namespace ist::bench
