#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "answers/occlusion/labels/tooth_labels.h"
#include "ist/haptics/servo_loop.h"

namespace ist::cli {

/// Sums the forces of a run's contacts by teeth. The force on a tooth in a tick is the sum of the
/// forces of all contacts on its triangles.
class ToothForces final : public TickReceiver {
 public:
  struct Tooth {
    std::size_t body;
    int number;
    std::uint64_t ticks = 0;  ///< with a contact on the tooth
    double sum = 0,           ///< of the force's lengths in these ticks, N
        largest = 0;          ///< N
    /// Returns the mean over the ticks with a contact, N; 0 without any.
    [[nodiscard]] double mean() const noexcept {
      return ticks > 0 ? sum / static_cast<double>(ticks) : 0;
    }
  };

  /// @param labels by body; empty for a body without labels
  explicit ToothForces(std::vector<answers::ToothLabels> labels);

  /// Allocates nothing. Precondition: the record's triangles are those of the labels.
  void take(const TickRecord& record) noexcept override;

  /// Returns all teeth of the labels, by body and number.
  [[nodiscard]] std::span<const Tooth> teeth() const noexcept { return teeth_; }

 private:
  void add(std::uint32_t body, std::uint32_t triangle, const std::array<double, 3>& force) noexcept;

  std::vector<std::vector<std::uint32_t>>
      tooth_of_;  // by body and triangle: its index, or kNoTooth
  std::vector<Tooth> teeth_;
  // The teeth with contacts in a tick, and their forces.
  std::array<std::uint32_t, 2 * Tick::kMostPoints> touched_{};
  std::array<std::array<double, 3>, 2 * Tick::kMostPoints> force_{};
  std::size_t touched_count_ = 0;
};

}  // namespace ist::cli
