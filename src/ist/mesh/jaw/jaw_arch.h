#pragma once

#include <Eigen/Core>
#include <vector>

namespace ist {

/// A place on the dental arch and the way across it.
struct ArchFrame {
  Eigen::Vector2d point;    ///< x, y; mm
  Eigen::Vector2d outward;  ///< unit normal, to the cheek
};

/// The curve in the occlusal plane along which both jaws are laid out: a horseshoe from between the
/// first incisors back to the condyle. Only the side x >= 0 is kept; the other is its mirror image.
class Arch {
 public:
  Arch();
  /// @param distance along the curve from the midline, mm; clamped to its length, just over 100
  [[nodiscard]] ArchFrame at(double distance) const;

 private:
  std::vector<double> lengths_;  // along the curve, at equal steps of its parameter
};

}  // namespace ist
