#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ist/base/platform/bit_cast.h"

namespace ist {

/// The poses of a sweep, by number. Pose i has the same bits on every machine and in every order of
/// asking. Only poses from a file are stored. Any number of threads may ask at a time.
class PoseSource {
 public:
  virtual ~PoseSource() = default;

  /// The number of poses.
  [[nodiscard]] virtual std::uint64_t count() const = 0;
  /// Computes the poses from number `first` on. Each maps moving mesh
  /// coordinates to fixed mesh coordinates. Precondition: first + poses.size() <= count().
  virtual void read(std::uint64_t first, std::span<Eigen::Isometry3d> poses) const = 0;
  /// Returns the names of the values that belong to each pose, such as the named axes of a grid.
  [[nodiscard]] virtual std::vector<std::string> value_names() const { return {}; }
  /// Writes the values of a pose. Preconditions: index < count(); one element in `values` for
  /// each name.
  virtual void values(std::uint64_t index, std::span<double> values) const;
  /// Returns a text that differs for other poses or names. Numbers are in it to the bit.
  [[nodiscard]] virtual std::string identity() const = 0;
  /// Throws kInputInvalid if identity() has other poses by now, as after a write to their file.
  virtual void require_unchanged() const {}
};

/// Returns a number's bits in 16 hexadecimal digits. The text of a floating-point number would hold
/// the decimal mark of the program's locale.
[[nodiscard]] inline std::string bits_of(double number) {
  return fmt::format("{:016x}", bit_cast<std::uint64_t>(number));
}

/// Returns the bits of a vector's numbers.
[[nodiscard]] inline std::string bits_of(const Eigen::Vector3d& v) {
  return fmt::format("{} {} {}", bits_of(v[0]), bits_of(v[1]), bits_of(v[2]));
}

/// Poses on a grid: a motion along or about each axis, in the order of the axes, the first one's
/// last. Pose numbers go by the last axis fastest, as the indices of an array of C do.
class PoseGrid : public PoseSource {
 public:
  struct Axis {
    bool turns = false;
    Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< of any length but 0
    Eigen::Vector3d about = Eigen::Vector3d::Zero();       ///< a point of a turn's axis
    double from = 0, to = 0;                               ///< mesh units, or degrees
    std::uint64_t count = 1;                               ///< values, `from` and `to` among them
    std::string name = {};  ///< of the column that rows have; empty: none
  };

  /// Precondition: at least one axis; the product of the counts is less than 2^63.
  explicit PoseGrid(std::vector<Axis> axes);

  [[nodiscard]] std::uint64_t count() const override { return count_; }
  void read(std::uint64_t first, std::span<Eigen::Isometry3d> poses) const override;
  [[nodiscard]] std::vector<std::string> value_names() const override;
  void values(std::uint64_t index, std::span<double> values) const override;
  [[nodiscard]] std::string identity() const override;

  /// Returns value `step` of an axis: the last is `to` itself.
  [[nodiscard]] static double value_of(const Axis& axis, std::uint64_t step) noexcept;

 private:
  // Calls `take(axis, value)` for the value of each axis in a pose, the last axis first.
  template <typename Take>
  void each_value(std::uint64_t index, const Take& take) const;
  [[nodiscard]] Eigen::Isometry3d pose(std::uint64_t index) const;

  std::vector<Axis> axes_;  // directions of unit length
  std::uint64_t count_ = 1;
};

/// Random poses: a move from a box, and a turn. Pose i depends on the seed and on i alone.
///
/// Philox(seed, i) draws its random numbers in this order: three for the move, then some for the
/// turn. A uniform turn is drawn by rejection from two discs (G. Marsaglia, Choosing a point
/// from the surface of a sphere, Ann. Math. Stat. 43(2), 1972). A small one is Cayley's: its vector
/// w is drawn from a box, and its quaternion is 1 + w/2, divided by its length; it turns by
/// 2 atan(|w|/2) about w, which is |w| to a part of |w|²/12.
class PoseBox : public PoseSource {
 public:
  enum class Turns { kNone, kWithin, kAny };
  struct Settings {
    std::uint64_t seed = 0, count = 0;
    Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();  ///< mesh units
    Turns turns = Turns::kNone;
    Eigen::Vector3d within = Eigen::Vector3d::Zero();  ///< of w, degrees, to each side
    Eigen::Vector3d about = Eigen::Vector3d::Zero();   ///< the point that turns leave, fixed
  };

  explicit PoseBox(const Settings& settings) : settings_(settings) {}

  [[nodiscard]] std::uint64_t count() const override { return settings_.count; }
  void read(std::uint64_t first, std::span<Eigen::Isometry3d> poses) const override;
  [[nodiscard]] std::string identity() const override;

 private:
  [[nodiscard]] Eigen::Isometry3d pose(std::uint64_t index) const;

  Settings settings_;
};

}  // namespace ist
