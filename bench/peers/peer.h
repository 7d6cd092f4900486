#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ist/mesh/mesh.h"
#include "ist/query/results.h"
#include "support/effort.h"

namespace ist::bench {

/// A question to every contestant, of two meshes and a pose that maps moving to fixed coordinates.
enum class Question : std::uint8_t {
  kMeets,       ///< whether any triangles meet
  kPairs,       ///< all pairs of triangles that meet
  kCandidates,  ///< pairs among which are all that meet
  kDistance,    ///< how far the surfaces are apart, to within kTolerance, and the nearest points
};
inline constexpr Question kQuestions[] = {Question::kMeets, Question::kPairs, Question::kCandidates,
                                          Question::kDistance};
[[nodiscard]] const char* to_string(Question question);

/// Mesh units.
inline constexpr double kTolerance = 0.05;
/// Of all that has voxels, mesh units: 0.2, and coarser where it is quick().
[[nodiscard]] inline double voxel_size() { return quick() ? 0.8 : 0.2; }

/// How true a contestant's answers are.
enum class Guarantee : std::uint8_t {
  kExact,    ///< decided exactly: who differs from another such is wrong
  kRounded,  ///< decided in float or double
  kSampled,  ///< of some points of the surface, at voxel_size(): may be off by it, and miss contact
};
[[nodiscard]] const char* to_string(Guarantee guarantee);

/// Somebody who is asked, in one thread: a library and a way to use it.
class Peer {
 public:
  Peer(std::string name, Guarantee guarantee) : name_(std::move(name)), guarantee_(guarantee) {}
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  virtual ~Peer() = default;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] Guarantee guarantee() const { return guarantee_; }
  [[nodiscard]] virtual bool answers(Question question) const = 0;

  /// Does the work that is not to be counted: called before each question, outside of its time.
  virtual void prepare(const Eigen::Isometry3d&) {}
  /// Whether prepare() already does some of what another must do in its time.
  [[nodiscard]] virtual bool prepared() const { return false; }
  /// Called only where answers() says so. pairs() lists them, and returns how many there are.
  /// distance() may end at infinity, where all that is known is what it exceeds.
  virtual bool meets(const Eigen::Isometry3d&) { return false; }
  virtual std::uint64_t pairs(const Eigen::Isometry3d&) { return 0; }
  virtual std::uint64_t candidates(const Eigen::Isometry3d&) { return 0; }
  virtual DistanceInterval distance(const Eigen::Isometry3d&) { return {}; }
  /// The nearest points of the last distance(), of the fixed and of the moving mesh, in fixed
  /// coordinates; empty if a contestant gives none. Called outside of its time.
  [[nodiscard]] virtual std::optional<std::array<Eigen::Vector3d, 2>> nearest() const { return {}; }

 private:
  std::string name_;
  Guarantee guarantee_;
};

using Peers = std::vector<std::unique_ptr<Peer>>;

/// Copies of one body, which share its structure. All work is done in one thread.
class Crowd {
 public:
  Crowd() = default;
  Crowd(const Crowd&) = delete;
  Crowd& operator=(const Crowd&) = delete;
  virtual ~Crowd() = default;

  /// Sets up a world of copies that are moved to `places`, ready to be asked. The world of an
  /// earlier call is gone.
  virtual void set_up(std::span<const Eigen::Vector3d> places) = 0;
  /// Moves all copies. As many as before.
  virtual void move(std::span<const Eigen::Vector3d> places) = 0;
  /// Returns how many pairs of copies intersect.
  virtual std::uint64_t touching() = 0;
};

/// A library, and its contestants of a fixed and a moving mesh, which share what is built of these
/// and may refer to them.
struct Library {
  /// Measures how far points are from a mesh.
  using MeasurePoints = std::function<void(std::span<const Eigen::Vector3d>, std::span<double>)>;

  std::string name, version;
  std::function<Peers(const TriangleMesh& fixed, const TriangleMesh& moving)> make;
  std::function<MeasurePoints(const TriangleMesh& mesh)> points = {};  ///< if it has such an answer
  /// Makes a crowd of a mesh without copies yet; if it has worlds of many bodies.
  std::function<std::unique_ptr<Crowd>(const TriangleMesh& mesh)> crowd = {};
};

}  // namespace ist::bench
