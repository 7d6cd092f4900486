#pragma once

#include <span>
#include <vector>

#include "answers/occlusion/map_colours.h"

namespace ist::answers {

/// How the numbers of a map become colours: in bands, or continuously.
class MapScale {
 public:
  /// The bands of a bite. A number beyond them has no colour.
  [[nodiscard]] static MapScale of_bands(std::vector<MapBand> bands);
  /// A continuous scale of signed distances, mesh units. Overlap goes from violet to purple, touch
  /// is red, and distances go through yellow and green to blue at `high`: the colour jumps at 0, so
  /// that touch is seen. Numbers below `low` have its colour. Numbers above `high` have none.
  /// Precondition: low < high, high > 0.
  [[nodiscard]] static MapScale of_distances(double low, double high);
  /// A continuous scale of changes of distance, mesh units: red if nearer, white if unchanged, blue
  /// if farther. Changes by more than `most` have the colour of its end. Precondition: most > 0.
  [[nodiscard]] static MapScale of_changes(double most);

  /// Returns the colour of a number: kBareSurface for NaN, and for a number that has none.
  [[nodiscard]] Colour colour(double number) const;
  /// Returns whether a number is drawn hatched: it is below the error assumed for scanning.
  [[nodiscard]] bool is_hatched(double number) const;
  /// Returns the bands; empty if the scale is continuous.
  [[nodiscard]] std::span<const MapBand> bands() const { return bands_; }
  [[nodiscard]] double low() const { return low_; }
  [[nodiscard]] double high() const { return high_; }

 private:
  enum class Ramp : std::uint8_t { kBands, kDistances, kChanges };

  Ramp ramp_ = Ramp::kBands;
  std::vector<MapBand> bands_;
  double low_ = 0, high_ = 0;
};

/// Returns the largest of 1, 2 or 5 times a power of ten that is at most `number`. Precondition:
/// number > 0, finite.
[[nodiscard]] double round_step(double number);

}  // namespace ist::answers
