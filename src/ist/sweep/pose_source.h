#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <string>

namespace ist {

/// The poses of a sweep, by number. Pose i has the same bits on every machine and in every order of
/// asking, and none is stored but those of a file. Any number of threads may ask at a time.
class PoseSource {
 public:
  virtual ~PoseSource() = default;

  /// The number of poses.
  [[nodiscard]] virtual std::uint64_t count() const = 0;
  /// Computes the poses from number `first` on. Each maps moving mesh
  /// coordinates to fixed mesh coordinates. Precondition: first + poses.size() <= count().
  virtual void read(std::uint64_t first, std::span<Eigen::Isometry3d> poses) const = 0;
  /// Returns a text that differs for other poses. Numbers are in it to the bit.
  [[nodiscard]] virtual std::string identity() const = 0;
  /// Throws kInputInvalid where the poses are no longer those of identity(), as in a file that was
  /// written since.
  virtual void require_unchanged() const {}
};

}  // namespace ist
