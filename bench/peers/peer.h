#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ist/query/contact.h"

namespace ist::bench {

/// What every contestant is asked, of two meshes and a pose that maps moving to fixed coordinates.
enum class Question : std::uint8_t {
  kMeets,       ///< whether any triangles meet
  kPairs,       ///< all pairs of triangles that meet
  kCandidates,  ///< pairs among which are all that meet
  kDistance,    ///< how far the surfaces are apart, to within kTolerance
};
inline constexpr Question kQuestions[] = {Question::kMeets, Question::kPairs, Question::kCandidates,
                                          Question::kDistance};
[[nodiscard]] const char* to_string(Question question);

/// Mesh units.
inline constexpr double kTolerance = 0.05;

/// Somebody who is asked, in one thread: a library and a way to use it.
class Peer {
 public:
  explicit Peer(std::string name) : name_(std::move(name)) {}
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  virtual ~Peer() = default;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] virtual bool answers(Question question) const = 0;

  /// What is not to be counted: called before each question, outside of the time that is taken.
  virtual void prepare(const Eigen::Isometry3d&) {}
  /// Called only where answers() says so. pairs() lists them, and returns how many there are.
  virtual bool meets(const Eigen::Isometry3d&) { return false; }
  virtual std::uint64_t pairs(const Eigen::Isometry3d&) { return 0; }
  virtual std::uint64_t candidates(const Eigen::Isometry3d&) { return 0; }
  virtual GapInterval distance(const Eigen::Isometry3d&) { return {}; }

 private:
  std::string name_;
};

using Peers = std::vector<std::unique_ptr<Peer>>;

}  // namespace ist::bench
